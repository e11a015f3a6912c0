#include "run_reference.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "comparison_job.h"
#include "comparison_run.h"
#include "console.h"
#include "figure_text.h"
#include "interrupt.h"
#include "quell/sequence/input_spec.h"
#include "quell/text/diagnostic.h"

namespace quell::app {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_of_inputs(const Sequence& sequence) {
  std::vector<std::string> names;
  for (const InputFiles& files : sequence.inputs()) names.push_back(files.input);
  return names;
}

/// An input of the job's sequence, or files as `quell compare` takes them.
ImageSeries open_reference(const std::string& name, const SequenceArguments& arguments, const Job& job) {
  if (name.empty())
    throw Error(Fault::usage, "--reference", "the name is empty; name an input of the sequence, files or a folder");
  const std::vector<std::string> names = names_of_inputs(*job.sequence);
  if (std::ranges::find(names, name) != names.end()) return {job.sequence, name};
  std::error_code error;
  if (is_input_name(name) && !fs::exists(name, error))
    throw Error(Fault::input, "--reference",
                "the sequence has no input '" + name + "'" + did_you_mean(name, names) + "; it has " + list_names(names, "and") +
                    "; name one of them, or files (reference.####.exr) or a folder");
  SequenceOptions options = sequence_options(arguments);
  options.in.clear();
  options.frames.reset();
  return ImageSeries::open(name, SeriesRole::reference, options);
}

/// The sequence's own, else that of the reference's folder.
std::optional<ImageSeries> find_motion(const Job& job, const ImageSeries& reference) {
  for (const std::shared_ptr<Sequence>& sequence : {job.sequence, reference.sequence()})
    for (const InputFiles& input : sequence->inputs())
      if (input.input == "motion" && !input.frames.empty()) return ImageSeries(sequence, "motion");
  return std::nullopt;
}

std::set<std::string, std::less<>> color_outputs(const Job& job) {
  std::set<std::string, std::less<>> outputs;
  for (const GraphOutput& output : job.graph->outputs)
    for (const PlannedResult& result : job.plan.results())
      if (result.name == output.name && job.graph->type(result.from) == QUELL_TYPE_COLOR) outputs.insert(result.name);
  if (outputs.empty()) throw Error(Fault::usage, "--reference", "the graph has no output of type color that could be measured");
  return outputs;
}

/// Inputs of the job's sequence are looked after with all others.
void refuse_to_replace(const ImageSeries& measured_with, const char* what, const Job& job,
                       const std::vector<ResultFiles>& results) {
  if (measured_with.sequence() == job.sequence) return;
  for (const ResultFiles& series : results)
    for (std::size_t i = 0; i < series.files.size(); ++i) {
      std::error_code error;
      if (fs::equivalent(series.files[i], measured_with.file(job.frames[i]), error))
        throw Error(
            Fault::usage, "--out",
            "the results would replace " + series.files[i].string() + ", which is the " + what + "; choose another folder");
    }
}

void warn_of_missing_references(const MeasuringOptions& options) {
  const ImageSeries& reference = options.reference;
  std::vector<std::int64_t> missing;
  for (const std::int64_t frame : options.frames)
    if (!options.has_reference(frame)) missing.push_back(frame);
  if (missing.size() == options.frames.size()) {
    const std::string have = FrameRange(reference.frames()).text();
    throw Error(Fault::input, "--reference",
                reference.is_single() ? reference.files() + " is a single file, of frame " + have + ", and the run has frames " +
                                            FrameRange(missing).text() + "; name a file for each (reference.####.exr)"
                                      : reference.files() + " has no file for any frame of the run; it has frames " + have);
  }
  if (!missing.empty())
    spdlog::warn("--reference: {} has no file for {}, which will have no figures", reference.files(), FrameRange(missing).text());
}

std::string name_list(const std::vector<Metric>& metrics) {
  std::string text;
  for (std::size_t i = 0; i < metrics.size(); ++i)
    text += (i == 0 ? "" : i + 1 < metrics.size() ? ", " : " and ") + std::string(info(metrics[i]).name);
  return text;
}

}  // namespace

