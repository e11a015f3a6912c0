// quell compare: how far images are from a reference.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "arguments.h"
#include "commands.h"
#include "comparison_files.h"
#include "comparison_job.h"
#include "comparison_outputs.h"
#include "comparison_pictures.h"
#include "comparison_table.h"
#include "figure_text.h"
#include "interrupt.h"
#include "isa_option.h"
#include "progress.h"
#include "quell/text/diagnostic.h"
#include "text_output.h"

namespace quell::app {
namespace {

struct Arguments {
  ComparisonArguments comparison;
  VerbosityArguments verbosity;
  std::string threads = "0";
  IsaArguments isa;
  ComparisonOutputs outputs;
  std::vector<std::string> fail_above, fail_below;
  bool each_frame = false, summary = false;
};

constexpr int kMostThreads = 1024;

std::vector<Threshold> parse_thresholds(const Arguments& arguments) {
  std::vector<Threshold> thresholds;
  for (const std::string& text : arguments.fail_above) thresholds.push_back(parse_threshold(text, true));
  for (const std::string& text : arguments.fail_below) thresholds.push_back(parse_threshold(text, false));
  for (const Threshold& threshold : thresholds)
    if (const std::string text = doubt(threshold); !text.empty()) spdlog::warn(text);
  if (arguments.each_frame && thresholds.empty())
    throw Error(Fault::usage, "--each-frame", "there is no bar to be kept; add --fail-above or --fail-below");
  return thresholds;
}

/// False when a signal came.
bool choose_exposures(ComparisonJob& job, Executor& executor, Console& console) {
  if (!contains(job.options.metrics, Metric::hdr_flip) || job.options.exposures) return true;
  const bool is_shown = spdlog::should_log(spdlog::level::info);
  job.options.exposures = find_exposures(job.reference, job.frames, executor, interrupted, [&](std::size_t done) {
    if (is_shown) console.set_status("choosing exposures: " + std::to_string(done) + "/" + std::to_string(job.frames.size()));
  });
  console.set_status("");
  return job.options.exposures.has_value();
}

std::vector<ComparedFrame> compare_frames(const Arguments& arguments, const ComparisonJob& job, Executor& executor,
                                          WorstFrame& worst, Console& console) {
  const ComparisonOutputs& outputs = arguments.outputs;
  Progress progress(console, job.frames.size());
  ComparisonHooks hooks;
  hooks.cancelled = interrupted;
  hooks.on_frame = [&](const ComparedFrame& frame, const FramePictures* pictures) {
    if (pictures && outputs.maps) write_maps(*outputs.maps, job, *pictures, executor);
    if (pictures && outputs.picture) worst.look_at(frame, *pictures);
    FrameReport report;
    report.frame = frame.frame, report.ok = frame.error.empty(), report.error = frame.error, report.seconds = frame.seconds;
    progress.frame_done(report, 0);
  };
  return run_comparison(job, executor, hooks);
}

/// Which frames of an image had such pixels.
void warn_of_bad_pixels(const std::string& label, const std::vector<ComparedFrame>& frames, const auto& count_of) {
  std::uint64_t count = 0;
  std::vector<std::int64_t> where;
  for (const ComparedFrame& frame : frames)
    if (const std::uint64_t bad = frame.error.empty() ? count_of(frame) : 0; bad > 0) count += bad, where.push_back(frame.frame);
  if (count == 0) return;
  spdlog::warn("{}: {} (frame{} {}) and left out of all figures", label, describe_bad_pixels(count), where.size() > 1 ? "s" : "",
               FrameRange(where).text());
}

void warn_of_what_is_left_out(const ComparisonJob& job, const std::vector<ComparedFrame>& frames) {
  warn_of_bad_pixels("reference", frames, [](const ComparedFrame& frame) { return frame.bad_pixels_in_reference; });
  for (std::size_t i = 0; i < job.images.size(); ++i)
    warn_of_bad_pixels(job.labels[i], frames, [i](const ComparedFrame& frame) { return frame.images[i].bad_pixels; });
  std::vector<std::int64_t> without_motion;
  for (const ComparedFrame& frame : frames)
    if (frame.lacks_motion) without_motion.push_back(frame.frame);
  if (!without_motion.empty())
    spdlog::warn("warped is not told where there is no motion: {} has no file for {}", job.motion->files(),
                 FrameRange(without_motion).text());
}

void tell_warnings_of_files(const ComparisonJob& job) {
  std::set<std::string> warnings;
  const auto add = [&](const ImageSeries& series) {
    for (std::string& warning : series.sequence()->warnings()) warnings.insert(std::move(warning));
  };
  add(job.reference);
  for (const ImageSeries& image : job.images) add(image);
  if (job.motion) add(*job.motion);
  for (const std::string& warning : warnings) spdlog::warn(warning);
}

void write_results(const Arguments& arguments, const ComparisonJob& job, const std::vector<ComparedFrame>& frames,
                   const WorstFrame& worst) {
  const auto& [maps, picture, json, csv] = arguments.outputs;
  const auto place = [](const std::optional<std::string>& name) { return name == kToOutput ? std::nullopt : name; };
  // What is looked at comes first: writing files may fail.
  if (json != kToOutput && csv != kToOutput) std::cout << printable(make_table(job, frames, arguments.summary)) << std::flush;
  if (json) write_output(comparison_json(job, frames), place(json), kComparisonJson, "--json");
  if (csv) write_output(comparison_csv(job, frames), place(csv), kComparisonCsv, "--csv");
  std::cout << std::flush;  // before what goes to the other stream
  if (!picture) return;
  if (worst.draw(*picture) == std::optional(false))
    spdlog::warn("--picture: no font was found, so that nothing in {} is labeled; install fonts-dejavu-core", picture->string());
}

ExitCode tell_outcome(const Arguments& arguments, const ComparisonJob& job, const std::vector<ComparedFrame>& frames,
                      const std::vector<Threshold>& thresholds) {
  const std::vector<std::int64_t> left = frames_not_reached(job, frames);
  std::vector<std::int64_t> compared, failed;
  for (const ComparedFrame& frame : frames) (frame.error.empty() ? compared : failed).push_back(frame.frame);
  if (!failed.empty())
    spdlog::error("{} of {} frames could not be compared: {}", failed.size(), frames.size(), FrameRange(failed).text());
  if (!left.empty()) {
    spdlog::error("interrupted; frames compared: {}; not reached: {}", FrameRange(compared).text(), FrameRange(left).text());
    return kInterrupted;
  }
  const std::vector<std::string> failures = find_failures(thresholds, job, frames, arguments.each_frame);
  for (const std::string& failure : failures) spdlog::error(failure);
  return failed.empty() && failures.empty() ? kOk : kFoundWrong;
}

ExitCode run(const Arguments& arguments, Console& console) {
  handle_interrupts();
  set_verbosity(arguments.verbosity.verbosity());
  pin_isa(arguments.isa);
  const int threads = parse_count(arguments.threads, "--threads", 0, kMostThreads);
  const std::vector<Threshold> thresholds = parse_thresholds(arguments);
  ComparisonJob job = prepare_comparison(arguments.comparison, thresholds);
  job.want_maps = arguments.outputs.maps || arguments.outputs.picture;
  prepare_outputs(arguments.outputs, job);
  Executor executor(threads);
  WorstFrame worst(job);
  std::vector<ComparedFrame> frames;
  if (choose_exposures(job, executor, console)) frames = compare_frames(arguments, job, executor, worst, console);
  tell_warnings_of_files(job);
  warn_of_what_is_left_out(job, frames);
  write_results(arguments, job, frames, worst);
  return tell_outcome(arguments, job, frames, thresholds);
}

void add_operands(CLI::App& app, ComparisonArguments& arguments) {
  app.add_option(
         "REFERENCE", arguments.reference,
         "What the images should look like: files (reference.####.exr; one file; layers and settings after colons, as for "
         "--in of run), or a folder or sequence.json, of which its input reference is taken, else color.")
      ->required();
  app.add_option("IMAGES", arguments.images,
                 "What is compared with it: files, or folders, of which color is taken; each as LABEL=FILES where the table "
                 "should not name it after its file or folder.")
      ->required();
  app.add_option("--frames", arguments.frames,
                 "Frames to compare: 1-100, 1-100x2 (every second), 1,5,9-12. Without it, all that all of them have. Two single "
                 "files are compared whatever their numbers.")
      ->type_name("RANGE")
      ->group(kInputGroup);
  app.add_option("--motion", arguments.motion,
                 "Motion of the reference, for warped: files, with conventions as for --in of run. Without it, the input motion "
                 "of REFERENCE, when that is a folder that has it.")
      ->type_name("FILES")
      ->group(kInputGroup);
}

void add_outputs(CLI::App& app, Arguments& arguments) {
  app.add_flag("--summary", arguments.summary, "Print the figures of all frames together alone.")
      ->disable_flag_override()
      ->group(kOutputGroup);
  app.add_option("--json", arguments.outputs.json,
                 "Write all figures in full to a file; - for the standard output, instead of the table.")
      ->type_name("FILE")
      ->group(kOutputGroup);
  app.add_option("--csv", arguments.outputs.csv, "The same as a table of comma-separated values.")
      ->type_name("FILE")
      ->group(kOutputGroup);
  app.add_option("--maps", arguments.outputs.maps,
                 "Draw the errors of flip and hdrflip in FLIP's colors: FOLDER/LABEL.flip.####.png.")
      ->type_name("FOLDER")
      ->group(kOutputGroup);
  app.add_option("--picture", arguments.outputs.picture,
                 "Draw the frame with the largest error by flip: reference, images, errors and figures on one sheet.")
      ->type_name("FILE.png")
      ->group(kOutputGroup);
  add_repeatable(
      app, "--fail-above", arguments.fail_above, "NAME=VALUE",
      "Exit with 1 when an image's figure over all frames is above this (flip=0.1); nonfinite counts the image's pixels "
      "that are NaN or infinite. Repeatable. A figure that could not be told fails.")
      ->group(kOutputGroup);
  add_repeatable(app, "--fail-below", arguments.fail_below, "NAME=VALUE", "The same when it is below this (psnr=30).")
      ->group(kOutputGroup);
  app.add_flag("--each-frame", arguments.each_frame, "Bars are for the figures of each frame, too.")
      ->disable_flag_override()
      ->group(kOutputGroup);
}

}  // namespace

Command add_compare(CLI::App& program) {
  CLI::App& app = *program.add_subcommand("compare", "Measure how far images are from a reference.");
  app.footer(
      "Metrics:\n" + describe_metrics() +
      "\n"
      "Example:\n"
      "  quell compare reference.####.exr noisy.####.exr denoised.####.exr --fail-above flip=0.1\n"
      "prints a line for each image of each frame, and of all frames.\n"
      "\n"
      "Exit status: 0 all is well, 1 a bar is not kept or frames could not be compared, 2 usage, 3 input, 70 internal error, 75 "
      "interrupted.");
  auto arguments = std::make_shared<Arguments>();
  add_operands(app, arguments->comparison);
  add_metric_options(app, arguments->comparison.metrics,
                     "psnr, ssim, relmse, smape and flip, and, where frames follow each other, tpsnr and warped");
  add_flip_options(app, arguments->comparison.metrics);
  add_outputs(app, *arguments);
  add_text(app, "--threads", arguments->threads, "N",
           "Threads that read and measure at a time; 0, the default, for as many as there are processors.")
      ->group(kScheduleGroup);
  add_options(app, arguments->isa);
  add_options(app, arguments->verbosity);
  return {&app, [arguments](Console& console) { return run(*arguments, console); }};
}

}  // namespace quell::app
