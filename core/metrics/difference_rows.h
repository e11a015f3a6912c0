// Errors of a row of pixels, by vectors of double. Rows are 0 behind their end, as clean_row() makes them, and where a pixel does
// not count.
#pragma once

#include "quell/metrics/metric.h"
#include "quell/sdk/types.h"

namespace quell::detail {

/// Sums over the pixels of row y, each error the mean of three channels, in double throughout.
double squared_errors(FloatImage reference, FloatImage image, int y);
double relative_squared_errors(FloatImage reference, FloatImage image, int y);
double symmetric_errors(FloatImage reference, FloatImage image, int y);

/// Two display-referred images of a frame; `counts` is 1 for pixels that count, else 0.
struct Shown {
  FloatImage reference, image, counts;
};

/// Squared errors of the change since the frame before, over pixels that count in both.
Score squared_change_errors(const Shown& now, const Shown& before, int y);

}  // namespace quell::detail
