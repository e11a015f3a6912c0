// A row is first summed over the rows around it, into scratch memory with zeros on both sides, and then over its neighbors. Four
// vectors of pixels at a time stay in registers, so that a tap is one load and one multiply-add.
#include "passes/spatial/gaussian_kernel.h"

#include <algorithm>
#include <cstdlib>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/spatial/gaussian_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include "quell/simd/vectors-inl.h"

#ifndef QUELL_GAUSSIAN_SHARED  // what is the same for all vector units
#define QUELL_GAUSSIAN_SHARED
namespace quell::gaussian {

constexpr int kGroup = 4;              // vectors at a time
constexpr int kPadding = kGroup * 16;  // floats that the longest of them reach past the end

// 1 over the weights that lie in an image of that size, in one direction.
inline float find_gain(const Settings& s, int center, int size) {
  const auto before = static_cast<std::size_t>(std::min(s.radius(), center));
  const auto after = static_cast<std::size_t>(std::min(s.radius(), size - 1 - center));
  return 1 / (s.sums[before] + s.sums[after] - s.weights[0]);
}

}  // namespace quell::gaussian
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::gaussian::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

// The sums over `taps` of kCount vectors from `first` on, where a tap is `stride` floats from the next.
template <int kCount>
HWY_INLINE void sum_taps(const Settings& s, TapRange taps, const float* first, std::ptrdiff_t stride, V (&sums)[kCount]) {
  for (V& sum : sums) sum = zero();
  for (int i = taps.first; i <= taps.last; ++i) {
    const V weight = set(s.weights[static_cast<std::size_t>(std::abs(i))]);
    const float* tap = first + i * stride;
    for (int k = 0; k < kCount; ++k) sums[k] = hn::MulAdd(weight, hn::LoadU(D(), tap + k * lanes()), sums[k]);
  }
}

template <int kCount>
HWY_INLINE void sum_column(const FloatImage& in, const Settings& s, int x, int y, int c, float gain, float* columns) {
  V sums[kCount];
  sum_taps<kCount>(s, clamped_taps(y, s.radius(), in.height), in.row(y, c) + x, in.row_stride, sums);
  for (int k = 0; k < kCount; ++k) hn::StoreU(hn::Mul(sums[k], set(gain)), D(), columns + x + k * lanes());
}

void BlurRow(const FloatImage& in, const Settings& s, int y, int c, float* scratch, const FloatOutput& out) {
  const int width = in.width, r = s.radius();
  float* columns = scratch + r;
  const float gain = find_gain(s, y, in.height);
  int x = 0;
  for (; x + kGroup * lanes() <= width; x += kGroup * lanes()) sum_column<kGroup>(in, s, x, y, c, gain, columns);
  for (; x < width; x += lanes()) sum_column<1>(in, s, x, y, c, gain, columns);
  std::fill(columns - r, columns, 0.0F);
  std::fill_n(columns + width, r + kPadding, 0.0F);
  float* to = out.row(y, c);
  for (x = 0; x < width; x += kGroup * lanes()) {
    V sums[kGroup];
    sum_taps<kGroup>(s, {-r, r}, columns + x, 1, sums);
    for (int k = 0; k < kGroup && x + k * lanes() < width; ++k) store(sums[k], width - x - k * lanes(), to + x + k * lanes());
  }
  // Nearer than the radius to a border some weights are missing.
  for (x = 0; x < std::min(r, width); ++x) to[x] *= find_gain(s, x, width);
  for (x = std::max(r, width - r); x < width; ++x) to[x] *= find_gain(s, x, width);
}

}  // namespace quell::gaussian::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::gaussian {

std::size_t scratch_bytes(int width, int radius) {
  return static_cast<std::size_t>(width + 2 * radius + kPadding) * sizeof(float);
}

HWY_EXPORT(BlurRow);

void blur_row(const FloatImage& in, const Settings& settings, int y, int c, float* scratch, const FloatOutput& out) {
  HWY_DYNAMIC_DISPATCH(BlurRow)(in, settings, y, c, scratch, out);
}

}  // namespace quell::gaussian
#endif
