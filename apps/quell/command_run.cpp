// quell run: a graph over a sequence.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "commands.h"
#include "interrupt.h"
#include "progress.h"
#include "quell/runtime/window.h"
#include "quell/simd/isa.h"
#include "run_log.h"
#include "run_setup.h"
#include "run_summary.h"
#include "trace_file.h"
#include "variants.h"

namespace quell::app {
namespace {

void log_of_pass(int level, const std::string& message) {
  spdlog::log(level >= QUELL_LOG_WARNING ? spdlog::level::warn
              : level == QUELL_LOG_INFO  ? spdlog::level::info
                                         : spdlog::level::debug,
              message);
}

/// A trace that is not whole must not look like success.
ExitCode finish_trace(std::optional<TraceFile>& trace, ExitCode code) {
  try {
    if (trace) trace->commit();
    return code;
  } catch (const Error& error) {
    spdlog::error(error.what());
    return code == kOk ? kInternal : code;
  }
}

ExitCode exit_code_of(Ending ending) {
  switch (ending) {
    case Ending::done:
      return kOk;
    case Ending::failed:
    case Ending::stopped:
      return kFramesFailed;
    case Ending::interrupted:
      return kInterrupted;
  }
  return kInternal;
}

/// Of a frame that is told in its turn.
std::vector<MeasuredOutput> take_measured(MeasuringSink* measuring, const FrameReport& report) {
  if (!measuring) return {};
  if (report.ok) return measuring->take(report.frame);
  measuring->forget(report.frame);
  return {};
}

void tell_frame(const FrameReport& report, const BufferPool::Usage& usage, Preparation& run, Progress& progress, RunLog& log) {
  if (report.history_only) {
    progress.frame_done(report, usage.in_use + usage.idle);
    return log.frame(report, run.job.plan, usage);
  }
  const std::vector<MeasuredOutput> measured = take_measured(run.measuring.get(), report);
  const std::vector<Metric> metrics = run.measuring ? run.measuring->options().compare.metrics : std::vector<Metric>();
  progress.frame_done(report, usage.in_use + usage.idle, list_measured(measured, metrics));
  log.frame(report, run.job.plan, usage, measured, metrics);
}

/// What passes say goes to both logs, and signals cancel.
SessionOptions with_listeners(SessionOptions options, std::optional<TraceFile>& trace, RunLog& log) {
  options.log = [&](int level, const std::string& message) {
    log_of_pass(level, message);
    const bool known = level >= QUELL_LOG_WARNING;  // the log takes these from spdlog
    if (!known && (level >= QUELL_LOG_INFO || spdlog::should_log(spdlog::level::debug))) log.message(level, message);
  };
  options.cancelled = interrupted;
  options.trace = trace ? &trace->trace() : nullptr;
  return options;
}

/// What the session writes to.
FrameSink& front_sink(const Preparation& run) {
  if (run.measuring) return *run.measuring;
  if (run.tev) return *run.tev;
  if (run.video) return *run.video;
  return *run.sink;
}

/// With `watch`, what has changed since its last run.
RerunReport run_frames(Preparation& run, SessionOptions options, Progress& progress, RunLog& log, Watch* watch) {
  const Job& job = run.job;
  std::optional<Session> session;
  options.on_frame = [&](const FrameReport& report) {
    const BufferPool::Usage usage = watch ? watch->rerun.usage() : session->pool().usage();
    tell_frame(report, usage, run, progress, log);
    if (run.video && !report.history_only) run.video->end_frame(report.frame, report.ok);
  };
  FrameSink& sink = front_sink(run);
  if (watch) {
    watch->rerun.on_restart([&] {
      progress.restart();
      if (run.measuring) run.measuring->restart();
    });
    return watch->rerun.run(job.graph, job.frames, *job.source, sink, options, run.labels);
  }
  RerunReport report;
  session.emplace(job.graph, options);
  report.frames = run.checkpoints
                      ? run_with_checkpoints(*session, job, run.around, sink, *run.checkpoints, options)
                      : session->run(join(run.around.history_only, job.frames), *job.source, sink, context_of(run.around));
  std::erase_if(report.frames, [](const FrameReport& frame) { return frame.history_only; });  // which were told
  report.peak_bytes = session->pool().usage().peak;
  return report;
}

ExitCode compute(Preparation& run, std::optional<TraceFile>& trace, RunLog& log, Console& console, Watch* watch) {
  Job& job = run.job;
  Progress progress(console, run.around.history_only.size() + job.frames.size());
  const RerunReport rerun = run_frames(run, with_listeners(run.options, trace, log), progress, log, watch);
  const std::vector<FrameReport>& reports = rerun.frames;
  console.set_status("");
  if (run.video) run.video->finish();

  tell_new_warnings(job);
  if (run.measuring) tell_new_warnings(run.measuring->options(), job);
  if (watch) tell_computed(rerun, !watch->last);
  const bool is_all_kept = watch && rerun.results.empty();
  const std::vector<ResultFiles> written = watch ? select_results(run.results, rerun) : run.results;
  FrameSets frames = is_all_kept ? FrameSets{job.frames, {}, {}} : sort_frames(job.frames, reports);
  const Ending ending = ending_of(frames, run.options.on_error == OnError::stop);
  const RunOutcome outcome = {job,
                              written,
                              reports,
                              std::move(frames),
                              ending,
                              run.sink->clamped_pixels(),
                              progress.seconds(),
                              rerun.peak_bytes,
                              run.measuring.get()};
  if (!is_all_kept) tell_outcome(outcome);
  ExitCode code = finish_trace(trace, exit_code_of(ending));
  if (run.checkpoints && !tell_past_failures(*run.checkpoints) && code == kOk) code = kFramesFailed;
  if (run.checkpoints && !run.checkpoints->ok && code == kOk) code = kInternal;
  log.end(outcome, code);
  return log.ok() || code != kOk ? code : kInternal;
}

/// While a graph is watched, a tev that was closed is no reason to end.
void open_tev(Preparation& run, const std::string& address, const Watch* watch) {
  try {
    run.tev = std::make_unique<TevSink>(front_sink(run), address);
  } catch (const Error& error) {
    if (!watch || !watch->last) throw;
    spdlog::warn("{}; this run goes on without", error.what());
  }
}

std::unique_ptr<VideoSink> open_video(const RunArguments& arguments, const Job& job) {
  const PlannedResult result = find_video_output(job.plan);
  return std::make_unique<VideoSink>(
      VideoOptions{arguments.output.folder, result.name, job.plan.shape(result.from).size, frames_per_second(arguments)});
}

/// Opens what stands in front of the files, before anything is computed.
void open_sinks(Preparation& run, const RunArguments& arguments, const Watch* watch) {
  if (is_video(arguments.output.folder)) run.video = open_video(arguments, run.job);
  if (arguments.tev) open_tev(run, *arguments.tev, watch);
  if (run.to_measure) run.measuring = std::make_unique<MeasuringSink>(front_sink(run), std::move(*run.to_measure));
}

/// All frames were through before.
ExitCode end_at_once(const Preparation& run, RunLog& log) {
  const ExitCode code = !run.checkpoints || tell_past_failures(*run.checkpoints) ? kOk : kFramesFailed;
  const std::vector<FrameReport> none;
  log.end(RunOutcome{.job = run.job, .results = run.results, .reports = none}, code);
  return log.ok() || code != kOk ? code : kInternal;
}

ExitCode run_logged(const RunArguments& arguments, RunLog& log, Console& console, Watch* watch = nullptr) {
  Preparation run = prepare(arguments, watch);
  if (run.checkpoints) log.resume(run.checkpoints->past);
  if (run.job.frames.empty()) return end_at_once(run, log);
  const SessionOptions& options = run.options;
  const int threads = options.threads > 0 ? options.threads : available_threads();
  const Window window = choose_window(run.job.plan, threads, options.frames_in_flight, options.memory, options.reserved);
  if (arguments.dry_run) {
    std::cout << describe_dry_run(run.job, run.results, run.around, run.to_measure ? describe(*run.to_measure) : "");
    return kOk;
  }
  spdlog::debug("up to {} frames at a time ({}), and {} of images", window.frames, window.reason, format_bytes(window.memory));
  spdlog::debug("computing on {}", current_isa());
  prepare_folder(folder_of(arguments));
  open_sinks(run, arguments, watch);
  if (run.checkpoints) prepare_folder(run.checkpoints->folder.folder(), "--checkpoint");
  log.start(run.job, run.results, options, window);
  std::optional<TraceFile> trace;
  if (arguments.trace) trace.emplace(*arguments.trace);
  if (watch && watch->last) tell_left_files(watch->last->results, run.results);
  const ExitCode code = compute(run, trace, log, console, watch);
  run.measuring.reset();  // with the images that it holds
  if (watch) watch->last = std::move(run);
  return code;
}

/// Runs, and again whenever the graph is saved, until a signal comes: between runs that is a good end.
ExitCode run_watching(const RunArguments& arguments, RunLog& log, Console& console) {
  if (arguments.dry_run) throw Error(Fault::usage, "--watch", "there is nothing to watch with --dry-run; leave one of them out");
  if (arguments.checkpoint.folder)
    throw Error(Fault::usage, "--watch", "--checkpoint is for a single run; leave one of them out");
  if (arguments.chunk.chunk || arguments.chunk.preroll)
    throw Error(Fault::usage, "--watch", "--chunk and --preroll are for a single run; name the frames with --frames");
  if (arguments.trace) throw Error(Fault::usage, "--watch", "--trace is for a single run; leave one of them out");
  Watch watch(arguments);
  ExitCode code = run_logged(arguments, log, console, &watch);
  bool is_right = true;
  while (code != kInterrupted) {
    spdlog::info("waiting for {} to be saved; Ctrl-C ends", watch.last->job.graph->file.string());
    watch.files.add(watch.named);  // a link may lead elsewhere by now
    if (!watch.files.wait(!is_right, interrupt_event())) return kOk;
    try {
      code = run_logged(arguments, log, console, &watch);
      is_right = true;
    } catch (const Error& error) {
      spdlog::error(error.what());
      log.end(error.what(), exit_code(error.fault()));
      is_right = false;
    }
  }
  return code;
}

ExitCode run(RunArguments arguments, Console& console) {
  handle_interrupts();
  complete(arguments);
  set_verbosity(arguments.verbosity.verbosity());
  pin_isa(arguments.isa);
  RunLog log(arguments.dry_run ? RunLogFiles() : arguments.logs);
  try {
    return arguments.watch ? run_watching(arguments, log, console) : run_logged(arguments, log, console);
  } catch (const Error& error) {
    log.end(error.what(), exit_code(error.fault()));
    throw;
  } catch (const std::exception& error) {
    log.end(error.what(), kInternal);
    throw;
  }
}

}  // namespace

Command add_run(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("run", "Run a graph over a sequence of images.");
  app.footer(
      "Example:\n"
      "  quell run games202 shot/ -o denoised --frames 1-100 --set filter.radius=8\n"
      "reads shot/color.0001.exr and its like, and writes denoised/color.0001.exr to denoised/color.0100.exr.\n"
      "\n"
      "Exit status: 0 all is well, 1 some frames failed, 2 usage or graph, 3 input, 4 plugin, 33 memory limit too small, 70 "
      "internal error, 75 interrupted.");
  auto arguments = std::make_shared<RunArguments>();
  add_run_options(app, *arguments);
  app.add_flag("--watch", arguments->watch,
               "After the run wait until the graph file, one that it includes or a --params file is saved, and compute anew what "
               "that can affect; Ctrl-C ends.")
      ->disable_flag_override()
      ->group(kScheduleGroup);
  app.add_flag("-n,--dry-run", arguments->dry_run, "Say what would be read, run and written, and stop there.")
      ->disable_flag_override()
      ->group(kOtherGroup);
  add_options(app, arguments->verbosity);
  return {&app, [arguments](Console& console) { return run(*arguments, console); }};
}

}  // namespace quell::app
