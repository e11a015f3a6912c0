// The rows of the window are first copied into scratch memory, with their luminance and room for the taps on both sides. Vectors
// that have no tap outside of the image do without masks.
//
// The mean and the variance are found in two rounds, the second of which takes differences from the first one's mean and corrects
// it: the deviation of bright pixels does not drown in roundings, and the mean of equal values is that value, bit for bit.
#include "passes/spatial/firefly_kernel.h"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/spatial/firefly_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include "quell/simd/vectors-inl.h"

#ifndef QUELL_FIREFLY_SHARED  // what is the same for all vector units
#define QUELL_FIREFLY_SHARED
namespace quell::firefly {

// Planes of a row in scratch memory.
enum Plane { kLuminance, kColor, kPlanes = kColor + 3 };

// Rows around row y. A row stays where it is while the window moves on.
struct Window {
  float* data;
  std::ptrdiff_t stride;  // from plane to plane
  int width, height, radius, y;
  float* row(int dy) const {
    const int rows = 2 * radius + 1;
    return data + ((y + dy + radius) % rows) * kPlanes * stride + radius;
  }
};

inline std::ptrdiff_t stride(int width, int radius) { return width + 2 * radius + 16; }

}  // namespace quell::firefly
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::firefly::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

using Mask = hn::Mask<D>;

void gather_row(const FloatImage& in, int y, const Window& window, float* to) {
  for (int plane = 0; plane < kPlanes; ++plane) {  // what stands beside the image is never counted, but read
    float* row = to + plane * window.stride;
    std::fill(row - window.radius, row, 0.0F);
    std::fill_n(row + in.width, window.radius + kMaxLanes, 0.0F);
  }
  for (int x = 0; x < in.width; x += lanes()) {
    const V3 color = load(in.row(y) + x, in.plane_stride);
    const int count = in.width - x;
    store(luminance(color), count, to + x);
    store(color, count, to + x + kColor * window.stride, window.stride);
  }
}

// Which of the pixels from x on lie in the image.
template <bool kBorder>
HWY_INLINE Mask inside(const Window& window, int x) {
  const D d;
  if constexpr (!kBorder) return hn::FirstN(d, kMaxLanes);
  const V column = hn::Iota(d, static_cast<float>(x));
  return hn::And(hn::Ge(column, zero()), hn::Lt(column, set(static_cast<float>(window.width))));
}
template <bool kBorder>
HWY_INLINE V count(Mask mask, V v) {
  return kBorder ? hn::IfThenElseZero(mask, v) : v;
}

struct Limits {
  V lower, upper;
};

// How many taps the pixels from x on have.
HWY_INLINE V count_taps(const Settings& s, const Window& window, int x, TapRange rows) {
  const V r = set(static_cast<float>(s.radius)), column = hn::Iota(D(), static_cast<float>(x));
  const V last = set(static_cast<float>(window.width - 1));
  const V columns = hn::Add(hn::Add(hn::Min(r, column), hn::Min(r, hn::Sub(last, column))), set(1.0F));
  const V taps = hn::Mul(columns, set(static_cast<float>(rows.last - rows.first + 1)));
  return s.exclude_center ? hn::Sub(taps, set(1.0F)) : taps;
}

// Of a plane, for the pixels from x on.
template <bool kBorder>
HWY_INLINE Limits find_limits(const Settings& s, const Window& window, int x, int plane) {
  const TapRange rows = clamped_taps(window.y, s.radius, window.height);
  const auto skips = [&](int dx, int dy) { return dx == 0 && dy == 0 && s.exclude_center; };
  V total = zero();
  for (int dy = rows.first; dy <= rows.last; ++dy) {
    const float* row = window.row(dy) + x + plane * window.stride;
    for (int dx = -s.radius; dx <= s.radius; ++dx)
      if (!skips(dx, dy)) total = hn::Add(total, count<kBorder>(inside<kBorder>(window, x + dx), hn::LoadU(D(), row + dx)));
  }
  const V taps = count_taps(s, window, x, rows);
  const V near_mean = hn::Div(total, hn::Max(taps, set(1.0F)));
  V sum = zero(), squares = zero();
  for (int dy = rows.first; dy <= rows.last; ++dy) {
    const float* row = window.row(dy) + x + plane * window.stride;
    for (int dx = -s.radius; dx <= s.radius; ++dx) {
      if (skips(dx, dy)) continue;
      const V from_mean = count<kBorder>(inside<kBorder>(window, x + dx), hn::Sub(hn::LoadU(D(), row + dx), near_mean));
      sum = hn::Add(sum, from_mean);
      squares = hn::MulAdd(from_mean, from_mean, squares);
    }
  }
  const V rest = hn::Div(sum, hn::Max(taps, set(1.0F)));
  const V variance = hn::Div(hn::Max(hn::NegMulAdd(rest, sum, squares), zero()), hn::Max(hn::Sub(taps, set(1.0F)), set(1.0F)));
  const V mean = hn::Add(near_mean, rest), way_to_limit = hn::Mul(set(s.k), hn::Sqrt(variance));
  const Mask known = hn::Ge(taps, set(2.0F));
  const V infinity = hn::Inf(D());
  V lower = hn::Sub(mean, way_to_limit), upper = hn::Add(mean, way_to_limit);
  // Not Max: of NaN and the floor, which is for what is not finite in the window, it would make the floor.
  if (s.method == Method::bound)
    lower = hn::Neg(infinity), upper = hn::IfThenElse(hn::Lt(upper, set(s.floor)), set(s.floor), upper);
  return {hn::IfThenElse(known, lower, hn::Neg(infinity)), hn::IfThenElse(known, upper, infinity)};
}

