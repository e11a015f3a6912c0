#include "interrupt.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <string_view>

#include "exit_code.h"

namespace quell::app {
namespace {

std::atomic<int> signals{0};
int event = -1;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use it");

constexpr std::string_view kNotice = "\nstopping; give the signal once more to stop at once\n";
std::size_t notice_start = 1;  // 0 on a terminal, whose progress line must end first

void handle(int) {
  const int saved_errno = errno;
  if (signals.fetch_add(1) > 0) _exit(kInterrupted);
  constexpr std::uint64_t kOnce = 1;
  if (event >= 0 && write(event, &kOnce, sizeof kOnce) < 0) _exit(kInterrupted);  // nobody would ever notice
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, kNotice.data() + notice_start, kNotice.size() - notice_start);
  errno = saved_errno;
}

}  // namespace

void handle_interrupts() {
  event = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  notice_start = isatty(STDERR_FILENO) == 1 ? 0 : 1;
  struct sigaction action {};
  action.sa_handler = handle;
  action.sa_flags = SA_RESTART;  // reading and writing files goes on
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond `ulimit -f` is a failed frame, as on a full disk
}

bool interrupted() { return signals.load() > 0; }

int interrupt_event() { return event; }

}  // namespace quell::app
