// A sparse filter where history is short, over rows of pixels, on the vector unit of the machine. history_fix.cpp makes a pass of
// it.
#pragma once

#include <span>

#include "quell/sdk/types.h"

namespace quell::history_fix {

inline constexpr int kTapsAside = 2;  // in each direction

/// Images of one size. All but the length may be absent; depth is compared where it has a gradient, planes where there is a
/// normal and a position.
struct Guides {
  FloatImage length, depth, depth_gradient, normal, position;
  IdImage id;
};

/// A weight is 2^-e.
struct Settings {
  float min_length = 4;
  float stride = 14;
  float depth_factor = 0;  ///< of the gradient times the distance in pixels, in a denominator
  float normal_power = 0;  ///< of -ln(n.n')
  float plane_relative = 0, plane_absolute = 0;
};

/// An image, and where it goes to.
struct Fixed {
  FloatImage from;
  FloatOutput to;
};

/// Pixels between taps where the history has that length.
int stride(const Settings& settings, float length);

/// Row y of all images.
void fix_row(const Guides& in, const Settings& settings, std::span<const Fixed> images, int y);

}  // namespace quell::history_fix
