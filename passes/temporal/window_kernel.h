// The mean of a frame and others that look like it, over rows of pixels, on the vector unit of the machine. window.cpp makes a
// pass of it.
#pragma once

#include <span>

#include "quell/sdk/types.h"

namespace quell::window {

/// A frame at the pixels of the one in the middle. Validity and variance may be absent.
struct Aligned {
  FloatImage color, valid, variance;
};

/// The parameters of the pass.
struct Settings {
  int radius = 1;
  float factor = 0;  ///< of the squared difference over its variance, in the exponent of 2^-e
};

struct Outputs {
  FloatOutput color, variance, length;
};

/// Row y of the outputs. Frames that have no variance have that of the one in the middle.
void average_row(const Aligned& middle, std::span<const Aligned> frames, const Settings& settings, int y, const Outputs& out);

}  // namespace quell::window
