#include "graphviz.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "console.h"
#include "quell/text/error.h"

extern char** environ;

namespace quell::app {
namespace {

/// What goes in and out of the program passes through files without a name: neither side ever waits for the other, as with pipes.
class Stream {
 public:
  Stream() : file_(std::tmpfile(), &std::fclose) {
    if (!file_) throw Error(Fault::usage, "--svg", std::string("there is no room for temporary files: ") + std::strerror(errno));
  }
  int descriptor() const { return fileno(file_.get()); }
  void write(const std::string& text) {
    const bool whole = std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size() && std::fflush(file_.get()) == 0;
    if (!whole) throw Error(Fault::usage, "--svg", std::string("there is no room for temporary files: ") + std::strerror(errno));
    std::rewind(file_.get());
  }
  std::string read() {
    std::rewind(file_.get());
    std::string text;
    std::array<char, 4096> buffer{};
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file_.get())) text.append(buffer.data(), count);
    return text;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// The status of waitpid.
int run_dot(const Stream& in, const Stream& out, const Stream& err) {
  posix_spawn_file_actions_t actions{};
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.descriptor(), STDERR_FILENO);
  std::string program = "dot", format = "-Tsvg";
  std::array<char*, 3> words{program.data(), format.data(), nullptr};
  pid_t process = 0;
  // A group of its own: Ctrl-C is for this program, which then ends as it says, and not with half a drawing.
  posix_spawnattr_t attributes{};
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int error = posix_spawnp(&process, program.c_str(), &actions, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT)
    throw Error(Fault::usage, "--svg",
                "Graphviz' program 'dot' is not in PATH; install it (on Debian: apt install graphviz), or use --dot and draw the "
                "graph elsewhere");
  if (error != 0)
    throw Error(Fault::usage, "--svg", std::string("Graphviz' program 'dot' does not start: ") + std::strerror(error));
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {}
  return status;
}

std::string describe_failure(int status) {
  if (WIFSIGNALED(status)) return "was ended by signal " + std::to_string(WTERMSIG(status));
  return "failed with status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

std::string draw_svg(const std::string& dot) {
  Stream in, out, err;
  in.write(dot);
  const int status = run_dot(in, out, err);
  std::string svg = out.read(), words = err.read();
  while (words.ends_with('\n')) words.pop_back();
  const bool is_drawn = status == 0 && svg.find("<svg") != std::string::npos && svg.ends_with("</svg>\n");
  if (!is_drawn)
    throw Error(Fault::usage, "--svg",
                "Graphviz' program 'dot' " + (status == 0 ? std::string("wrote no whole drawing") : describe_failure(status)) +
                    (words.empty() ? "" : "; it says:\n" + words));
  if (!words.empty()) spdlog::warn("dot: {}", words);
  return svg;
}

}  // namespace quell::app
