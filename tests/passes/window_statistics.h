// Plain statistics of windows, in double, for tests that compare a pass with its formula.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "quell/image/item.h"

namespace quell::scene {

using Plane = std::function<float(int x, int y, int c)>;
using Color = std::array<double, 3>;

inline Color at(const Plane& image, int x, int y) { return {image(x, y, 0), image(x, y, 1), image(x, y, 2)}; }
inline Color to_ycocg(const Color& c) { return {(c[0] + 2 * c[1] + c[2]) / 4, (c[0] - c[2]) / 2, (2 * c[1] - c[0] - c[2]) / 4}; }
inline Color from_ycocg(const Color& c) { return {c[0] + c[1] - c[2], c[0] + c[2], c[0] - c[1] - c[2]}; }
inline double luma(const Color& c) { return to_ycocg(c)[0]; }
inline double luminance(const Color& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

/// Calls visit(qx, qy) for the pixels of the image around (x, y).
inline void around(Size size, int x, int y, int radius, const std::function<void(int, int)>& visit) {
  for (int qy = std::max(0, y - radius); qy <= std::min(size.height - 1, y + radius); ++qy)
    for (int qx = std::max(0, x - radius); qx <= std::min(size.width - 1, x + radius); ++qx) visit(qx, qy);
}

struct MeanAndDeviation {
  double mean = 0, deviation = 0;
};
inline MeanAndDeviation statistics(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (const double v : values) sum += v;
  const double mean = sum / static_cast<double>(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / static_cast<double>(values.size()))};
}

}  // namespace quell::scene
