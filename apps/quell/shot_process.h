// One `quell run` of a batch: a process of its own, so that whatever becomes of it harms no other.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace quell::app {

/// How a process ended.
struct ProcessEnd {
  int code = 0;    ///< its exit code, where no signal ended it
  int signal = 0;  ///< 0: none
  double seconds = 0;
  std::size_t peak_bytes = 0;  ///< most memory that it had at a time
};

/// In a process group of its own: a Ctrl-C of the terminal reaches the batch alone, which passes it on.
class ShotProcess {
 public:
  /// Starts this program with these words. What it says is added to the log. When the batch dies, it gets a SIGTERM. Throws
  /// Error(usage) when it cannot be started.
  ShotProcess(const std::vector<std::string>& words, const std::filesystem::path& log);
  /// Kills what still runs.
  ~ShotProcess();
  ShotProcess(const ShotProcess&) = delete;
  ShotProcess& operator=(const ShotProcess&) = delete;

  /// Nothing while it runs; asked again, the same.
  std::optional<ProcessEnd> end();
  void send(int signal) const;

 private:
  pid_t pid_ = -1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::optional<ProcessEnd> end_;
};

}  // namespace quell::app
