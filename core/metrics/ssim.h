// Structural similarity.
#pragma once

#include "quell/metrics/difference_rows.h"
#include "quell/metrics/parallel.h"

namespace quell::detail {

inline constexpr int kSsimRadius = 5;  // pixels: 3.5 standard deviations of 1.5, rounded

/// Wang et al. 2004: Gaussian window of 11 x 11, population covariance, constants 0.01 and 0.03, data range 1. The similarity of
/// a pixel is the mean of its channels'. Pixels nearer to an edge than the window's radius do not count, so that a smaller image
/// has no pixel that does.
Score ssim(const Shown& shown, const Parallel& parallel);

}  // namespace quell::detail
