#include "comparison_files.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "metric_options.h"
#include "quell/simd/isa.h"
#include "quell/text/json_write.h"

namespace quell::app {
namespace {

Json range_json(const std::vector<std::int64_t>& frames) { return make_json(frames.empty() ? "" : FrameRange(frames).text()); }

Json series_json(const std::string& label, const ImageSeries& series) {
  return JsonMembers().add("label", label).add("files", series.files()).take();
}

Json settings_json(const ComparisonJob& job) {
  const CompareOptions& options = job.options;
  std::vector<std::string> names;
  for (const Metric metric : options.metrics) names.emplace_back(info(metric).name);
  JsonMembers members;
  members.add("metrics", make_json(names));
  members.add("display", std::string(info(options.display).name));
  members.add("pixels_per_degree", options.pixels_per_degree);
  members.add("isa", current_isa());
  if (contains(options.metrics, Metric::hdr_flip) && options.exposures)
    members.add("exposures", JsonMembers()
                                 .add("start", options.exposures->start)
                                 .add("stop", options.exposures->stop)
                                 .add("count", options.exposures->count)
                                 .take());
  if (contains(options.metrics, Metric::warped)) members.add("motion", job.motion ? make_json(job.motion->files()) : Json{});
  return members.take();
}

Json image_json(const std::string& label, const ImageFigures& image, const std::vector<Metric>& metrics) {
  JsonMembers figures;
  for (std::size_t m = 0; m < metrics.size(); ++m) {
    const Score& score = image.scores[m];
    figures.add(std::string(info(metrics[m]).name), JsonMembers()
                                                        .add("value", value(metrics[m], score))
                                                        .add("sum", score.sum)
                                                        .add("count", static_cast<std::int64_t>(score.count))
                                                        .take());
  }
  return JsonMembers()
      .add("label", label)
      .add("nonfinite", static_cast<std::int64_t>(image.bad_pixels))
      .add("figures", figures.take())
      .take();
}

Json images_json(const ComparisonJob& job, const std::vector<ImageFigures>& images) {
  std::vector<Json> list;
  for (std::size_t i = 0; i < images.size(); ++i) list.push_back(image_json(job.labels[i], images[i], job.options.metrics));
  return make_json(std::move(list));
}

Json frame_json(const ComparisonJob& job, const ComparedFrame& frame) {
  JsonMembers members;
  members.add("frame", frame.frame);
  if (!frame.error.empty()) return members.add("error", frame.error).take();
  return members.add("nonfinite_in_reference", static_cast<std::int64_t>(frame.bad_pixels_in_reference))
      .add("images", images_json(job, frame.images))
      .take();
}

std::vector<std::int64_t> frames_that(const std::vector<ComparedFrame>& frames, bool are_ok) {
  std::vector<std::int64_t> found;
  for (const ComparedFrame& frame : frames)
    if (frame.error.empty() == are_ok) found.push_back(frame.frame);
  return found;
}

/// Quoted where CSV wants it.
std::string csv_word(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// The shortest text that reads back as the same number; "inf", "-inf"; "" for NaN.
std::string csv_number(double number) {
  if (std::isnan(number)) return "";
  std::array<char, 40> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

std::string csv_lines(const ComparisonJob& job, const std::string& frame, const std::vector<ImageFigures>& images,
                      std::uint64_t bad_pixels_in_reference) {
  std::string text;
  for (std::size_t i = 0; i < images.size(); ++i) {
    text += frame + "," + csv_word(job.labels[i]);
    for (std::size_t m = 0; m < job.options.metrics.size(); ++m)
      text += "," + csv_number(value(job.options.metrics[m], images[i].scores[m]));
    text += "," + std::to_string(images[i].bad_pixels) + "," + std::to_string(bad_pixels_in_reference) + "\n";
  }
  return text;
}

}  // namespace

std::vector<std::int64_t> frames_not_reached(const ComparisonJob& job, const std::vector<ComparedFrame>& frames) {
  return {job.frames.begin() + static_cast<std::ptrdiff_t>(frames.size()), job.frames.end()};
}

std::string comparison_json(const ComparisonJob& job, const std::vector<ComparedFrame>& frames) {
  std::vector<Json> images, each;
  for (std::size_t i = 0; i < job.images.size(); ++i) images.push_back(series_json(job.labels[i], job.images[i]));
  for (const ComparedFrame& frame : frames) each.push_back(frame_json(job, frame));
  JsonMembers members;
  members.add("quell_compare", 1).add("version", QUELL_VERSION);
  members.add("reference", job.reference.files()).add("images", make_json(std::move(images)));
  members.add("settings", settings_json(job));
  members.add("compared", range_json(frames_that(frames, true))).add("failed", range_json(frames_that(frames, false)));
  members.add("not_reached", range_json(frames_not_reached(job, frames)));
  members.add("all", images_json(job, add_up(frames, job.images.size(), job.options.metrics.size())));
  members.add("frames", make_json(std::move(each)));
  return write_json(members.take());
}

std::string comparison_csv(const ComparisonJob& job, const std::vector<ComparedFrame>& frames) {
  std::string text = kComparisonCsv;
  for (const Metric metric : job.options.metrics) text += std::string(info(metric).name) + ",";
  text += "nonfinite,nonfinite_in_reference\n";
  std::uint64_t bad = 0;
  for (const ComparedFrame& frame : frames) {
    text += csv_lines(job, std::to_string(frame.frame), frame.images, frame.bad_pixels_in_reference);
    bad += frame.bad_pixels_in_reference;
  }
  return text + csv_lines(job, "all", add_up(frames, job.images.size(), job.options.metrics.size()), bad);
}

}  // namespace quell::app
