#include "analyze.h"

#include <iostream>
#include <string>

#include "analysis_text.h"
#include "interrupt.h"
#include "quell/runtime/analysis.h"
#include "quell/sequence/file_sink.h"
#include "temporary_folder.h"

namespace quell::app {
namespace {

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