struct Result {
  V3 color;
  Mask changed;
};

template <bool kBorder>
HWY_INLINE Result clamp_luminance(const Settings& s, const Window& window, int x) {
  const float* center = window.row(0) + x;
  const V own = hn::LoadU(D(), center);
  const V3 color = load(center + kColor * window.stride, window.stride);
  const Limits limits = find_limits<kBorder>(s, window, x, kLuminance);
  const Mask high = hn::Gt(own, limits.upper), low = hn::Lt(own, limits.lower);
  const Mask changed = hn::And(hn::Or(high, low), hn::Gt(own, zero()));
  const V scale = hn::Div(hn::Max(hn::IfThenElse(high, limits.upper, limits.lower), zero()), own);
  return {if_then_else(changed, mul(scale, color), color), changed};
}

HWY_INLINE V clamp(V v, Limits limits, Mask& changed) {
  const Mask high = hn::Gt(v, limits.upper), low = hn::Lt(v, limits.lower);
  changed = hn::Or(changed, hn::Or(high, low));
  return hn::IfThenElse(high, limits.upper, hn::IfThenElse(low, limits.lower, v));
}

template <bool kBorder>
HWY_INLINE Result clamp_channels(const Settings& s, const Window& window, int x) {
  const V3 color = load(window.row(0) + x + kColor * window.stride, window.stride);
  Result result{{}, hn::Lt(zero(), zero())};
  result.color.x = clamp(color.x, find_limits<kBorder>(s, window, x, kColor), result.changed);
  result.color.y = clamp(color.y, find_limits<kBorder>(s, window, x, kColor + 1), result.changed);
  result.color.z = clamp(color.z, find_limits<kBorder>(s, window, x, kColor + 2), result.changed);
  return result;
}

// The neighbor of the largest luminance takes the place of what is brighter than all, that of the least of what is darker.
template <bool kBorder>
HWY_INLINE Result select_by_rank(const Window& window, int x) {
  const float* center = window.row(0) + x;
  const V own = hn::LoadU(D(), center);
  const V3 color = load(center + kColor * window.stride, window.stride);
  const V infinity = hn::Inf(D());
  V most = hn::Neg(infinity), least = infinity;
  V3 brightest = color, darkest = color;
  Mask any = hn::Lt(zero(), zero());
  const TapRange rows = clamped_taps(window.y, 1, window.height);
  for (int dy = rows.first; dy <= rows.last; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const float* tap = window.row(dy) + x + dx;
      const V tap_luminance = hn::LoadU(D(), tap);
      const V3 tap_color = load(tap + kColor * window.stride, window.stride);
      const Mask counts = inside<kBorder>(window, x + dx);
      const Mask more = hn::And(counts, hn::Gt(tap_luminance, most)), less = hn::And(counts, hn::Lt(tap_luminance, least));
      any = hn::Or(any, hn::Or(more, less));
      most = hn::IfThenElse(more, tap_luminance, most), least = hn::IfThenElse(less, tap_luminance, least);
      brightest = if_then_else(more, tap_color, brightest), darkest = if_then_else(less, tap_color, darkest);
    }
  const Mask high = hn::And(any, hn::Gt(own, most)), low = hn::And(any, hn::Lt(own, least));
  return {if_then_else(high, brightest, if_then_else(low, darkest, color)), hn::Or(high, low)};
}

template <bool kBorder>
HWY_INLINE void clamp_pixels(const Settings& s, const Window& window, int x, const FloatOutput& color, const FloatOutput& mask) {
  Result result{};
  if (s.method == Method::rank)
    result = select_by_rank<kBorder>(window, x);
  else if (s.by_channel)
    result = clamp_channels<kBorder>(s, window, x);
  else
    result = clamp_luminance<kBorder>(s, window, x);
  const int count = window.width - x;
  store(result.color, count, color.row(window.y) + x, color.plane_stride);
  store(hn::IfThenElseZero(result.changed, set(1.0F)), count, mask.row(window.y) + x);
}

void ClampRows(const FloatImage& in, const Settings& s, int y0, int y1, const FloatOutput& color, const FloatOutput& mask,
               float* scratch) {
  Window window{scratch, stride(in.width, s.radius), in.width, in.height, s.radius, y0};
  int gathered = std::max(y0 - s.radius, 0);
  for (; window.y < y1; ++window.y) {
    for (; gathered < std::min(window.y + s.radius + 1, in.height); ++gathered)
      gather_row(in, gathered, window, window.row(gathered - window.y));
    for (int x = 0; x < in.width; x += lanes())
      if (x < s.radius || x + lanes() + s.radius > in.width)
        clamp_pixels<true>(s, window, x, color, mask);
      else
        clamp_pixels<false>(s, window, x, color, mask);
  }
}

}  // namespace quell::firefly::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::firefly {

std::size_t scratch_bytes(int width, int radius) {
  const auto rows = static_cast<std::size_t>(2 * radius + 1);
  return rows * static_cast<std::size_t>(kPlanes) * static_cast<std::size_t>(stride(width, radius)) * sizeof(float);
}

HWY_EXPORT(ClampRows);

void clamp_rows(const FloatImage& in, const Settings& settings, int y0, int y1, const FloatOutput& color, const FloatOutput& mask,
                float* scratch) {
  HWY_DYNAMIC_DISPATCH(ClampRows)(in, settings, y0, y1, color, mask, scratch);
}

}  // namespace quell::firefly
#endif
