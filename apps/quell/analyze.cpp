#include "analyze.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string>

#include "analysis_text.h"
#include "interrupt.h"
#include "quell/runtime/analysis.h"
#include "quell/sequence/file_sink.h"

namespace quell::app {
namespace {

namespace fs = std::filesystem;

/// A folder of its own below TMPDIR (or /tmp), removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code error;
    std::string path = (fs::temp_directory_path(error) / "quell-analyze-XXXXXX").string();
    if (error || !mkdtemp(path.data()))
      throw Error(Fault::usage, "TMPDIR",
                  "no temporary folder can be made: " + (error ? error.message() : std::strerror(errno)) +
                      "; name a folder that can be written to");
    path_ = path;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

FrameTimes measure_job(Job& job, int threads, Console& console) {
  const TemporaryFolder folder;
  FileSink sink({.folder = folder.path(), .padding = job.sequence->padding()});
  SessionOptions options;
  options.threads = threads;
  options.cancelled = interrupted;
  std::size_t done = 0;
  options.on_frame = [&](const FrameReport&) {
    if (spdlog::should_log(spdlog::level::info)) console.set_status("measuring: " + std::to_string(++done) + " frames");
  };
  const FrameTimes times = measure(job.graph, job.frames, *job.sequence, sink, options);
  console.set_status("");
  tell_new_warnings(job);
  return times;
}

}  // namespace

ExitCode analyze_job(Job& job, int threads, Console& console) {
  handle_interrupts();
  try {
    const FrameTimes times = measure_job(job, threads, console);
    std::cout << describe(job.plan, times, analyze(job.plan, times), choose_window(job.plan, times.threads, 0, 0));
    return kOk;
  } catch (const Cancelled&) {
    console.set_status("");
    spdlog::error("interrupted");
    return kInterrupted;
  }
}

}  // namespace quell::app
