// SIGINT and SIGTERM: the first asks the run to stop cleanly, the second ends the program at once. Both ways it exits with
// kInterrupted.
#pragma once

namespace quell::app {

/// From now on to the program's end.
void handle_interrupts();
/// Whether one of the signals came. From any thread.
bool interrupted();

}  // namespace quell::app
