// quell run: a graph over a sequence.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "arguments.h"
#include "checkpointed_run.h"
#include "commands.h"
#include "graph_files.h"
#include "interrupt.h"
#include "isa_option.h"
#include "job.h"
#include "output_options.h"
#include "progress.h"
#include "quell/runtime/rerun.h"
#include "quell/runtime/session.h"
#include "quell/runtime/window.h"
#include "quell/simd/isa.h"
#include "results.h"
#include "run_log.h"
#include "run_options.h"
#include "run_reference.h"
#include "run_summary.h"
#include "tev_sink.h"
#include "trace_file.h"
#include "variants.h"
#include "video_sink.h"
#include "watched_files.h"

namespace quell::app {
namespace {

struct Arguments {
  GraphArguments graph;
  SequenceArguments sequence;
  ScheduleArguments schedule;
  IsaArguments isa;
  VerbosityArguments verbosity;
  OutputArguments output;
  ReferenceArguments reference;
  CheckpointArguments checkpoint;
  std::vector<std::string> dumps;
  RunLogFiles logs;
  std::optional<std::filesystem::path> trace;
  std::optional<std::string> tev;
  std::optional<std::string> frames_per_second;
  bool dry_run = false, watch = false;
};

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

/// What a run needs before its first frame.
struct Preparation {
  Job job;
  std::unique_ptr<FileSink> sink;
  std::optional<MeasuringOptions> to_measure;  ///< with `measuring`, which takes them
  std::unique_ptr<VideoSink> video;            ///< in place of `sink`; null without a video
  std::unique_ptr<TevSink> tev;                ///< in front of that; null without --tev
  std::unique_ptr<MeasuringSink> measuring;    ///< in front of all; null without --reference
  std::vector<ResultFiles> results;
  std::map<std::string, std::string> labels;  ///< of the results, as label_results() has them
  SessionOptions options;
  std::optional<Checkpoints> checkpoints;
};

/// Runs that follow each other.
struct Watch {
  explicit Watch(const Arguments& arguments)
      : passes(load_passes(arguments.graph.plugins)), named(arguments.graph.options.params), rerun(arguments.output.is_layered) {
    named.push_back(find_graph(arguments.graph.graph));
    files.add(named);
  }
  Registry passes;
  std::vector<std::filesystem::path> named;  ///< files of the command line
  WatchedFiles files;
  Rerun rerun;
  std::optional<Preparation> last;  ///< of the last run
};

/// Of a frame that is told in its turn.
std::vector<MeasuredOutput> take_measured(MeasuringSink* measuring, const FrameReport& report) {
  if (!measuring) return {};
  if (report.ok) return measuring->take(report.frame);
  measuring->forget(report.frame);
  return {};
}

void tell_frame(const FrameReport& report, const BufferPool::Usage& usage, Preparation& run, Progress& progress, RunLog& log) {
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
    if (run.video) run.video->end_frame(report.frame, report.ok);
  };
  FrameSink& sink = front_sink(run);
  if (watch) {
    watch->rerun.on_restart([&] {
      progress.restart();
      if (run.measuring) run.measuring->restart();
    });
    return watch->rerun.run(job.graph, job.frames, *job.sequence, sink, options, run.labels);
  }
  RerunReport report;
  session.emplace(job.graph, options);
  report.frames = run.checkpoints ? run_with_checkpoints(*session, job, sink, *run.checkpoints, options)
                                  : session->run(job.frames, *job.sequence, sink);
  report.peak_bytes = session->pool().usage().peak;
  return report;
}

ExitCode compute(Preparation& run, std::optional<TraceFile>& trace, RunLog& log, Console& console, Watch* watch) {
  Job& job = run.job;
  Progress progress(console, job.frames.size());
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
  const Ending ending = ending_of(frames, run.options.stop_on_error);
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

/// Nothing without --reference.
std::optional<MeasuringOptions> find_measuring(const Arguments& arguments, const Job& job,
                                               const std::vector<ResultFiles>& results, int threads) {
  std::optional<MeasuringOptions> options = prepare_measuring(arguments.reference, arguments.sequence, job, results);
  if (options && !arguments.dry_run) complete_measuring(*options, threads);
  return options;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

/// What a video cannot do must not be ignored.
void check_video(const Arguments& arguments) {
  const auto refuse = [](const char* option) {
    throw Error(Fault::usage, option, "it is for images, and --out names a video; name a folder, or leave it out");
  };
  if (!arguments.dumps.empty()) refuse("--dump");
  if (!arguments.output.formats.empty()) refuse("--format");
  if (arguments.output.is_layered) refuse("--layers");
  if (arguments.output.keep_channels) refuse("--keep-channels");
  if (arguments.output.type != OutputArguments().type) refuse("--type");
  if (arguments.output.compression != OutputArguments().compression) refuse("--compression");
  if (!arguments.output.padding.empty()) refuse("--padding");
  if (arguments.watch) refuse("--watch");
  if (arguments.checkpoint.folder) refuse("--checkpoint");
  check_video_file(arguments.output.folder);
}

double frames_per_second(const Arguments& arguments) {
  return parse_number(arguments.frames_per_second.value_or("24"), "--fps", 0.01, 1000);
}

/// One file, of every frame.
std::vector<ResultFiles> list_video(const Job& job, const std::filesystem::path& file) {
  return {{find_video_output(job.plan).name, file.string(), std::vector<std::filesystem::path>(job.frames.size(), file)}};
}

std::unique_ptr<VideoSink> open_video(const Arguments& arguments, const Job& job) {
  const PlannedResult result = find_video_output(job.plan);
  return std::make_unique<VideoSink>(
      VideoOptions{arguments.output.folder, result.name, job.plan.shape(result.from).size, frames_per_second(arguments)});
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

/// Opens what stands in front of the files, before anything is computed.
void open_sinks(Preparation& run, const Arguments& arguments, const Watch* watch) {
  if (is_video(arguments.output.folder)) run.video = open_video(arguments, run.job);
  if (arguments.tev) open_tev(run, *arguments.tev, watch);
  if (run.to_measure) run.measuring = std::make_unique<MeasuringSink>(front_sink(run), std::move(*run.to_measure));
}

Preparation prepare(const Arguments& arguments, Watch* watch) {
  const bool is_to_video = is_video(arguments.output.folder);
  if (is_to_video) check_video(arguments);
  if (!is_to_video && arguments.frames_per_second)
    throw Error(Fault::usage, "--fps",
                "it is for videos, and --out names a folder; name a video, such as out.mp4, or leave it out");
  frames_per_second(arguments);  // what it cannot be is told before the run
  SessionOptions options = parse_schedule(arguments.schedule);
  options.dumps = arguments.dumps;
  OutputArguments files = arguments.output;
  if (is_to_video) files.folder = folder_of(arguments.output.folder);
  FileSinkOptions output = parse_output(files);
  const std::shared_ptr<const Graph> graph = watch ? load(arguments.graph, watch->passes) : load(arguments.graph);
  if (watch) watch->files.add(graph->files);
  const Job* before = watch && watch->last ? &watch->last->job : nullptr;
  const bool stays_open = before && same_inputs(*before->graph, *graph);
  Job job = prepare_job(graph, arguments.sequence, arguments.dumps, stays_open ? before->sequence : nullptr);
  if (before && !same_files(*before, job)) watch->rerun.forget();
  warn_of_idle_cuts(options.cuts, job.frames, job.plan);
  complete_output(output, arguments.output, job);
  auto sink = std::make_unique<FileSink>(output);
  std::vector<ResultFiles> results = is_to_video ? list_video(job, arguments.output.folder) : list_results(job, *sink, output);
  refuse_to_replace_inputs(job, results);
  if (output.keep_channels) tell_kept_channels(*sink, job);
  std::map<std::string, std::string> labels = label_results(output, job);
  std::optional<MeasuringOptions> measuring = find_measuring(arguments, job, results, options.threads);
  Preparation run{.job = std::move(job), .sink = std::move(sink), .to_measure = std::move(measuring)};
  run.results = std::move(results), run.labels = std::move(labels), run.options = std::move(options);
  return run;
}

/// All frames were through before.
ExitCode end_at_once(const Preparation& run, RunLog& log) {
  const ExitCode code = tell_past_failures(*run.checkpoints) ? kOk : kFramesFailed;
  const std::vector<FrameReport> none;
  log.end(RunOutcome{.job = run.job, .results = run.results, .reports = none}, code);
  return log.ok() || code != kOk ? code : kInternal;
}

ExitCode run_logged(const Arguments& arguments, RunLog& log, Console& console, Watch* watch = nullptr) {
  Preparation run = prepare(arguments, watch);
  run.checkpoints = prepare_checkpoints(arguments.checkpoint, arguments.sequence, run.job, run.options);
  if (run.checkpoints) log.resume(run.checkpoints->past);
  if (run.job.frames.empty()) return end_at_once(run, log);
  const SessionOptions& options = run.options;
  const int threads = options.threads > 0 ? options.threads : available_threads();
  const Window window = choose_window(run.job.plan, threads, options.frames_in_flight, options.memory);
  if (arguments.dry_run) {
    std::cout << describe_dry_run(run.job, run.results, run.to_measure ? describe(*run.to_measure) : "");
    return kOk;
  }
  spdlog::debug("up to {} frames at a time ({}), and {} of images", window.frames, window.reason, format_bytes(window.memory));
  spdlog::debug("computing on {}", current_isa());
  prepare_folder(is_video(arguments.output.folder) ? folder_of(arguments.output.folder) : arguments.output.folder);
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
ExitCode run_watching(const Arguments& arguments, RunLog& log, Console& console) {
  if (arguments.dry_run) throw Error(Fault::usage, "--watch", "there is nothing to watch with --dry-run; leave one of them out");
  if (arguments.checkpoint.folder)
    throw Error(Fault::usage, "--watch", "--checkpoint is for a single run; leave one of them out");
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

ExitCode run(const Arguments& arguments, Console& console) {
  handle_interrupts();
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

void add_output_options(CLI::App& app, Arguments& arguments) {
  add_options(app, arguments.output);
  add_repeatable(app, "--dump", arguments.dumps, "NODE.PORT", "Write an inner image of the graph, too; repeatable.")
      ->group(kOutputGroup);
  app.add_option("--fps", arguments.frames_per_second, "Frames per second of a video; 24 by default.")
      ->type_name("N")
      ->group(kOutputGroup);
  app.add_option("--tev", arguments.tev, "Show images in a running tev, the viewer, too, as they are finished.")
      ->type_name("HOST:PORT")
      ->group(kOutputGroup);
  app.add_option("--log-json", arguments.logs.lines, "Write what happens to a file, one JSON object a line, as it happens.")
      ->type_name("FILE")
      ->group(kOutputGroup);
  app.add_option("--report", arguments.logs.report,
                 "Write one JSON file about the whole run when it ends, well or not: every frame, with times, sizes and errors.")
      ->type_name("FILE")
      ->group(kOutputGroup);
  app.add_option("--trace", arguments.trace,
                 "Write which thread did what when, and the memory held, for ui.perfetto.dev or chrome://tracing.")
      ->type_name("FILE")
      ->group(kOutputGroup);
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
  auto arguments = std::make_shared<Arguments>();
  add_options(app, arguments->graph);
  add_options(app, arguments->sequence);
  add_options(app, arguments->reference);
  add_output_options(app, *arguments);
  add_options(app, arguments->schedule);
  add_options(app, arguments->checkpoint);
  add_options(app, arguments->isa);
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
