// A reference and an image made ready for the metrics.
#pragma once

#include "quell/metrics/comparison.h"
#include "quell/metrics/difference_rows.h"
#include "quell/metrics/display_rows.h"

namespace quell::detail {

struct Prepared {
  Image reference, image;              ///< radiance, 0 where either is not finite; none when nothing looks at it
  Image shown_reference, shown_image;  ///< the display values of these
  Image counts;                        ///< 1 where both are finite, else 0
  BadPixels bad;
  std::uint64_t good = 0;  ///< pixels that count

  Shown shown() const { return {shown_reference.floats(), shown_image.floats(), counts.floats()}; }
};

/// Rows are 0 behind their end, up to a whole vector; all images of a size have the same strides.
Prepared prepare(const ImagePair& pair, DisplayTransform transform, bool with_radiance, BufferPool& pool,
                 const Parallel& parallel);

}  // namespace quell::detail
