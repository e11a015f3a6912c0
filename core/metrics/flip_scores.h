// FLIP of prepared images.
#pragma once

#include "quell/metrics/comparison.h"
#include "quell/metrics/prepare.h"

namespace quell::detail {

/// FLIP of the light that a display makes of the display values.
Score flip_of_display(const Prepared& pair, const CompareOptions& options, FloatOutput map, BufferPool& pool,
                      const Parallel& parallel);
/// HDR-FLIP of radiance, with the options' exposures or those that the reference asks for.
Score flip_of_radiance(const Prepared& pair, const CompareOptions& options, FloatOutput map, BufferPool& pool,
                       const Parallel& parallel);

}  // namespace quell::detail
