// How far a history lags behind, over rows of pixels, on the vector unit of the machine. antilag.cpp makes a pass of it.
#pragma once

#include "quell/sdk/types.h"

namespace quell::antilag {

/// Images of one size. All but slow and fast may be absent.
struct Images {
  FloatImage slow, fast, color, length, depth;
};

/// The parameters of the pass.
struct Settings {
  int radius = 2;
  float sensitivity = 0.25F;
  float k_fast = 4.5F, k_color = 0.5F;
  float max_length = 32;
};

/// Row y of the outputs. The length may lie on that of the input.
void find_lag(const Images& in, const Settings& settings, int y, const FloatOutput& confidence, const FloatOutput& length);

}  // namespace quell::antilag
