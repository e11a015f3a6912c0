// Sums over the rows of an image that are the same for any threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "quell/metrics/metric.h"
#include "quell/metrics/parallel.h"

namespace quell::detail {

inline constexpr int kBandRows = 16;

/// Calls body(y0, y1) for bands of rows that cover [0, height).
inline void for_bands(int height, const Parallel& parallel, const std::function<void(int y0, int y1)>& body) {
  parallel((height + kBandRows - 1) / kBandRows, [&](int i) { body(i * kBandRows, std::min(height, (i + 1) * kBandRows)); });
}

/// The sum of band(y0, y1) over bands of rows that cover [0, height), added from top to bottom. `Sum` has +=.
template <class Sum>
Sum sum_bands(int height, const Parallel& parallel, const std::function<Sum(int y0, int y1)>& band) {
  std::vector<Sum> sums(static_cast<std::size_t>((height + kBandRows - 1) / kBandRows));
  for_bands(height, parallel, [&](int y0, int y1) { sums[static_cast<std::size_t>(y0 / kBandRows)] = band(y0, y1); });
  Sum sum;
  for (const Sum& one : sums) sum += one;
  return sum;
}

}  // namespace quell::detail
