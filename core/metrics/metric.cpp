#include "quell/metrics/metric.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "quell/text/diagnostic.h"

namespace quell {
namespace {

constexpr std::array kMetrics{
    MetricInfo{Metric::psnr, "psnr", "dB", true, false, "peak signal to noise ratio of display values"},
    MetricInfo{Metric::ssim, "ssim", "", true, false, "structural similarity of display values, 1 at best"},
    MetricInfo{Metric::mse, "mse", "", false, false, "mean squared error of display values"},
    MetricInfo{Metric::relmse, "relmse", "", false, false, "relative mean squared error of radiance"},
    MetricInfo{Metric::smape, "smape", "", false, false, "symmetric mean absolute relative error of radiance, 0 to 1"},
    MetricInfo{Metric::flip, "flip", "", false, false, "visible difference of display values, 0 to 1"},
    MetricInfo{Metric::hdr_flip, "hdrflip", "", false, false, "visible difference of radiance over all exposures, 0 to 1"},
    MetricInfo{Metric::tpsnr, "tpsnr", "dB", true, true, "PSNR of what changes from frame to frame in display values"},
    MetricInfo{Metric::warped, "warped", "", false, true,
               "flicker of display values along the motion, less that of the reference; 0 at best"},
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
  return mean > 0 ? 0 - 10 * std::log10(mean) : std::numeric_limits<double>::infinity();  // 0 -: no negative zero for a mean of 1
}

bool is_better(Metric metric, double a, double b) {
  if (metric == Metric::warped) return std::abs(a) < std::abs(b);
  return info(metric).higher_is_better ? a > b : a < b;
}

}  // namespace quell
