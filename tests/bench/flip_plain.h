// FLIP as one would first write it: planes of the whole image, one stage after the other, plain loops over separable filters.
#pragma once

#include "quell/metrics/flip.h"

namespace quell::bench {

Score plain_flip(const FlipImages& images, double pixels_per_degree, FloatOutput map, const Parallel& parallel);
Score plain_hdr_flip(const FlipImages& images, const Exposures& exposures, double pixels_per_degree, FloatOutput map,
                     const Parallel& parallel);

}  // namespace quell::bench
