#include "quell/metrics/flip_scores.h"

#include <array>

#include "quell/metrics/bands.h"
#include "quell/metrics/display_rows.h"
#include "quell/metrics/flip.h"

namespace quell::detail {
namespace {

// None when every pixel counts.
FloatImage counts_of(const Prepared& pair) { return pair.bad.in_either > 0 ? pair.counts.floats() : FloatImage{}; }

Image light_of(const Image& display, BufferPool& pool, const Parallel& parallel) {
  Image light(QUELL_TYPE_COLOR, display.size(), pool);
  const FloatImage from = display.floats();
  const FloatOutput to = light.writable_floats();
  for_bands(from.height, parallel, [&](int y0, int y1) {
    for (int y = y0; y < y1; ++y) light_row(from, y, to);
  });
  return light;
}

}  // namespace

Score flip_of_display(const Prepared& pair, const CompareOptions& options, FloatOutput map, BufferPool& pool,
                      const Parallel& parallel) {
  const Image reference = light_of(pair.shown_reference, pool, parallel), image = light_of(pair.shown_image, pool, parallel);
  return flip({reference.floats(), image.floats(), counts_of(pair)}, options.pixels_per_degree, map, pool, parallel);
}

Score flip_of_radiance(const Prepared& pair, const CompareOptions& options, FloatOutput map, BufferPool& pool,
                       const Parallel& parallel) {
  Exposures exposures;
  if (options.exposures)
    exposures = *options.exposures;
  else
    exposures = choose_exposures(std::array{luminance_range(pair.reference.floats(), pool, parallel)});
  return hdr_flip({pair.reference.floats(), pair.image.floats(), counts_of(pair)}, exposures, options.pixels_per_degree, map,
                  pool, parallel);
}

}  // namespace quell::detail
