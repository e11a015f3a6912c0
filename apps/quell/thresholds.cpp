#include "thresholds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "arguments.h"
#include "figure_text.h"
#include "quell/text/diagnostic.h"

namespace quell::app {
namespace {

constexpr const char* kNonfinite = "nonfinite";

const char* option_of(bool is_above) { return is_above ? "--fail-above" : "--fail-below"; }

std::string name_of(const Threshold& threshold) {
  return threshold.metric ? std::string(info(*threshold.metric).name) : kNonfinite;
}

double figure_of(const Threshold& threshold, const ImageFigures& image, const std::vector<Metric>& metrics) {
  if (!threshold.metric) return static_cast<double>(image.bad_pixels);
  const auto place = static_cast<std::size_t>(std::ranges::find(metrics, *threshold.metric) - metrics.begin());
  return value(*threshold.metric, image.scores[place]);
}

/// More digits than a table has: a figure that just fails must not look like its bar.
std::string exact(double figure) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.6g", figure);
  return text.data();
}

/// "" when the bar is kept.
std::string judge(const Threshold& threshold, double figure) {
  if (std::isnan(figure)) return name_of(threshold) + " could not be told (" + threshold.option + ")";
  // Too much flicker and too little of it are both errors: of `warped`, the size counts.
  const double size = threshold.metric == Metric::warped ? std::abs(figure) : figure;
  if (threshold.is_above ? size <= threshold.bar : size >= threshold.bar) return "";
  return name_of(threshold) + " is " + exact(figure) + (threshold.is_above ? ", above " : ", below ") + exact(threshold.bar) +
         " (" + threshold.option + ")";
}

bool can_be_told(const Threshold& threshold, const ComparedFrame& frame) {
  return frame.has_previous || !threshold.metric || !info(*threshold.metric).is_temporal;
}

}  // namespace

Threshold parse_threshold(const std::string& text, bool is_above) {
  const char* const option = option_of(is_above);
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    throw Error(Fault::usage, option, "'" + text + "' is not NAME=VALUE, such as " + (is_above ? "flip=0.1" : "psnr=30"));
  Threshold threshold;
  threshold.is_above = is_above;
  threshold.option = std::string(option) + " " + text;
  if (const std::string name = text.substr(0, equals); name != kNonfinite) threshold.metric = parse_metric(name, option);
  constexpr double kMost = std::numeric_limits<double>::max();
  threshold.bar = parse_number(text.substr(equals + 1), option, -kMost, kMost);
  return threshold;
}

std::string doubt(const Threshold& threshold) {
  const bool higher_is_better = threshold.metric && info(*threshold.metric).higher_is_better;
  if (threshold.is_above != higher_is_better) return "";
  return threshold.option + ": of " + name_of(threshold) + ", " + (higher_is_better ? "higher" : "lower") +
         " is better, so that good images fail; " + option_of(!threshold.is_above) + " fails the others";
}

std::vector<std::string> find_failures(const std::vector<Threshold>& thresholds, const ComparisonJob& job,
                                       const std::vector<ComparedFrame>& frames, bool each_frame) {
  const std::vector<ImageFigures> sums = add_up(frames, job.images.size(), job.options.metrics.size());
  std::vector<std::string> failures;
  for (const Threshold& threshold : thresholds)
    for (std::size_t i = 0; i < job.images.size(); ++i) {
      const auto look_at = [&](const ImageFigures& image, const std::string& where) {
        const std::string failure = judge(threshold, figure_of(threshold, image, job.options.metrics));
        if (!failure.empty()) failures.push_back(job.labels[i] + where + ": " + failure);
      };
      look_at(sums[i], "");
      for (const ComparedFrame& frame : frames)
        if (each_frame && frame.error.empty() && can_be_told(threshold, frame))
          look_at(frame.images[i], ", frame " + std::to_string(frame.frame));
    }
  return failures;
}

}  // namespace quell::app
