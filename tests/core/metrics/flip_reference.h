// FLIP in double, from the papers: two-dimensional filters, pixel by pixel. It shares no code and no constants with the metric.
#pragma once

#include <vector>

#include "quell/image/image.h"
#include "quell/metrics/flip.h"

namespace quell::flip_test {

/// What a pixel's error is made of.
struct Expected {
  double hyab = 0;     ///< color distance after filtering, Lab units with Hunt's adjustment
  double feature = 0;  ///< the larger difference of edges or points over sqrt(2), before the square root

  double error() const;
  /// The errors that are possible when the two above are wrong by as much, from the smallest to the largest.
  std::array<double, 2> error_range(double hyab_off, double feature_off) const;
};

/// Row by row. Colors are clamped to 0..1.
std::vector<Expected> reference_flip(const Image& reference, const Image& image, double pixels_per_degree);
/// The same of radiance times 2^stop, tone mapped.
std::vector<Expected> reference_flip_at(const Image& reference, const Image& image, double stop, double pixels_per_degree);

/// Exposure that takes `luminance` to 0.85 on the tone curve, in stops, found by bisection.
double reference_stop(double luminance);

}  // namespace quell::flip_test
