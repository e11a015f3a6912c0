// Images at twice the resolution, over rows of pixels, on the vector unit of the machine. scale.cpp makes a pass of it.
#pragma once

#include "quell/sdk/types.h"

namespace quell::scale {

/// Guides at the resolution of the small image and at that of the large one; those of a kind are both there, or do not count.
struct Guides {
  FloatImage depth, normal, full_depth, full_normal;
};

/// Where a pixel of the large image lies in the small one: (pixel + 0.5) factor - 0.5.
struct Settings {
  float factor_x = 0.5F, factor_y = 0.5F;
  float inverse_sigma_z = 0;  ///< of a relative difference in depth
  float normal_power = 0;     ///< of -ln(n.n')
  float gains[2] = {1, 1};    ///< of the first plane, and of all others
};

/// Row y of the large image.
void enlarge_row(const FloatImage& small, const Guides& guides, const Settings& settings, int y, const FloatOutput& large);

}  // namespace quell::scale
