// Most pixels of a sequence have a long history: they are one subtraction. For others what lies around them is first copied into
// scratch memory, block by block, with an apron of taps that do not count, so that the loop over the taps has no border.
#include "passes/spatial/variance_kernel.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/spatial/variance_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes them visible again for every vector unit.
#include <hwy/contrib/math/math-inl.h>

#include "quell/simd/vectors-inl.h"

#ifndef QUELL_VARIANCE_SHARED  // what is the same for all vector units
#define QUELL_VARIANCE_SHARED
namespace quell::variance {

// Planes of a row in scratch memory.
enum Plane { kFirst, kSecond, kLuminance, kColor, kDepth = kColor + 3, kNormal, kPlanes = kNormal + 3 };

constexpr float kNoSurface = 1e10F;
constexpr float kSmallestGradient = 1e-8F;  // Falcor's
constexpr float kFar = 1e18F;               // as luminance: a tap that does not count; its weight is exactly 0
constexpr float kSmallestFactor = 1e-15F;   // with it luminances do not matter, but kFar does

constexpr int kBlock = 64;  // pixels of a row that are copied at a time

inline std::ptrdiff_t stride(int width, int radius) { return width + 2 * radius + 32; }
inline int blocks(int width) { return (width + kBlock - 1) / kBlock; }
inline std::size_t row_floats(int width, int radius) {
  return static_cast<std::size_t>(kPlanes) * static_cast<std::size_t>(stride(width, radius));
}

// Rows around row y, each of kPlanes planes. A row stays where it is while the window moves on.
struct Window {
  float* data;
  std::ptrdiff_t stride;  // from plane to plane
  int radius, y, width;
  int index(int dy) const { return (y + dy + radius) % (2 * radius + 1); }
  float* row(int dy) const { return data + index(dy) * kPlanes * stride + radius; }
  // For each block of a row whether it is there.
  std::uint8_t* is_there(int dy) const {
    return reinterpret_cast<std::uint8_t*>(data + (2 * radius + 1) * kPlanes * stride) + index(dy) * blocks(width);
  }
};

}  // namespace quell::variance
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::variance::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

using Mask = hn::Mask<D>;

HWY_INLINE V get(const Window& window, const float* pixel, int plane) { return hn::LoadU(D(), pixel + plane * window.stride); }
HWY_INLINE V3 get3(const Window& window, const float* pixel, int plane) {
  return load(pixel + plane * window.stride, window.stride);
}

constexpr float outside(int plane) { return plane == kLuminance ? kFar : 0; }

// Lays [begin, end) of a row outside of the image.
void fill_outside(const Window& window, int begin, int end, float* row) {
  for (int plane = 0; plane < kPlanes; ++plane)
    std::fill(row + plane * window.stride + begin, row + plane * window.stride + end, outside(plane));
}

// A block of row y of the images. Guides that are absent are the same everywhere.
void gather_block(const Images& in, const Settings& s, int y, int block, const Window& window, float* to) {
  const int width = window.width;
  const D d;
  for (int x = block * kBlock; x < std::min((block + 1) * kBlock, width); x += lanes()) {
    Mask counts = hn::FirstN(d, static_cast<std::size_t>(width - x));
    const V depth = in.depth ? hn::LoadU(d, in.depth.row(y) + x) : zero();
    if (in.depth) counts = hn::And(counts, hn::Lt(depth, set(kNoSurface)));
    const V3 color = load(in.color.row(y) + x, in.color.plane_stride);
    const V3 normal = in.normal ? load(in.normal.row(y) + x, in.normal.plane_stride) : V3{zero(), zero(), set(1.0F)};
    const auto put = [&](V v, int plane) {
      hn::StoreU(hn::IfThenElse(counts, v, set(outside(plane))), d, to + x + plane * window.stride);
    };
    put(hn::LoadU(d, in.moments.row(y, 0) + x), kFirst), put(hn::LoadU(d, in.moments.row(y, 1) + x), kSecond);
    put(s.luminance_factor > 0 ? luminance(color) : zero(), kLuminance);
    put(color.x, kColor), put(color.y, kColor + 1), put(color.z, kColor + 2);
    put(in.depth_gradient ? depth : zero(), kDepth);
    put(normal.x, kNormal), put(normal.y, kNormal + 1), put(normal.z, kNormal + 2);
  }
  if (block == 0) fill_outside(window, -window.radius, 0, to);
  if (block == blocks(width) - 1) fill_outside(window, width, width + window.radius + kMaxLanes, to);
}

