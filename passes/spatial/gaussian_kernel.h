// The Gaussian over rows of pixels, on the vector unit of the machine. gaussian.cpp makes a pass of it.
#pragma once

#include <cstddef>
#include <vector>

#include "quell/sdk/types.h"

namespace quell::gaussian {

struct Settings {
  std::vector<float> weights;  ///< of a tap 0, 1, ... radius pixels away; with those on the other side they sum to 1
  std::vector<float> sums;     ///< of weights[0] to weights[i]
  int radius() const { return static_cast<int>(weights.size()) - 1; }
};

/// Bytes of scratch for images of that width.
std::size_t scratch_bytes(int width, int radius);

/// Row y of channel c. `scratch` is 64-byte aligned; its content does not matter.
void blur_row(const FloatImage& in, const Settings& settings, int y, int c, float* scratch, const FloatOutput& out);

}  // namespace quell::gaussian
