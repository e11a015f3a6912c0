// Vectors of pixels around a vector of pixels, straight from images that end: what windows of small or changing reach are read
// by. Included once for every vector unit, after hwy/foreach_target.h.
#if defined(QUELL_TEMPORAL_TAPS) == defined(HWY_TARGET_TOGGLE)
#ifdef QUELL_TEMPORAL_TAPS
#undef QUELL_TEMPORAL_TAPS
#else
#define QUELL_TEMPORAL_TAPS
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "quell/sdk/types.h"
#include "quell/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace quell::taps::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

using Mask = hn::Mask<D>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;

constexpr float kNoSurface = 1e10F;

HWY_INLINE Mask nowhere() { return hn::Lt(zero(), zero()); }

// Lanes of the pixels from x on that lie in a row of that width.
HWY_INLINE Mask inside(int x, int width) {
  const DI d;
  const auto at = hn::Iota(d, x);
  return hn::RebindMask(D(), hn::And(hn::Gt(at, hn::Set(d, -1)), hn::Lt(at, hn::Set(d, width))));
}

// The pixels of a row from x < its width on, at least one of which lies in the row; the others are anything.
template <class T>
HWY_INLINE auto read(const T* row, int x) {
  using DT = std::conditional_t<std::is_same_v<T, float>, D, DU>;
  if (HWY_LIKELY(x >= 0)) return hn::LoadU(DT(), row + x);
  const DI d;
  return hn::GatherIndex(DT(), row, hn::Max(hn::Iota(d, x), hn::Zero(d)));
}
HWY_INLINE V3 read3(const FloatImage& image, int x, int y) {
  return {read(image.row(y, 0), x), read(image.row(y, 1), x), read(image.row(y, 2), x)};
}

// Calls tap(index, dx, dy, x + dx stride, y + dy stride) for each dx and dy in [-radius, radius] with a pixel in the image.
template <class Tap>
HWY_INLINE void each_tap(int radius, int stride, int x, int y, int width, int height, const Tap& tap) {
  for (int dy = -radius; dy <= radius; ++dy) {
    const int ty = y + dy * stride;
    if (ty < 0 || ty >= height) continue;
    for (int dx = -radius; dx <= radius; ++dx) {
      const int tx = x + dx * stride;
      if (tx < width && tx + lanes() > 0) tap((dy + radius) * (2 * radius + 1) + dx + radius, dx, dy, tx, ty);
    }
  }
}

// Calls neighbor(x + dx, y + dy, lanes that lie in the image and show a surface) likewise. Without a depth all show one.
template <class Neighbor>
HWY_INLINE void each_neighbor(int radius, int x, int y, int width, int height, const FloatImage& depth,
                              const Neighbor& neighbor) {
  each_tap(radius, 1, x, y, width, height, [&](int, int, int, int tx, int ty) HWY_ATTR {
    Mask counts = inside(tx, width);
    if (depth) counts = hn::And(counts, hn::Lt(read(depth.row(ty), tx), set(kNoSurface)));
    neighbor(tx, ty, counts);
  });
}

// Malvar and Sullivan, "YCoCg-R: A Color Space with RGB Reversibility and Low Dynamic Range", JVT-I014r3, 2003.
HWY_INLINE V3 ycocg(V3 rgb) {
  const V half = set(0.5F), sides = hn::Mul(half, hn::Add(rgb.x, rgb.z));
  return {hn::Mul(half, hn::Add(rgb.y, sides)), hn::Mul(half, hn::Sub(rgb.x, rgb.z)), hn::Mul(half, hn::Sub(rgb.y, sides))};
}
HWY_INLINE V3 rgb(V3 ycocg) {
  const V base = hn::Sub(ycocg.x, ycocg.z);
  return {hn::Add(base, ycocg.y), hn::Add(ycocg.x, ycocg.z), hn::Sub(base, ycocg.y)};
}

// Sums of differences to a value of the window, so that nothing cancels: mean and deviation relative to that value.
struct Spread {
  V first, second;
  HWY_INLINE Spread() : first(zero()), second(zero()) {}  // said, since what the compiler makes is of no vector unit
  HWY_INLINE void add(Mask counts, V difference) {
    difference = hn::IfThenElseZero(counts, difference);
    first = hn::Add(first, difference);
    second = hn::MulAdd(difference, difference, second);
  }
  HWY_INLINE V mean(V share) const { return hn::Mul(first, share); }  // share: 1 / count
  HWY_INLINE V deviation(V share) const {
    const V m = mean(share);
    return hn::Sqrt(hn::Max(hn::NegMulAdd(m, m, hn::Mul(second, share)), zero()));
  }
};

}  // namespace quell::taps::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