// Nothing of the row y + dy is there yet; outside of the image it is one of taps that do not count.
void begin_row(const Images& in, const Window& window, int dy) {
  const int y = window.y + dy;
  const bool is_outside = y < 0 || y >= in.color.height;
  if (is_outside) fill_outside(window, -window.radius, window.width + window.radius + kMaxLanes, window.row(dy));
  std::fill_n(window.is_there(dy), blocks(window.width), is_outside ? std::uint8_t{1} : std::uint8_t{0});
}

// Sees to it that what the pixels from x on have around them is there.
void gather_around(const Images& in, const Settings& s, int x, const Window& window) {
  const int first = std::max(x - window.radius, 0) / kBlock;
  const int last = std::min(x + lanes() - 1 + window.radius, window.width - 1) / kBlock;
  for (int dy = -window.radius; dy <= window.radius; ++dy) {
    std::uint8_t* is_there = window.is_there(dy);
    for (int block = first; block <= last; ++block)
      if (!is_there[block]) {
        gather_block(in, s, window.y + dy, block, window, window.row(dy));
        is_there[block] = 1;
      }
  }
}

// Where the window's rows begin.
using Rows = std::array<const float*, 2 * kMaxRadius + 1>;

// What a pixel's window sums up to.
struct Sums {
  V weight, first, second;
  V3 color;
};

// `minus_steepness` is -1 over the gradient.
template <bool kWideNormals, bool kFiltersColor>
HWY_INLINE Sums sum_taps(const Settings& s, const Window& window, const Rows& rows, int x, V minus_steepness) {
  const float* center = rows[static_cast<std::size_t>(s.radius)] + x;
  const V luminance = get(window, center, kLuminance), depth = get(window, center, kDepth);
  const V luminance_gain = set(std::max(s.luminance_factor, kSmallestFactor));
  const V3 minus_normal = sub(V3{zero(), zero(), zero()}, get3(window, center, kNormal));
  const V normal_power = set(s.normal_power), minus_power = hn::Neg(normal_power);
  V sum = zero(), first = zero(), second = zero();
  V3 color{zero(), zero(), zero()};
  for (int dy = -s.radius; dy <= s.radius; ++dy) {
    const float* row = rows[static_cast<std::size_t>(dy + s.radius)] + x;
    const auto& depth_factors = s.depth_factors[static_cast<std::size_t>(std::abs(dy))];
    for (int dx = -s.radius; dx <= s.radius; ++dx) {
      const float* tap = row + dx;
      const V depth_gain = hn::Mul(minus_steepness, set(depth_factors[static_cast<std::size_t>(std::abs(dx))]));
      const V t = dot_add(minus_normal, get3(window, tap, kNormal), set(1.0F));  // 1 - n.n'
      V exponent = hn::Mul(hn::Abs(hn::Sub(get(window, tap, kDepth), depth)), depth_gain);
      exponent = hn::NegMulAdd(hn::Abs(hn::Sub(get(window, tap, kLuminance), luminance)), luminance_gain, exponent);
      if constexpr (kWideNormals)
        exponent = hn::MulAdd(normal_power, hn::Log(D(), hn::Max(hn::Sub(set(1.0F), t), set(1e-37F))), exponent);
      else
        exponent = add_log_narrow(t, minus_power, exponent);
      // Normals that are a little longer than 1 make it positive.
      const V weight = exp2(hn::Min(exponent, zero()));
      sum = hn::Add(sum, weight);
      first = hn::MulAdd(weight, get(window, tap, kFirst), first);
      second = hn::MulAdd(weight, get(window, tap, kSecond), second);
      if constexpr (kFiltersColor) color = mul_add(weight, get3(window, tap, kColor), color);
    }
  }
  return {sum, first, second, color};
}

