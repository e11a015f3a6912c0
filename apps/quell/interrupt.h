// SIGINT and SIGTERM: the first asks the run to stop cleanly, the second ends the program at once. Both ways it exits with
// kInterrupted.
#pragma once

namespace quell::app {

/// From now on to the program's end.
void handle_interrupts();
/// Whether one of the signals came. From any thread.
bool interrupted();
/// A file descriptor that can be read from then on, so that poll() can wait for it.
int interrupt_event();

}  // namespace quell::app
