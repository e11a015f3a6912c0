// quell run: a graph over a sequence.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "arguments.h"
#include "commands.h"
#include "interrupt.h"
#include "job.h"
#include "progress.h"
#include "quell/runtime/session.h"
#include "results.h"
#include "run_summary.h"

namespace quell::app {
namespace {

constexpr int kMostThreads = 1024;

struct Arguments {
  GraphArguments graph;
  SequenceArguments sequence;
  VerbosityArguments verbosity;
  std::filesystem::path out;
  std::string type = "auto";
  std::string compression = "zip";
  std::string padding;
  std::vector<std::string> formats;
  std::string threads = "0";
  std::vector<std::string> dumps;
  bool dry_run = false;
};

/// Throws Error(usage) for what cannot be. Without --padding the digits are still to be taken from the sequence.
FileSinkOptions parse_output(const Arguments& arguments) {
  FileSinkOptions options;
  if (arguments.out.empty()) throw Error(Fault::usage, "--out", "the name is empty; name a folder for the results");
  options.folder = arguments.out;
  options.type = parse_pixel_type(arguments.type);
  options.compression = arguments.compression;
  if (!arguments.padding.empty()) options.padding = parse_count(arguments.padding, "--padding", 1, 20);
  if (!arguments.formats.empty()) options.formats.clear();
  for (const std::string& format : arguments.formats) {
    const FileFormat parsed = parse_file_format(format);
    if (std::find(options.formats.begin(), options.formats.end(), parsed) == options.formats.end())
      options.formats.push_back(parsed);
  }
  const FileSink checked(options);  // it knows the compressions
  return options;
}

void log_of_pass(int level, const std::string& message) {
  spdlog::log(level >= QUELL_LOG_WARNING ? spdlog::level::warn
              : level == QUELL_LOG_INFO  ? spdlog::level::info
                                         : spdlog::level::debug,
              message);
}

ExitCode tell_interrupted(const Job& job, const std::vector<FrameReport>& reports) {
  std::vector<std::int64_t> done;
  for (const FrameReport& report : reports)
    if (report.ok) done.push_back(report.frame);
  const std::vector<std::int64_t> rest(job.frames.begin() + static_cast<std::ptrdiff_t>(reports.size()), job.frames.end());
  spdlog::error("interrupted; frames done: {}; not computed: {}", FrameRange(done).text(), FrameRange(rest).text());
  return kInterrupted;
}

ExitCode compute(Job& job, const Arguments& arguments, int threads, FileSink& sink, const std::vector<ResultFiles>& results,
                 Console& console) {
  SessionOptions options;
  options.threads = threads;
  options.dumps = arguments.dumps;
  options.log = log_of_pass;
  options.cancelled = interrupted;
  Session* running = nullptr;
  Progress progress(console, job.frames.size());
  options.on_frame = [&](const FrameReport& report) {
    const BufferPool::Usage usage = running->pool().usage();
    progress.frame_done(report, usage.in_use + usage.idle);
  };
  Session session(job.graph, options);
  running = &session;
  const std::vector<FrameReport> reports = session.run(job.frames, *job.sequence, sink);
  console.set_status("");

  tell_new_warnings(job);
  tell_outcome({job, results, reports, sink.clamped_pixels(), progress.seconds(), session.pool().usage().peak});
  if (session.plan()) tell_node_times(*session.plan(), reports);
  if (reports.size() < job.frames.size()) return tell_interrupted(job, reports);
  const auto failed = [](const FrameReport& report) { return !report.ok; };
  return std::any_of(reports.begin(), reports.end(), failed) ? kFramesFailed : kOk;
}

ExitCode run(const Arguments& arguments, Console& console) {
  handle_interrupts();
  set_verbosity(arguments.verbosity.verbosity());
  const int threads = parse_count(arguments.threads, "--threads", 0, kMostThreads);
  FileSinkOptions output = parse_output(arguments);
  Job job = prepare_job(load(arguments.graph), arguments.sequence, arguments.dumps);
  if (arguments.padding.empty()) output.padding = job.sequence->padding();
  FileSink sink(output);
  const std::vector<ResultFiles> results = list_results(job, sink, output);
  refuse_to_replace_inputs(job, results);
  if (arguments.dry_run) {
    std::cout << describe_dry_run(job, results);
    return kOk;
  }
  prepare_folder(output.folder);
  return compute(job, arguments, threads, sink, results, console);
}

void add_output_options(CLI::App& app, Arguments& arguments) {
  app.add_option("-o,--out", arguments.out, "The folder for the results; made when needed.")
      ->type_name("FOLDER")
      ->required()
      ->group(kOutputGroup);
  add_text(app, "--type", arguments.type, "TYPE",
           "Numbers in EXR files: half, float, or auto: half for color and albedo, float for all else.")
      ->group(kOutputGroup);
  add_text(app, "--compression", arguments.compression, "METHOD",
           "Of EXR files: none, rle, zips, zip (the default), piz, pxr24, b44, b44a, dwaa or dwab.")
      ->group(kOutputGroup);
  add_repeatable(app, "--format", arguments.formats, "FORMAT",
                 "exr (the default) or png (8 bit, sRGB, clamped); repeat it to write both.")
      ->group(kOutputGroup);
  add_text(app, "--padding", arguments.padding, "DIGITS",
           "Digits of the frame numbers in file names; as in the input, or 4 where that is not padded.")
      ->group(kOutputGroup);
  add_repeatable(app, "--dump", arguments.dumps, "NODE.PORT", "Write an inner image of the graph, too; repeatable.")
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
      "Exit status: 0 all is well, 1 some frames failed, 2 usage or graph, 3 input, 4 plugin, 70 internal error, 75 "
      "interrupted.");
  auto arguments = std::make_shared<Arguments>();
  add_options(app, arguments->graph);
  add_options(app, arguments->sequence);
  add_output_options(app, *arguments);
  add_text(app, "--threads", arguments->threads, "N",
           "Threads to compute with; 0, the default, for as many as there are processors.")
      ->group(kOtherGroup);
  app.add_flag("-n,--dry-run", arguments->dry_run, "Say what would be read, run and written, and stop there.")
      ->disable_flag_override()
      ->group(kOtherGroup);
  add_options(app, arguments->verbosity);
  return {&app, [arguments](Console& console) { return run(*arguments, console); }};
}

}  // namespace quell::app
