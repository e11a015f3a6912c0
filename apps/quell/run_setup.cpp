#include "run_setup.h"

#include <CLI/CLI.hpp>

#include "graph_files.h"
#include "memory_promise.h"
#include "quell/text/error.h"
#include "skip_existing.h"
#include "variants.h"

namespace quell::app {
namespace {

/// Nothing without --reference.
std::optional<MeasuringOptions> find_measuring(const RunArguments& arguments, const Job& job,
                                               const std::vector<ResultFiles>& results, int threads) {
  std::optional<MeasuringOptions> options = prepare_measuring(arguments.reference, arguments.sequence, job, results);
  if (options && !arguments.dry_run) complete_measuring(*options, threads);
  return options;
}

/// What a video cannot do must not be ignored.
void check_video(const RunArguments& arguments) {
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

/// One file, of every frame.
std::vector<ResultFiles> list_video(const Job& job, const std::filesystem::path& file) {
  return {{find_video_output(job.plan).name, file.string(), std::vector<std::filesystem::path>(job.frames.size(), file)}};
}

void add_output_options(CLI::App& app, RunArguments& arguments) {
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

Watch::Watch(const RunArguments& arguments)
    : passes(load_passes(arguments.graph.plugins)), named(arguments.graph.options.params), rerun(arguments.output.is_layered) {
  named.push_back(find_graph(arguments.graph.graph));
  files.add(named);
}

void add_run_options(CLI::App& app, RunArguments& arguments) {
  add_options(app, arguments.graph);
  add_options(app, arguments.sequence);
  add_options(app, arguments.reference);
  add_output_options(app, arguments);
  add_options(app, arguments.schedule);
  add_options(app, arguments.chunk);
  add_options(app, arguments.checkpoint);
  app.add_flag("--skip-existing", arguments.skip_existing,
               "Leave out frames whose files are there, whole, newer than what they were made of, and of the same graph and "
               "inputs by their headers; their history is computed where later frames need it.")
      ->disable_flag_override()
      ->group(kScheduleGroup);
  add_text(app, "--on-missing", arguments.on_missing, "WHAT",
           "When files of a frame are missing: error; hold, the latest earlier file stands in; reset, the frame is left out, and "
           "history ends there. auto, the default, is an error for frames named by --frames, and else leaves them out.")
      ->group(kScheduleGroup);
  app.add_flag("--keep-going", arguments.keep_going,
               "Compute what can be computed: frames of which files are missing fail, as others do, and the rest goes on.")
      ->disable_flag_override()
      ->group(kScheduleGroup);
  add_options(app, arguments.isa);
}

double frames_per_second(const RunArguments& arguments) {
  return parse_number(arguments.frames_per_second.value_or("24"), "--fps", 0.01, 1000);
}

std::filesystem::path folder_of(const RunArguments& arguments) {
  const std::filesystem::path& out = arguments.output.folder;
  if (!is_video(out)) return out;
  return out.has_parent_path() ? out.parent_path() : std::filesystem::path(".");
}

void complete(RunArguments& arguments) {
  const std::size_t choice = parse_choice(arguments.on_missing, "--on-missing", {"auto", "error", "hold", "reset"});
  arguments.sequence.on_missing = static_cast<OnMissing>(choice);
  if (arguments.keep_going) {
    if (choice == 0) arguments.sequence.on_missing = OnMissing::fail;
    if (arguments.schedule.on_error == "stop")
      throw Error(Fault::usage, "--keep-going", "--on-error stop says the opposite; leave one of them out");
  }
  const auto refuse = [&](const char* option) {
    throw Error(Fault::usage, "--skip-existing", std::string("it does not go with ") + option + "; leave one of them out");
  };
  if (!arguments.skip_existing) return;
  if (is_video(arguments.output.folder)) refuse("a video");
  if (arguments.watch) refuse("--watch");
  if (arguments.checkpoint.folder) refuse("--checkpoint, whose --resume knows what is done");
  if (arguments.reference.reference) refuse("--reference, which measures what is computed");
}

Preparation prepare(const RunArguments& arguments, Watch* watch) {
  const bool is_to_video = is_video(arguments.output.folder);
  if (is_to_video) check_video(arguments);
  if (!is_to_video && arguments.frames_per_second)
    throw Error(Fault::usage, "--fps",
                "it is for videos, and --out names a folder; name a video, such as out.mp4, or leave it out");
  frames_per_second(arguments);  // what it cannot be is told before the run
  SessionOptions options = parse_schedule(arguments.schedule);
  options.dumps = arguments.dumps;
  OutputArguments files = arguments.output;
  files.folder = folder_of(arguments);
  FileSinkOptions output = parse_output(files);
  const std::shared_ptr<const Graph> graph = watch ? load(arguments.graph, watch->passes) : load(arguments.graph);
  if (watch) watch->files.add(graph->files);
  const Job* before = watch && watch->last ? &watch->last->job : nullptr;
  const bool stays_open = before && same_inputs(*before->graph, *graph);
  Job job = prepare_job(graph, arguments.sequence, arguments.dumps, stays_open ? before->sequence : nullptr);
  if (before && !same_files(*before, job)) watch->rerun.forget();
  options.cuts.insert(options.cuts.end(), job.cuts.begin(), job.cuts.end());
  Surroundings around = choose_chunk(arguments.chunk, arguments.sequence, options.cuts, job);
  warn_of_idle_cuts(options.cuts, job.frames, job.plan);
  std::optional<Checkpoints> checkpoints = prepare_checkpoints(arguments.checkpoint, arguments.sequence, job, around, options);
  if (job.frames.empty())
    return {.job = std::move(job), .output = {}, .sink = {}, .checkpoints = std::move(checkpoints)};  // all are through
  complete_output(output, arguments.output, job, describe_inputs(job, arguments.sequence, options, around));
  auto sink = std::make_unique<FileSink>(output);
  std::vector<ResultFiles> results = is_to_video ? list_video(job, arguments.output.folder) : list_results(job, *sink, output);
  refuse_to_replace_inputs(job, results);
  if (output.keep_channels) tell_kept_channels(*sink, job);
  if (arguments.skip_existing) skip_existing(job, around, results, output);
  if (arguments.skip_existing && !job.frames.empty()) results = list_results(job, *sink, output);
  std::map<std::string, std::string> labels = label_results(output, job);
  std::optional<MeasuringOptions> measuring = find_measuring(arguments, job, results, options.threads);
  options.reserved = estimate_beside_images(job, options.threads, measuring.has_value());
  Preparation run{
      .job = std::move(job), .output = std::move(output), .sink = std::move(sink), .to_measure = std::move(measuring)};
  run.results = std::move(results), run.labels = std::move(labels), run.options = std::move(options);
  run.around = std::move(around);
  run.checkpoints = std::move(checkpoints);
  if (const std::string preroll = describe(run.around); !preroll.empty() && !arguments.dry_run) spdlog::info(preroll);
  return run;
}

}  // namespace quell::app
