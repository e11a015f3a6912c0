// quell plan: what a run would do, and how long it would take.
#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>

#include "commands.h"
#include "interrupt.h"
#include "json_lines.h"
#include "memory_promise.h"
#include "progress.h"
#include "quell/runtime/window.h"
#include "run_setup.h"
#include "temporary_folder.h"

namespace quell::app {
namespace {

constexpr std::size_t kMeasured = 4;  // frames: the first pays for what is made once

struct PlanArguments {
  RunArguments run;
  bool json = false, no_measure = false;
};

/// What a run would do, by numbers.
struct Forecast {
  Window window;
  std::size_t beside_images = 0, images = 0;
  std::size_t files_read = 0, files_written = 0, files_replaced = 0;
  std::optional<double> seconds_per_frame;
  std::size_t frames = 0;  ///< those of the pre-roll included

  std::optional<double> seconds() const {
    if (!seconds_per_frame) return std::nullopt;
    return *seconds_per_frame * static_cast<double>(frames);
  }
};

/// Computes a few frames into a folder that does not outlast the call; nothing when one fails, which a run would tell.
std::optional<double> measure(const Preparation& run, Console& console) {
  const TemporaryFolder folder;
  FileSinkOptions output = run.output;
  output.folder = folder.path();
  FileSink sink(output);
  std::vector<std::int64_t> frames = run.job.frames;
  frames.resize(std::min(frames.size(), kMeasured));
  std::vector<std::chrono::steady_clock::time_point> ends = {std::chrono::steady_clock::now()};
  SessionOptions options = run.options;
  options.cancelled = interrupted;
  options.on_frame = [&](const FrameReport&) { ends.push_back(std::chrono::steady_clock::now()); };
  console.set_status("computing " + std::to_string(frames.size()) + " frames to measure them");
  const std::vector<FrameReport> reports = Session(run.job.graph, options).run(frames, *run.job.source, sink);
  console.set_status("");
  if (reports.size() < frames.size() || std::ranges::any_of(reports, [](const FrameReport& report) { return !report.ok; }))
    return std::nullopt;
  // The first frame makes what lasts, unless there is no other.
  const std::size_t first = frames.size() > 1 ? 1 : 0;
  return std::chrono::duration<double>(ends.back() - ends[first]).count() / static_cast<double>(frames.size() - first);
}

Forecast forecast(const Preparation& run, const PlanArguments& arguments, Console& console) {
  const SessionOptions& options = run.options;
  const int threads = options.threads > 0 ? options.threads : available_threads();
  Forecast all;
  all.frames = run.around.history_only.size() + run.job.frames.size();
  all.window = choose_window(run.job.plan, threads, options.frames_in_flight, options.memory, options.reserved);
  all.beside_images = options.reserved;
  const auto in_flight = std::min(static_cast<std::size_t>(all.window.frames), all.frames);
  all.images = std::min(all.window.memory, all.window.fixed_bytes + in_flight * all.window.bytes_per_frame);
  all.files_read = run.job.inputs.size() * all.frames;
  for (const ResultFiles& series : run.results)
    for (const std::filesystem::path& file : series.files) {
      std::error_code error;
      ++all.files_written;
      all.files_replaced += std::filesystem::exists(file, error);
    }
  if (!arguments.no_measure) all.seconds_per_frame = measure(run, console);
  return all;
}

std::string tell(const Forecast& forecast) {
  std::string text = "memory: " + format_bytes(forecast.images) + " of images, for " + std::to_string(forecast.window.frames) +
                     " frame" + (forecast.window.frames == 1 ? "" : "s") + " at a time (" + forecast.window.reason +
                     "), and up to " + format_bytes(forecast.beside_images) + " for all else\n";
  if (const std::optional<double> seconds = forecast.seconds())
    text += "time: about " + format_duration(*seconds) + ", " + format_duration(*forecast.seconds_per_frame) + " a frame\n";
  return text;
}

std::string to_json(const Preparation& run, const Forecast& forecast) {
  JsonObject inputs;
  for (const InputFiles& input : run.job.inputs) inputs.text(input.input, input.pattern);
  std::vector<std::string> outputs, nodes;
  for (const ResultFiles& series : run.results) outputs.push_back(series.pattern);
  for (const PlannedNode& node : run.job.plan.nodes)
    nodes.push_back(run.job.graph->nodes[static_cast<std::size_t>(node.node)].name);
  JsonObject memory;
  memory.number("images", forecast.images).number("beside_images", forecast.beside_images);
  JsonObject all;
  all.text("graph", run.job.graph->file.string())
      .object("inputs", inputs)
      .texts("nodes", nodes)
      .texts("outputs", outputs)
      .text("frames", run.job.frames.empty() ? "" : FrameRange(run.job.frames).text())
      .number("frame_count", run.job.frames.size())
      .text("history_only", run.around.history_only.empty() ? "" : FrameRange(run.around.history_only).text())
      .text("preroll", run.around.reason)
      .number("files_read", forecast.files_read)
      .number("files_written", forecast.files_written)
      .number("files_replaced", forecast.files_replaced)
      .number("frames_in_flight", forecast.window.frames)
      .object("memory_bytes", memory);
  if (forecast.seconds()) all.seconds("seconds", *forecast.seconds()).seconds("seconds_per_frame", *forecast.seconds_per_frame);
  return all.str() + "\n";
}

ExitCode plan(PlanArguments arguments, Console& console) {
  handle_interrupts();
  arguments.run.dry_run = true;
  if (arguments.run.output.folder.empty()) arguments.run.output.folder = "denoised";
  complete(arguments.run);
  set_verbosity(arguments.run.verbosity.verbosity());
  pin_isa(arguments.run.isa);
  Preparation run = prepare(arguments.run);
  if (run.job.frames.empty()) {
    std::cout << (arguments.json ? "{\"frame_count\":0}\n" : "nothing is left to do\n");
    return kOk;
  }
  const Forecast found = forecast(run, arguments, console);
  if (interrupted()) return kInterrupted;
  if (arguments.json)
    std::cout << to_json(run, found);
  else
    std::cout << describe_dry_run(run.job, run.results, run.around, tell(found));
  return kOk;
}

}  // namespace

Command add_plan(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("plan", "Say what a run would read, compute and write, and how long it would take.");
  app.footer(
      "Example:\n"
      "  quell plan games202 shot/ -o denoised --chunk 2/4\n"
      "takes the options of quell run, and computes a few frames to see how long they take. Writes nothing.");
  auto arguments = std::make_shared<PlanArguments>();
  add_run_options(app, arguments->run);
  app.get_option("--out")->required(false);
  app.add_flag("--json", arguments->json, "Print JSON.")->disable_flag_override()->group(kOtherGroup);
  app.add_flag("--no-measure", arguments->no_measure, "Compute nothing, and say nothing of time.")
      ->disable_flag_override()
      ->group(kOtherGroup);
  add_options(app, arguments->run.verbosity);
  return {&app, [arguments](Console& console) { return plan(*arguments, console); }};
}

}  // namespace quell::app
