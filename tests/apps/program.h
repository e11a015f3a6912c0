// Starts the runner and looks at what it says.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace quell::app::testing {

struct Outcome {
  int code = -1;  ///< exit status; 128 + signal when it was killed
  std::string out, err;
  long peak_resident = 0;  ///< bytes, or those of the test when it was started, if these were more
};

/// A running quell. Its standard output and error are pipes; the error stream can be a terminal instead, and the output a file.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments, bool on_terminal = false,
                   const std::vector<std::string>& environment = {}, const char* output_file = nullptr);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Reads on until the error stream contains the text; false when the program ends before.
  bool wait_for_error_text(const std::string& text);
  void send(int signal) const;
  /// Bytes that it holds in memory now; 0 when it is gone.
  long resident() const;
  Outcome finish();

 private:
  bool read_some();  // false at the end of both streams
  pid_t pid_ = -1;
  int out_ = -1, err_ = -1;
  Outcome outcome_;
};

/// Whether pseudo-terminals can be had; in a bare container /dev/pts may be missing.
bool terminals_exist();

/// Runs quell to its end.
Outcome quell(const std::vector<std::string>& arguments);

}  // namespace quell::app::testing
