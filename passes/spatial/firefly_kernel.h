// Fireflies clamped by their neighborhood, over rows of pixels, on the vector unit of the machine. firefly.cpp makes a pass of
// it.
#pragma once

#include <cstddef>

#include "quell/sdk/types.h"

namespace quell::firefly {

inline constexpr int kMaxRadius = 8;

enum class Method { range, bound, rank };

struct Settings {
  Method method = Method::bound;
  bool by_channel = false;  ///< else by luminance
  int radius = 3;           ///< at most kMaxRadius; 1 for rank
  float k = 2;
  float floor = 1;
  bool exclude_center = true;
};

/// Bytes of scratch for images of that width.
std::size_t scratch_bytes(int width, int radius);

/// Rows [y0, y1) of the outputs. `scratch` is 64-byte aligned; its content does not matter.
void clamp_rows(const FloatImage& in, const Settings& settings, int y0, int y1, const FloatOutput& color, const FloatOutput& mask,
                float* scratch);

}  // namespace quell::firefly
