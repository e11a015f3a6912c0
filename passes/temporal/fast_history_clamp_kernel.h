// A slow history limited to what a fast one makes plausible, over rows of pixels, on the vector unit of the machine.
// fast_history_clamp.cpp makes a pass of it.
#pragma once

#include "quell/sdk/types.h"

namespace quell::fast_history_clamp {

enum class Space { ycocg, rgb };

/// Images of one size. Length and depth may be absent.
struct Images {
  FloatImage color, fast, length, depth;
};

/// The parameters of the pass.
struct Settings {
  int radius = 2;
  float k = 2;
  Space space = Space::ycocg;
  bool include_center = true;
  float min_length = 4;
};

/// Row y of the outputs. The color may lie on that of the input.
void clamp_row(const Images& in, const Settings& settings, int y, const FloatOutput& color, const FloatOutput& clamped);

}  // namespace quell::fast_history_clamp
