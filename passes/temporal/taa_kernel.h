// Temporal anti-aliasing over rows of pixels, on the vector unit of the machine. taa.cpp makes a pass of it.
#pragma once

#include "quell/sdk/types.h"

namespace quell::taa {

enum class Box { range, rounded, variance };
enum class Limit { clip, clamp, none };

/// Images of one size. The validity may be absent.
struct Images {
  FloatImage color, history, valid;
};

/// The parameters of the pass.
struct Settings {
  float alpha = 0.1F;
  Box box = Box::rounded;
  Limit limit = Limit::clip;
  float k = 1;
  bool weigh = true;
};

/// Row y of the output, which may lie on that of the history.
void blend_row(const Images& in, const Settings& settings, int y, const FloatOutput& color);

}  // namespace quell::taa
