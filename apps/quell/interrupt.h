// SIGINT and SIGTERM: the first asks the run to stop cleanly, the second ends the program at once.
#pragma once

#include <csignal>

namespace quell::app {

/// Handles the signals while it lives. One at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Whether one of the signals came since the program started. From any thread.
  static bool requested();

 private:
  struct sigaction former_int_ {};
  struct sigaction former_term_ {};
};

}  // namespace quell::app
