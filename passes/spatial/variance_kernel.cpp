// Most rows of a sequence have a long history throughout: they are one subtraction a pixel. For others the rows of the window are
// first copied into scratch memory, with an apron of taps that do not count, so that the loop over the taps has no border.
#include "passes/spatial/variance_kernel.h"

#include <algorithm>
#include <cmath>

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
enum Plane { kCounts, kFirst, kSecond, kLuminance, kColor, kDepth = kColor + 3, kNormal, kPlanes = kNormal + 3 };

constexpr float kNoSurface = 1e10F;
constexpr float kSmallestGradient = 1e-8F;    // Falcor's
constexpr float kSmallestTolerance = 1e-30F;  // of a difference in depth; its reciprocal is still finite

// Rows around row y, each of kPlanes planes. A row stays where it is while the window moves on.
struct Window {
  float* data;
  std::ptrdiff_t stride;  // from plane to plane
  int radius, y;
  float* row(int dy) const {
    const int rows = 2 * radius + 1;
    return data + ((y + dy + radius) % rows) * kPlanes * stride + radius;
  }
};

inline std::ptrdiff_t stride(int width, int radius) { return width + 2 * radius + 32; }

}  // namespace quell::variance
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::variance::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

using Mask = hn::Mask<D>;

HWY_INLINE void put(V v, const Window& window, float* pixel, int plane) { hn::StoreU(v, D(), pixel + plane * window.stride); }
HWY_INLINE V get(const Window& window, const float* pixel, int plane) { return hn::LoadU(D(), pixel + plane * window.stride); }
HWY_INLINE V3 get3(const Window& window, const float* pixel, int plane) {
  return load(pixel + plane * window.stride, window.stride);
}

// Row y of the images, or a row of taps that do not count where it lies outside.
void gather_row(const Images& in, int y, const Window& window, float* to) {
  for (int plane = 0; plane < kPlanes; ++plane)
    std::fill_n(to + plane * window.stride - window.radius, in.color.width + 2 * window.radius + kMaxLanes, 0.0F);
  if (y < 0 || y >= in.color.height) return;
  const D d;
  for (int x = 0; x < in.color.width; x += lanes()) {
    Mask counts = hn::FirstN(d, static_cast<std::size_t>(in.color.width - x));
    const V depth = in.depth ? hn::LoadU(d, in.depth.row(y) + x) : zero();
    if (in.depth) counts = hn::And(counts, hn::Lt(depth, set(kNoSurface)));
    const auto keep = [&](V v) { return hn::IfThenElseZero(counts, v); };
    const V3 color = load(in.color.row(y) + x, in.color.plane_stride);
    put(keep(set(1.0F)), window, to + x, kCounts);
    put(keep(hn::LoadU(d, in.moments.row(y, 0) + x)), window, to + x, kFirst);
    put(keep(hn::LoadU(d, in.moments.row(y, 1) + x)), window, to + x, kSecond);
    put(keep(luminance(color)), window, to + x, kLuminance);
    put(keep(color.x), window, to + x, kColor), put(keep(color.y), window, to + x, kColor + 1);
    put(keep(color.z), window, to + x, kColor + 2);
    put(keep(depth), window, to + x, kDepth);
    if (!in.normal) continue;
    const V3 normal = load(in.normal.row(y) + x, in.normal.plane_stride);
    put(keep(normal.x), window, to + x, kNormal), put(keep(normal.y), window, to + x, kNormal + 1);
    put(keep(normal.z), window, to + x, kNormal + 2);
  }
}

// What a pixel's window sums up to.
struct Sums {
  V weight, first, second;
  V3 color;
};

