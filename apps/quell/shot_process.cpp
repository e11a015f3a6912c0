#include "shot_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "quell/text/error.h"

namespace quell::app {
namespace {

constexpr std::size_t kKibi = 1024;  // wait4() counts memory in KiB

/// Closed at the end of its life, and by exec.
struct Descriptor {
  explicit Descriptor(int number_) : number(number_) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number;
};

struct Start {
  char* const* words;
  int input, log;
  int complaint;  ///< where to write errno when it fails
  pid_t parent;
};

// Between fork and exec, where only system calls are allowed.
[[noreturn]] void become(const Start& start) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != start.parent) _exit(127);  // it died before that
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  if (dup2(start.input, STDIN_FILENO) >= 0 && dup2(start.log, STDOUT_FILENO) >= 0 && dup2(start.log, STDERR_FILENO) >= 0)
    execv("/proc/self/exe", start.words);
  const int error = errno;
  [[maybe_unused]] const ssize_t ignored = write(start.complaint, &error, sizeof error);
  _exit(127);
}

Error cannot_start(const std::string& what, int error) {
  return {Fault::usage, "", what + " cannot be started: " + std::strerror(error)};
}

}  // namespace

ShotProcess::ShotProcess(const std::vector<std::string>& words, const std::filesystem::path& log) {
  std::vector<std::string> texts = words;
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  const Descriptor input(open("/dev/null", O_RDONLY | O_CLOEXEC));
  const Descriptor output(open(log.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666));
  if (output.number < 0) throw Error(Fault::usage, log.string(), std::string("cannot be written: ") + std::strerror(errno));
  std::array<int, 2> pipe_ends{};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) throw cannot_start("a run", errno);
  const Descriptor reader(pipe_ends[0]);
  {
    const Descriptor writer(pipe_ends[1]);
    const Start start{pointers.data(), input.number, output.number, writer.number, getpid()};
    pid_ = fork();
    if (pid_ == 0) become(start);
    if (pid_ < 0) throw cannot_start("a run", errno);
  }
  int error = 0;
  if (read(reader.number, &error, sizeof error) == sizeof error) {
    waitpid(pid_, nullptr, 0);
    throw cannot_start("a run", error);
  }
}

ShotProcess::~ShotProcess() {
  if (end()) return;
  send(SIGKILL);
  waitpid(pid_, nullptr, 0);
}

std::optional<ProcessEnd> ShotProcess::end() {
  if (end_) return end_;
  int status = 0;
  rusage usage{};
  if (wait4(pid_, &status, WNOHANG, &usage) != pid_) return std::nullopt;
  end_ = ProcessEnd{.code = WIFEXITED(status) ? WEXITSTATUS(status) : 0,
                    .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
                    .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(),
                    .peak_bytes = kKibi * static_cast<std::size_t>(usage.ru_maxrss)};
  return end_;
}

void ShotProcess::send(int signal) const {
  if (!end_) kill(pid_, signal);
}

}  // namespace quell::app
