// The metrics by name: what each measures, which way is better, and how pixels and frames add up to a figure.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace quell {

enum class Metric {
  psnr,      ///< of display values, dB
  ssim,      ///< of display values; cannot be told of an image with a side below 11 pixels
  mse,       ///< of display values
  relmse,    ///< of radiance
  smape,     ///< of radiance
  flip,      ///< of display values
  hdr_flip,  ///< of radiance
  tpsnr,     ///< of what changes from frame to frame in display values, dB
  warped,    ///< of display values that motion brings from the previous frame
};

struct MetricInfo {
  Metric metric;
  std::string_view name;  ///< as options and columns have it: "psnr", "hdrflip"
  std::string_view unit;  ///< "dB", or ""
  bool higher_is_better;
  bool is_temporal;          ///< needs the frame before
  std::string_view summary;  ///< a line for help texts; README.md has formulas and sources
};

/// All, in the order of the enumeration.
std::span<const MetricInfo> metrics();
const MetricInfo& info(Metric metric);
/// Throws Error(usage) with `option` as its place, a suggestion and the list.
Metric parse_metric(std::string_view name, std::string_view option);

/// What pixels add up to, in double. Scores of frames are added to one of a sequence: every pixel counts alike there, so that the
/// PSNR of a sequence is that of its mean squared error.
struct Score {
  double sum = 0;
  std::uint64_t count = 0;  ///< pixels; 0: the metric could not be told

  Score& operator+=(const Score& other) {
    sum += other.sum;
    count += other.count;
    return *this;
  }
  bool operator==(const Score&) const = default;
};

/// The figure of a score: its mean, in dB for psnr and tpsnr (infinite when nothing differs). NaN when its count is 0.
double value(Metric metric, const Score& score);
/// Whether a is better than b; false when either is NaN. Of `warped`, whose figure may be negative, the one nearer to 0.
bool is_better(Metric metric, double a, double b);

}  // namespace quell
