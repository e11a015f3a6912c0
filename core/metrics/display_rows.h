// Rows of pixels made ready for the metrics, by vectors.
#pragma once

#include <cstdint>

#include "quell/metrics/display.h"
#include "quell/sdk/types.h"

namespace quell::detail {

/// How many pixels have a channel that is not finite.
struct BadPixels {
  std::uint64_t in_reference = 0, in_image = 0, in_either = 0;

  BadPixels& operator+=(const BadPixels& other) {
    in_reference += other.in_reference;
    in_image += other.in_image;
    in_either += other.in_either;
    return *this;
  }
};

/// Copies row y of two images of three planes with 0 for pixels that are not finite in either; `counts` is 0 there, else 1. What
/// lies behind the rows of the outputs, up to a whole vector, becomes 0: the metrics' loops need no end of their own.
BadPixels clean_row(FloatImage reference, FloatImage image, int y, FloatOutput clean_reference, FloatOutput clean_image,
                    FloatOutput counts);

/// to_display() within 2e-6 for three planes of finite values; 0 stays 0, also behind the row's end. May write over its input.
void display_row(DisplayTransform transform, FloatImage radiance, int y, FloatOutput display);

/// to_light() within 2e-6, in the same way.
void light_row(FloatImage display, int y, FloatOutput light);

}  // namespace quell::detail