template <bool kWideNormals>
HWY_INLINE Sums sum_taps(const Images& in, const Settings& s, const Window& window, int x, V gradient) {
  const float* center = window.row(0) + x;
  const V luminance = get(window, center, kLuminance), depth = get(window, center, kDepth);
  const V3 normal = get3(window, center, kNormal);
  Sums sums{zero(), zero(), zero(), {zero(), zero(), zero()}};
  for (int dy = -s.radius; dy <= s.radius; ++dy)
    for (int dx = -s.radius; dx <= s.radius; ++dx) {
      const float* tap = window.row(dy) + x + dx;
      V e = zero();
      if (s.luminance_factor > 0) e = hn::Mul(hn::Abs(hn::Sub(get(window, tap, kLuminance), luminance)), set(s.luminance_factor));
      if (in.depth_gradient && (dx != 0 || dy != 0)) {
        const V tolerance = hn::Mul(gradient, set(s.depth_factor * std::sqrt(static_cast<float>(dx * dx + dy * dy))));
        const V difference = hn::Abs(hn::Sub(get(window, tap, kDepth), depth));
        e = hn::Add(e, hn::Div(difference, hn::Max(tolerance, set(kSmallestTolerance))));
      }
      if (in.normal) {
        const V cosine = dot(normal, get3(window, tap, kNormal));
        if constexpr (kWideNormals)
          e = hn::NegMulAdd(set(s.normal_power), hn::Log(D(), hn::Max(cosine, set(1e-37F))), e);
        else
          e = add_log_narrow(hn::Sub(set(1.0F), cosine), set(s.normal_power), e);
      }
      // Normals that are a little longer than 1 make e negative.
      const V weight = hn::Mul(exp2(hn::Neg(hn::Max(e, zero()))), get(window, tap, kCounts));
      sums.weight = hn::Add(sums.weight, weight);
      sums.first = hn::MulAdd(weight, get(window, tap, kFirst), sums.first);
      sums.second = hn::MulAdd(weight, get(window, tap, kSecond), sums.second);
      if (s.filter_color) sums.color = mul_add(weight, get3(window, tap, kColor), sums.color);
    }
  return sums;
}

template <bool kWideNormals>
void estimate_row(const Images& in, const Settings& s, int y, const FloatOutput& variance, const FloatOutput& color,
                  const Window& window, int& gathered) {
  const D d;
  for (int row = std::max(y - s.radius, gathered); row <= y + s.radius; ++row) gather_row(in, row, window, window.row(row - y));
  gathered = y + s.radius + 1;
  for (int x = 0; x < variance.width; x += lanes()) {
    const int count = variance.width - x;
    const V length = in.length ? hn::LoadU(d, in.length.row(y) + x) : set(1.0F);
    const float* center = window.row(0) + x;
    const Mask young = hn::And(hn::Lt(length, set(s.min_length)), hn::Gt(get(window, center, kCounts), zero()));
    if (hn::AllFalse(d, young)) continue;
    const V gradient = in.depth_gradient ? hn::Max(hn::LoadU(d, in.depth_gradient.row(y) + x), set(kSmallestGradient)) : zero();
    const Sums sums = sum_taps<kWideNormals>(in, s, window, x, gradient);
    const Mask good = hn::And(young, hn::Gt(sums.weight, zero()));
    const V first = hn::Div(sums.first, sums.weight), second = hn::Div(sums.second, sums.weight);
    V estimate = hn::Max(hn::NegMulAdd(first, first, second), zero());
    if (s.boost) estimate = hn::Mul(estimate, hn::Div(set(s.min_length), hn::Max(length, set(1.0F))));
    store(hn::IfThenElse(good, estimate, hn::LoadU(d, variance.row(y) + x)), count, variance.row(y) + x);
    if (!s.filter_color) continue;
    const V3 mean{hn::Div(sums.color.x, sums.weight), hn::Div(sums.color.y, sums.weight), hn::Div(sums.color.z, sums.weight)};
    store(if_then_else(good, mean, load(in.color.row(y) + x, in.color.plane_stride)), count, color.row(y) + x,
          color.plane_stride);
  }
}

void VarianceRow(const Images& in, const Settings& s, int y, const FloatOutput& variance, const FloatOutput& color,
                 float* scratch, int& gathered) {
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
  const Window window{scratch, stride(width, s.radius), s.radius, y};
  if (s.wide_normals)
    estimate_row<true>(in, s, y, variance, color, window, gathered);
  else
    estimate_row<false>(in, s, y, variance, color, window, gathered);
}

}  // namespace quell::variance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::variance {

HWY_EXPORT(VarianceRow);

std::size_t scratch_bytes(int width, int radius) {
  const auto rows = static_cast<std::size_t>(2 * radius + 1);
  return rows * static_cast<std::size_t>(kPlanes) * static_cast<std::size_t>(stride(width, radius)) * sizeof(float);
}

void variance_rows(const Images& in, const Settings& settings, int y0, int y1, const FloatOutput& variance,
                   const FloatOutput& color, float* scratch) {
  int gathered = y0 - settings.radius;  // rows before this one are in scratch memory, or are not needed
  for (int y = y0; y < y1; ++y) HWY_DYNAMIC_DISPATCH(VarianceRow)(in, settings, y, variance, color, scratch, gathered);
}

}  // namespace quell::variance
#endif
