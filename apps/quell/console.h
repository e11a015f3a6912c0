// Where messages go: stderr, a line each, with the progress line of a terminal kept below them.
#pragma once

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace quell::app {

enum class Verbosity {
  quiet,    ///< warnings and errors
  normal,   ///< and what a person wants to know
  verbose,  ///< and what the passes say for debugging
};

/// Thread-safe. A message of several lines, or one that names its place as compilers do (`file:line:column: error: ...`), is
/// printed as it is.
class Console final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  Console(std::FILE* stream, bool is_terminal, bool has_colors);

  bool is_terminal() const { return is_terminal_; }
  /// Columns of the terminal; 80 where they are unknown.
  int columns() const;
  /// A line that stays at the bottom of the terminal until it is replaced; "" takes it away. Nothing is shown elsewhere.
  void set_status(std::string line);

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override;

 private:
  void erase_status();
  void draw_status();
  std::FILE* stream_;
  bool is_terminal_;
  bool has_colors_;
  std::string status_;
};

/// Makes stderr the place for spdlog's messages. Colors only on a terminal, and never with NO_COLOR.
std::shared_ptr<Console> open_console();
void set_verbosity(Verbosity verbosity);

}  // namespace quell::app
