#include "comparison_job.h"

#include <algorithm>
#include <iterator>

#include "console.h"
#include "missing_files.h"
#include "quell/text/error.h"

namespace quell::app {
namespace {

/// The reference is the first.
struct NamedSeries {
  std::string label;
  const ImageSeries& series;
};

std::vector<NamedSeries> list_series(const ComparisonJob& job) {
  std::vector<NamedSeries> all = {{"reference", job.reference}};
  for (std::size_t i = 0; i < job.images.size(); ++i) all.push_back({job.labels[i], job.images[i]});
  return all;
}

std::vector<MissingFile> find_missing(const std::vector<NamedSeries>& all, const std::vector<std::int64_t>& frames) {
  std::vector<MissingFile> missing;
  for (const std::int64_t frame : frames)
    for (const auto& [label, series] : all)
      if (!series.has(frame) && missing.size() < Sequence::kMostMissing) missing.push_back({label, frame, series.file(frame)});
  return missing;
}

std::vector<std::int64_t> frames_asked_for(const std::vector<NamedSeries>& all, const std::string& text) {
  const std::vector<std::int64_t> frames = FrameRange::parse(text).frames();
  if (const std::vector<MissingFile> missing = find_missing(all, frames); !missing.empty())
    throw Error(Fault::input, "--frames", "files of the frames asked for are missing:" + list_missing(missing));
  return frames;
}

/// Those that all have; the others are told.
std::vector<std::int64_t> common_frames(const std::vector<NamedSeries>& all) {
  std::vector<std::int64_t> every, common = all.front().series.wanted_frames();
  for (const auto& [label, series] : all) {
    const std::vector<std::int64_t>& wanted = series.wanted_frames();
    every.insert(every.end(), wanted.begin(), wanted.end());
    std::vector<std::int64_t> both;
    std::ranges::set_intersection(common, wanted, std::back_inserter(both));
    std::erase_if(both, [&series = series](std::int64_t frame) { return !series.has(frame); });
    common = std::move(both);
  }
  if (!common.empty()) {
    // Who names one file of a frame wants no others.
    if (std::ranges::none_of(all, [](const NamedSeries& one) { return one.series.is_single(); }))
      warn_of_missing(find_missing(all, FrameRange(std::move(every)).frames()));
    return common;
  }
  std::string have;
  for (const auto& [label, series] : all)
    have += "\n  " + label + ": " + FrameRange(series.frames()).text() + " of " + series.files();
  throw Error(Fault::input, "", "there is no frame that all have:" + have);
}

std::vector<std::int64_t> choose_frames(const std::vector<NamedSeries>& all, const std::optional<std::string>& asked) {
  if (asked) return frames_asked_for(all, *asked);
  // Whatever their numbers.
  if (std::ranges::all_of(all, [](const NamedSeries& one) { return one.series.is_single(); })) return all.front().series.frames();
  return common_frames(all);
}

void require_one_size(const std::vector<NamedSeries>& all, std::int64_t frame) {
  const ImageSeries& reference = all.front().series;
  const Size size = reference.size();
  const auto text = [](Size of) { return std::to_string(of.width) + " x " + std::to_string(of.height); };
  for (const auto& [label, series] : all)
    if (const Size other = series.size(); other.width != size.width || other.height != size.height)
      throw Error(Fault::input, series.file(frame).string(),
                  "has " + text(other) + " pixels, but " + reference.file(frame).string() + " has " + text(size) +
                      "; images that are compared have one size");
}

/// Without --motion, the one that lies with the reference, when that is a sequence.
std::optional<ImageSeries> find_motion(const ComparisonArguments& arguments, const ImageSeries& reference) {
  if (arguments.motion) return ImageSeries::open(*arguments.motion, SeriesRole::motion);
  for (const InputFiles& input : reference.sequence()->inputs())
    if (input.input == "motion" && !input.frames.empty()) return ImageSeries(reference.sequence(), "motion");
  return std::nullopt;
}

void warn_of_what_has_no_effect(const ComparisonArguments& arguments, const std::vector<Metric>& metrics) {
  const auto warn = [](const char* option, const char* needed) {
    spdlog::warn("{} has no effect: it is for {}, which is not measured; add it to --metrics", option, needed);
  };
  const bool has_hdr_flip = contains(metrics, Metric::hdr_flip);
  if (arguments.metrics.exposures && !has_hdr_flip) warn("--exposures", "hdrflip");
  if (arguments.metrics.pixels_per_degree && !has_hdr_flip && !contains(metrics, Metric::flip))
    warn("--pixels-per-degree", "flip");
  if (arguments.motion && !contains(metrics, Metric::warped)) warn("--motion", "warped");
}

}  // namespace

void choose_display(CompareOptions& options, const ImageSeries& reference, const std::optional<std::string>& stated) {
  BufferPool pool;
  if (stated && options.display != DisplayTransform::none) return;
  if (!reference.is_display_referred(pool)) return;
  if (!stated) {
    options.display = DisplayTransform::srgb;
    spdlog::info("--display srgb is taken, because {} holds what a display shows", reference.files());
    return;
  }
  spdlog::warn(
      "--display none: the sRGB curve of {} is undone when it is read; take --display srgb, or name all files with "
      ":transfer=linear",
      reference.files());
}

ComparisonJob prepare_comparison(const ComparisonArguments& arguments, const std::vector<Threshold>& thresholds) {
  std::vector<Operand> operands;
  for (const std::string& text : arguments.images) operands.push_back(parse_operand(text));
  ComparisonJob job{ImageSeries::open(arguments.reference, SeriesRole::reference), {}, {}, {}, {}, {}};
  for (const Operand& operand : operands) job.images.push_back(ImageSeries::open(operand.what, SeriesRole::image));
  job.labels = make_labels(operands, job.images);
  const std::vector<NamedSeries> all = list_series(job);
  job.frames = choose_frames(all, arguments.frames);
  require_one_size(all, job.frames.front());
  const std::vector<Metric> always = {Metric::psnr, Metric::ssim, Metric::relmse, Metric::smape, Metric::flip};
  job.options = parse_metric_options(arguments.metrics, default_metrics(always, {Metric::tpsnr, Metric::warped}, job.frames));
  for (const Threshold& threshold : thresholds)
    if (threshold.metric && !contains(job.options.metrics, *threshold.metric)) job.options.metrics.push_back(*threshold.metric);
  warn_of_what_has_no_effect(arguments, job.options.metrics);
  job.motion = find_motion(arguments, job.reference);
  if (arguments.motion && contains(job.options.metrics, Metric::warped))  // or every frame would fail
    require_one_size({{"reference", job.reference}, {"motion", *job.motion}}, job.frames.front());
  choose_display(job.options, job.reference, arguments.metrics.display);
  return job;
}

}  // namespace quell::app