template <bool kWideNormals, bool kFiltersColor>
void estimate_row(const Images& in, const Settings& s, int y, const FloatOutput& variance, const FloatOutput& color,
                  const Window& window, int& begun) {
  const D d;
  for (int row = std::max(y - s.radius, begun); row <= y + s.radius; ++row) begin_row(in, window, row - y);
  begun = y + s.radius + 1;
  Rows rows{};
  for (int dy = -s.radius; dy <= s.radius; ++dy) rows[static_cast<std::size_t>(dy + s.radius)] = window.row(dy);
  for (int x = 0; x < variance.width; x += lanes()) {
    const int count = variance.width - x;
    const V length = in.length ? hn::LoadU(d, in.length.row(y) + x) : set(1.0F);
    Mask young = hn::And(hn::Lt(length, set(s.min_length)), hn::FirstN(d, static_cast<std::size_t>(count)));
    if (hn::AllFalse(d, young)) continue;
    gather_around(in, s, x, window);
    young = hn::And(young, hn::Lt(get(window, window.row(0) + x, kLuminance), set(kFar)));
    if (hn::AllFalse(d, young)) continue;
    const V one = set(1.0F);
    V minus_steepness = zero();
    if (in.depth_gradient)
      minus_steepness = hn::Div(set(-1.0F), hn::Max(hn::LoadU(d, in.depth_gradient.row(y) + x), set(kSmallestGradient)));
    const Sums sums = sum_taps<kWideNormals, kFiltersColor>(s, window, rows, x, minus_steepness);
    const Mask good = hn::And(young, hn::Gt(sums.weight, zero()));
    const V scale = hn::Div(one, sums.weight), first = hn::Mul(sums.first, scale), second = hn::Mul(sums.second, scale);
    V estimate = hn::Max(hn::NegMulAdd(first, first, second), zero());
    if (s.boost) estimate = hn::Mul(estimate, hn::Div(set(s.min_length), hn::Max(length, one)));
    store(hn::IfThenElse(good, estimate, hn::LoadU(d, variance.row(y) + x)), count, variance.row(y) + x);
    if constexpr (kFiltersColor)
      store(if_then_else(good, mul(scale, sums.color), load(in.color.row(y) + x, in.color.plane_stride)), count, color.row(y) + x,
            color.plane_stride);
  }
}

void VarianceRow(const Images& in, const Settings& s, int y, const FloatOutput& variance, const FloatOutput& color,
                 float* scratch, int& begun) {
  const D d;
  const int width = variance.width;
  for (int c = 0; c < 3; ++c)
    if (color.row(y, c) != in.color.row(y, c)) std::copy_n(in.color.row(y, c), width, color.row(y, c));
  Mask any_young = hn::Lt(zero(), zero());
  for (int x = 0; x < width; x += lanes()) {
    const V first = hn::LoadU(d, in.moments.row(y, 0) + x), second = hn::LoadU(d, in.moments.row(y, 1) + x);
    store(hn::Max(hn::NegMulAdd(first, first, second), zero()), width - x, variance.row(y) + x);
    const Mask inside = hn::FirstN(d, static_cast<std::size_t>(width - x));
    const Mask young = in.length ? hn::Lt(hn::LoadU(d, in.length.row(y) + x), set(s.min_length)) : inside;
    any_young = hn::Or(any_young, hn::And(inside, young));
  }
  if (hn::AllFalse(d, any_young)) return;
  const Window window{scratch, stride(width, s.radius), s.radius, y, width};
  auto* estimate = s.wide_normals ? estimate_row<true, false> : estimate_row<false, false>;
  if (s.filter_color) estimate = s.wide_normals ? estimate_row<true, true> : estimate_row<false, true>;
  estimate(in, s, y, variance, color, window, begun);
}

}  // namespace quell::variance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::variance {

HWY_EXPORT(VarianceRow);

std::size_t scratch_bytes(int width, int radius) {
  const auto rows = static_cast<std::size_t>(2 * radius + 1);
  return rows * (row_floats(width, radius) * sizeof(float) + static_cast<std::size_t>(blocks(width)));
}

void variance_rows(const Images& in, const Settings& settings, int y0, int y1, const FloatOutput& variance,
                   const FloatOutput& color, float* scratch) {
  int begun = y0 - settings.radius;  // rows before this one are in scratch memory, or are not needed
  for (int y = y0; y < y1; ++y) HWY_DYNAMIC_DISPATCH(VarianceRow)(in, settings, y, variance, color, scratch, begun);
}

}  // namespace quell::variance
#endif
