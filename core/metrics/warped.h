// Flicker along the motion.
#pragma once

#include "quell/metrics/difference_rows.h"
#include "quell/metrics/parallel.h"

namespace quell::detail {

/// What the image changes by from the frame before, fetched where the motion says each pixel was, less what the reference changes
/// by. `motion` has two planes, pixels to add to a pixel's position; none: nothing moves. A pixel counts when the fetch lies
/// between centers of pixels of the image, and it and the fetched ones count.
Score warped_errors(const Shown& now, const Shown& before, FloatImage motion, const Parallel& parallel);

}  // namespace quell::detail
