// Variance where history is short, over rows of pixels, on the vector unit of the machine. variance.cpp makes a pass of it.
#pragma once

#include <array>
#include <cstddef>

#include "quell/sdk/types.h"

namespace quell::variance {

inline constexpr int kMaxRadius = 8;

/// Images of one size. All but moments and color may be absent; depth counts together with its gradient alone.
struct Images {
  FloatImage moments, length, color, depth, depth_gradient, normal;
};

/// A weight is 2^-e; each factor is finite and at least 0.
struct Settings {
  int radius = 3;
  float min_length = 4;
  float luminance_factor = 0;  ///< of the difference of luminances
  /// By |dy| and |dx|: of the difference of depths over the gradient.
  std::array<std::array<float, kMaxRadius + 1>, kMaxRadius + 1> depth_factors{};
  float normal_power = 0;     ///< of -ln(n.n')
  bool wide_normals = false;  ///< a power below 64
  bool boost = false;
  bool filter_color = false;
};

/// Bytes of scratch for images of that width.
std::size_t scratch_bytes(int width, int radius);

/// Rows [y0, y1) of the outputs.
void variance_rows(const Images& in, const Settings& settings, int y0, int y1, const FloatOutput& variance,
                   const FloatOutput& color, float* scratch);

}  // namespace quell::variance
