#include "quell/metrics/prepare.h"

#include "quell/metrics/bands.h"

namespace quell::detail {

Prepared prepare(const ImagePair& pair, DisplayTransform transform, bool with_radiance, BufferPool& pool,
                 const Parallel& parallel) {
  const Size size = pair.reference.size();
  Prepared result;
  result.shown_reference = Image(QUELL_TYPE_COLOR, size, pool);
  result.shown_image = Image(QUELL_TYPE_COLOR, size, pool);
  result.counts = Image(QUELL_TYPE_SCALAR, size, pool);
  if (with_radiance) {
    result.reference = Image(QUELL_TYPE_COLOR, size, pool);
    result.image = Image(QUELL_TYPE_COLOR, size, pool);
  }
  const FloatImage reference = pair.reference.floats(), image = pair.image.floats();
  const FloatOutput shown_reference = result.shown_reference.writable_floats(),
                    shown_image = result.shown_image.writable_floats();
  const FloatOutput clean_reference = with_radiance ? result.reference.writable_floats() : shown_reference;
  const FloatOutput clean_image = with_radiance ? result.image.writable_floats() : shown_image;
  const FloatOutput counts = result.counts.writable_floats();
  result.bad = sum_bands<BadPixels>(size.height, parallel, [&](int y0, int y1) {
    BadPixels bad;
    for (int y = y0; y < y1; ++y) {
      bad += clean_row(reference, image, y, clean_reference, clean_image, counts);
      display_row(transform, clean_reference, y, shown_reference);
      display_row(transform, clean_image, y, shown_image);
    }
    return bad;
  });
  result.good = static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height) - result.bad.in_either;
  return result;
}

}  // namespace quell::detail
