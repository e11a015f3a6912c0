#include "watched_files.h"

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "quell/text/error.h"

namespace quell::app {
namespace fs = std::filesystem;
namespace {

constexpr int kQuiet = 100;         // ms: an editor that saves in several steps is through
constexpr int kLongestSaving = 50;  // so many events one after the other are not one saving

[[noreturn]] void refuse(const std::string& what) {
  throw Error(Fault::usage, "--watch", what + " cannot be watched: " + std::strerror(errno));
}

/// Whether there is something to read before the time is over; below 0: whenever that is.
bool wait_for(std::array<pollfd, 2>& events, int milliseconds) {
  while (true) {
    const int count = poll(events.data(), events.size(), milliseconds);
    if (count >= 0) return count > 0;
    if (errno != EINTR) refuse("the files");
  }
}

}  // namespace

WatchedFiles::WatchedFiles() : notifier_(inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
  if (notifier_ < 0) refuse("files");
}

WatchedFiles::~WatchedFiles() { close(notifier_); }

void WatchedFiles::add(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    add_one(file);
    std::error_code error;
    if (const fs::path behind = fs::canonical(file, error); !error) add_one(behind);
  }
}

void WatchedFiles::add_one(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  // Not its making: what is being made is not whole.
  const int number = inotify_add_watch(notifier_, folder.c_str(), IN_CLOSE_WRITE | IN_MOVED_TO);
  if (number < 0) refuse("the folder " + folder.string());
  folders_[number].path = folder;
  folders_[number].names.insert(file.filename().string());
}

bool WatchedFiles::wait(bool or_any_graph, int stop_event) {
  std::array<pollfd, 2> events{{{notifier_, POLLIN, 0}, {stop_event, POLLIN, 0}}};
  bool is_saved = false;
  for (int saving = 0; !is_saved || saving < kLongestSaving; saving += is_saved ? 1 : 0) {
    if (!wait_for(events, is_saved ? kQuiet : -1)) return true;
    if (events[1].revents != 0) return false;
    is_saved = read_events(or_any_graph) || is_saved;
  }
  return true;
}

bool WatchedFiles::read_events(bool or_any_graph) {
  alignas(inotify_event) std::array<char, 16 * 1024> buffer{};
  bool is_one = false;
  for (ssize_t size; (size = read(notifier_, buffer.data(), buffer.size())) > 0;)
    for (ssize_t at = 0; at < size;) {
      const auto* event = reinterpret_cast<const inotify_event*>(buffer.data() + at);
      at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      const std::string name = event->len > 0 ? event->name : "";
      const auto folder = folders_.find(event->wd);
      const bool is_known = folder != folders_.end();
      if (is_known && (event->mask & IN_IGNORED) != 0)
        throw Error(Fault::usage, "--watch",
                    "the folder " + folder->second.path.string() + " was removed; start again when its files are there");
      is_one = is_one || (event->mask & IN_Q_OVERFLOW) != 0 || (is_known && folder->second.names.contains(name)) ||
               (or_any_graph && fs::path(name).extension() == ".json");
    }
  return is_one;
}

}  // namespace quell::app
