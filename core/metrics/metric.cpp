#include "quell/metrics/metric.h"

#include <array>
#include <cmath>
#include <limits>

#include "quell/text/diagnostic.h"

namespace quell {
namespace {

constexpr std::array kMetrics{
    MetricInfo{Metric::psnr, "psnr", "dB", true, false, "peak signal to noise ratio of display values",
               "-10 log10(MSE), for a peak of 1"},
    MetricInfo{Metric::ssim, "ssim", "", true, false, "structural similarity of display values, 1 at best",
               "Wang et al., \"Image Quality Assessment: From Error Visibility to Structural Similarity\", 2004, equation 13"},
    MetricInfo{Metric::mse, "mse", "", false, false, "mean squared error of display values", "mean((a - r)^2)"},
    MetricInfo{
        Metric::relmse, "relmse", "", false, false, "relative mean squared error of radiance",
        "mean((a - r)^2 / (r^2 + 0.01)), after Rousselle et al., \"Adaptive Sampling and Reconstruction using Greedy Error "
        "Minimization\", 2011"},
    MetricInfo{Metric::smape, "smape", "", false, false, "symmetric mean absolute relative error of radiance",
               "mean(|a - r| / (|a| + |r| + 0.01)), after Vogels et al., \"Denoising with Kernel Prediction and Asymmetric Loss "
               "Functions\", 2018"},
    MetricInfo{Metric::flip, "flip", "", false, false, "visible difference of display values, 0 to 1",
               "Andersson et al., \"FLIP: A Difference Evaluator for Alternating Images\", 2020"},
    MetricInfo{Metric::hdr_flip, "hdrflip", "", false, false, "visible difference of radiance over all exposures, 0 to 1",
               "Andersson et al., \"Visualizing Errors in Rendered High Dynamic Range Images\", 2021"},
    MetricInfo{Metric::tpsnr, "tpsnr", "dB", true, true, "PSNR of what changes from frame to frame in display values",
               "-10 log10(mean(((a - a_before) - (r - r_before))^2))"},
    MetricInfo{Metric::warped, "warped", "", false, true,
               "flicker of display values along the motion, less that of the reference; 0 at best",
               "mean(|a - warp(a_before)| - |r - warp(r_before)|), after Lai et al., \"Learning Blind Video Temporal "
               "Consistency\", 2018"},
};

}  // namespace

std::span<const MetricInfo> metrics() { return kMetrics; }

const MetricInfo& info(Metric metric) { return kMetrics[static_cast<std::size_t>(metric)]; }

Metric parse_metric(std::string_view name, std::string_view option) {
  std::vector<std::string> names;
  for (const MetricInfo& candidate : kMetrics) {
    if (candidate.name == name) return candidate.metric;
    names.emplace_back(candidate.name);
  }
  throw Error(
      Fault::usage, std::string(option),
      "there is no metric '" + printable(name) + "'" + did_you_mean(name, names) + "; metrics are " + list_names(names, "and"));
}

double value(Metric metric, const Score& score) {
  if (score.count == 0) return std::numeric_limits<double>::quiet_NaN();
  const double mean = score.sum / static_cast<double>(score.count);
  if (metric != Metric::psnr && metric != Metric::tpsnr) return mean;
  return mean > 0 ? -10 * std::log10(mean) : std::numeric_limits<double>::infinity();
}

bool is_better(Metric metric, double a, double b) {
  if (metric == Metric::warped) return std::abs(a) < std::abs(b);
  return info(metric).higher_is_better ? a > b : a < b;
}

}  // namespace quell
