#include "tests/apps/program.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>

extern char** environ;

namespace quell::app::testing {
namespace {

struct Pipe {
  int reader = -1, writer = -1;
};

Pipe make_pipe(bool terminal) {
  std::array<int, 2> ends{};
  winsize size{.ws_row = 24, .ws_col = 100, .ws_xpixel = 0, .ws_ypixel = 0};
  const bool ok = terminal ? openpty(&ends[0], &ends[1], nullptr, nullptr, &size) == 0 : pipe(ends.data()) == 0;
  if (!ok) throw std::runtime_error("no pipe or terminal for the test");
  for (const int end : ends) fcntl(end, F_SETFD, FD_CLOEXEC);
  return {ends[0], ends[1]};
}

/// The test's own environment, without what would change messages, and with `extra` in the place of what has the same name.
std::vector<std::string> make_environment(const std::vector<std::string>& extra) {
  const auto is_replaced = [&](const std::string& entry) {
    const std::string name = entry.substr(0, entry.find('=') + 1);
    return std::any_of(extra.begin(), extra.end(), [&](const std::string& other) { return other.starts_with(name); });
  };
  std::vector<std::string> all;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry;
    if (!text.starts_with("NO_COLOR=") && !text.starts_with("TERM=") && !text.starts_with("QUELL_") && !is_replaced(text))
      all.push_back(text);
  }
  all.insert(all.end(), extra.begin(), extra.end());
  all.push_back("TERM=xterm");  // the first of two entries counts
  return all;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// False at the end of the stream. A terminal whose other end is closed ends with an error.
bool append(int& stream, std::string& text) {
  std::array<char, 4096> buffer{};
  const ssize_t count = read(stream, buffer.data(), buffer.size());
  if (count > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(count));
    return true;
  }
  close(stream);
  stream = -1;
  return false;
}

}  // namespace

bool terminals_exist() {
  std::array<int, 2> ends{};
  if (openpty(&ends[0], &ends[1], nullptr, nullptr, nullptr) != 0) return false;
  for (const int end : ends) close(end);
  return true;
}

Program::Program(const std::vector<std::string>& arguments, bool on_terminal, const std::vector<std::string>& environment,
                 const char* output_file) {
  const Pipe out = make_pipe(false), err = make_pipe(on_terminal);
  posix_spawn_file_actions_t actions{};
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  if (output_file)
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output_file, O_WRONLY, 0);
  else
    posix_spawn_file_actions_adddup2(&actions, out.writer, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.writer, STDERR_FILENO);
  std::vector<std::string> words = {QUELL_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = make_environment(environment);
  const int error = posix_spawn(&pid_, QUELL_PROGRAM, &actions, nullptr, pointers(words).data(), pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  close(out.writer);
  close(err.writer);
  out_ = out.reader;
  err_ = err.reader;
  if (error != 0) throw std::runtime_error(std::string("cannot start ") + QUELL_PROGRAM);
}

Program::~Program() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  for (const int stream : {out_, err_})
    if (stream >= 0) close(stream);
}

bool Program::read_some() {
  std::array<pollfd, 2> streams{{{out_, POLLIN, 0}, {err_, POLLIN, 0}}};  // a negative one is left out
  if (out_ < 0 && err_ < 0) return false;
  if (poll(streams.data(), streams.size(), -1) < 0) return true;
  if (streams[0].revents != 0) append(out_, outcome_.out);
  if (streams[1].revents != 0) append(err_, outcome_.err);
  return true;
}

bool Program::wait_for_error_text(const std::string& text) {
  while (outcome_.err.find(text) == std::string::npos)
    if (!read_some()) return false;
  return true;
}

void Program::send(int signal) const { kill(pid_, signal); }

long Program::resident() const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stol(line.substr(6)) * 1024;
  return 0;
}

Outcome Program::finish() {
  while (read_some()) {}
  int status = 0;
  rusage usage{};
  wait4(pid_, &status, 0, &usage);
  pid_ = -1;
  outcome_.peak_resident = usage.ru_maxrss * 1024;
  outcome_.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome_;
}

Outcome quell(const std::vector<std::string>& arguments) { return Program(arguments).finish(); }

}  // namespace quell::app::testing