std::optional<MeasuringOptions> prepare_measuring(const ReferenceArguments& arguments, const SequenceArguments& sequence,
                                                  const Job& job, const std::vector<ResultFiles>& results) {
  if (!arguments.reference) {
    if (arguments.metrics.metrics || arguments.metrics.display)
      throw Error(Fault::usage, arguments.metrics.metrics ? "--metrics" : "--display",
                  "there is nothing to be measured; add --reference NAME");
    return std::nullopt;
  }
  MeasuringOptions options{open_reference(*arguments.reference, sequence, job), {}, color_outputs(job), job.frames, {}};
  options.compare = parse_metric_options(
      arguments.metrics, default_metrics({Metric::psnr, Metric::ssim, Metric::flip}, {Metric::tpsnr}, job.frames));
  options.motion = find_motion(job, options.reference);
  warn_of_missing_references(options);
  refuse_to_replace(options.reference, "reference", job, results);
  if (options.motion) refuse_to_replace(*options.motion, "motion that frames are compared along", job, results);
  choose_display(options.compare, options.reference, arguments.metrics.display);
  return options;
}

void complete_measuring(MeasuringOptions& options, int threads) {
  if (!contains(options.compare.metrics, Metric::hdr_flip)) return;
  std::vector<std::int64_t> frames;
  for (const std::int64_t frame : options.frames)
    if (options.has_reference(frame)) frames.push_back(frame);
  Executor executor(threads);
  options.compare.exposures = find_exposures(options.reference, frames, executor, interrupted, [](std::size_t) {});
}

std::string describe(const MeasuringOptions& options) {
  std::string outputs;
  for (const std::string& output : options.outputs) outputs += (outputs.empty() ? "'" : ", '") + output + "'";
  return "would compare " + outputs + " with " + options.reference.files() + ": " + name_list(options.compare.metrics) + "\n";
}

std::string list_measured(const std::vector<MeasuredOutput>& measured, const std::vector<Metric>& metrics) {
  std::string text;
  for (const MeasuredOutput& output : measured) text += "  " + output.output + ": " + list_figures(metrics, output.scores);
  return text;
}

void tell_measured(const MeasuringSink& sink) {
  const std::vector<MeasuredOutput> totals = sink.totals();
  if (totals.empty()) return;
  const MeasuringOptions& options = sink.options();
  const std::vector<std::int64_t> frames = sink.measured_frames();
  spdlog::info("compared with {}, {} {}", options.reference.files(), frames.size() == 1 ? "frame" : "frames",
               FrameRange(frames).text());
  for (const MeasuredOutput& total : totals) {
    spdlog::info("  {}: {}", total.output, list_figures(options.compare.metrics, total.scores));
    if (total.bad_pixels > 0)
      spdlog::warn("{}: {} and left out of all figures", total.output, describe_bad_pixels(total.bad_pixels));
  }
  std::uint64_t bad = 0;  // an output may have been measured in fewer frames than another
  for (const MeasuredOutput& total : totals) bad = std::max(bad, total.bad_pixels_in_reference);
  if (bad > 0) spdlog::warn("{}: {} and left out of all figures", options.reference.files(), describe_bad_pixels(bad));
}

void tell_new_warnings(const MeasuringOptions& options, Job& job) {
  for (const std::string& warning : options.reference.sequence()->warnings())
    if (job.told.insert(warning).second) spdlog::warn(warning);
}

void add_options(CLI::App& app, ReferenceArguments& arguments) {
  app.add_option("--reference", arguments.reference,
                 "What color outputs should look like: an input of the sequence (reference), or files or a folder as `quell "
                 "compare` takes them. Figures stand beside each frame, and those of all frames at the end.")
      ->type_name("NAME")
      ->group(kMeasureGroup);
  add_metric_options(app, arguments.metrics, "psnr, ssim, flip, and, where frames follow each other, tpsnr");
}

}  // namespace quell::app
