// What stops the à-trous filter at an edge: for each kind of stops what a row in scratch memory holds, in planes, and the
// exponent of a tap's weight. Included once for every vector unit.
#if defined(QUELL_ATROUS_STOPS) == defined(HWY_TARGET_TOGGLE)
#ifdef QUELL_ATROUS_STOPS
#undef QUELL_ATROUS_STOPS
#else
#define QUELL_ATROUS_STOPS
#endif

#include <hwy/contrib/math/math-inl.h>

#include "passes/spatial/atrous_kernel.h"
#include "quell/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace quell::atrous::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

// Floats from a plane to the next. Not a multiple of 4 kB, or all planes would compete for the same lines of the first-level
// cache.
constexpr int kStride = 1040;
constexpr float kFar = 1e18F;    // in the carrier: a tap that does not count; its square is still finite
constexpr float kTiny = 1e-36F;  // added to squared distances, which are then never 0
constexpr float kNoSurface = QUELL_NO_SURFACE_DEPTH;
constexpr float kNoGain = 1e-15F;  // with it luminances do not matter, but kFar does
constexpr float kLn2 = 0.69314718F;

using Mask = hn::Mask<D>;

HWY_INLINE V at(const float* pixel, int plane) { return hn::LoadU(D(), pixel + plane * kStride); }
HWY_INLINE V3 at3(const float* pixel, int plane) { return load(pixel + plane * kStride, kStride); }
HWY_INLINE void put(V v, float* pixel, int plane) { hn::StoreU(v, D(), pixel + plane * kStride); }
HWY_INLINE void put(V3 v, float* pixel, int plane) {
  put(v.x, pixel, plane), put(v.y, pixel, plane + 1), put(v.z, pixel, plane + 2);
}
HWY_INLINE V pixels(const FloatImage& image, int x, int y) { return hn::LoadU(D(), image.row(y) + x); }
HWY_INLINE V3 pixels3(const FloatImage& image, int x, int y) { return load(image.row(y) + x, image.plane_stride); }

HWY_INLINE V3 zero3() { return {zero(), zero(), zero()}; }
HWY_INLINE V3 keep(Mask mask, V3 v) {
  return {hn::IfThenElseZero(mask, v.x), hn::IfThenElseZero(mask, v.y), hn::IfThenElseZero(mask, v.z)};
}
HWY_INLINE Mask is_finite(V v) { return hn::Eq(hn::Mul(v, zero()), zero()); }
HWY_INLINE Mask is_finite(V3 v) { return hn::Eq(dot(v, zero3()), zero()); }
HWY_INLINE Mask is_surface(V3 normal) { return hn::And(is_finite(normal), hn::Gt(dot(normal, normal), zero())); }

// Schied et al. 2017, equations 3 to 5.
template <bool kWideNormals, bool kScalarGradient>
struct SvgfStops {
  static constexpr int kDepth = 3, kNormal = 4, kVariance = 7, kCarrier = 8, kPlanes = 9;  // the carrier is the luminance
  static constexpr float outside(int plane) { return plane == kCarrier ? kFar : plane == kDepth ? kNoSurface : 0; }

  const Images& in;
  const Settings& s;

  // Stores what a tap at the pixels from x on is made of, besides its color.
  HWY_INLINE void gather(Mask counts, V3 color, int x, int y, float* to) const {
    const V3 normal = in.normal ? pixels3(in.normal, x, y) : V3{zero(), zero(), set(1.0F)};
    if (in.normal) counts = hn::And(counts, is_surface(normal));
    const V depth = in.depth ? pixels(in.depth, x, y) : zero();
    counts = hn::And(counts, hn::Lt(hn::Abs(depth), set(kNoSurface)));
    const V variance = in.variance ? pixels(in.variance, x, y) : zero();
    counts = hn::And(counts, is_finite(variance));
    put(keep(counts, color), to, 0);
    put(hn::IfThenElse(counts, depth, set(kNoSurface)), to, kDepth);
    put(keep(counts, normal), to, kNormal);
    put(hn::IfThenElseZero(counts, variance), to, kVariance);
    put(hn::IfThenElse(counts, luminance(color), set(kFar)), to, kCarrier);
  }

  // What is the same for all taps of a pixel.
  struct Pixel {
    V luminance, luminance_gain, depth, slope_x, slope_y, eps;
    V3 minus_normal;
  };

  // `deviation_variance` is what the luminance's deviation comes from.
  HWY_INLINE Pixel pixel(const float* center, const float* blurred, int x, int y) const {
    Pixel p;
    p.luminance = at(center, kCarrier);
    p.luminance_gain = luminance_gain(blurred);
    p.depth = at(center, kDepth);
    p.minus_normal = sub(zero3(), at3(center, kNormal));
    p.eps = hn::Max(hn::Mul(hn::Abs(p.depth), set(s.depth_eps)), set(1e-15F));
    if constexpr (kScalarGradient) {
      p.slope_x = p.slope_y = hn::Mul(hn::Abs(pixels(in.depth_gradient, x, y)), set(s.slope_factor));
    } else {
      p.slope_x = hn::Mul(difference(p.depth, at(center - 1, kDepth), at(center + 1, kDepth)), set(s.slope_factor));
      p.slope_y = hn::Mul(difference(p.depth, depth_at(x, y - 1), depth_at(x, y + 1)), set(s.slope_factor));
    }
    return p;
  }

  // What a tap has in common with the one opposite to it: the gain of a difference in depth.
  template <int kDx, int kDy>
  HWY_INLINE V pair(const Pixel& p) const {
    if constexpr (kScalarGradient) {
      constexpr std::array<float, 9> kLengths{0, 1, 1.41421356F, 0, 2, 2.23606798F, 0, 0, 2.82842712F};
      return reciprocal(hn::MulAdd(p.slope_x, set(kLengths[kDx * kDx + kDy * kDy]), p.eps));
    } else {
      const V change = hn::MulAdd(p.slope_x, set(kDx), hn::Mul(p.slope_y, set(kDy)));
      return reciprocal(hn::Add(hn::Abs(change), p.eps));
    }
  }

  HWY_INLINE V exponent(const Pixel& p, V depth_gain, const float* tap, V e) const {
    e = hn::MulAdd(hn::Abs(hn::Sub(at(tap, kCarrier), p.luminance)), p.luminance_gain, e);
    e = hn::MulAdd(hn::Abs(hn::Sub(at(tap, kDepth), p.depth)), depth_gain, e);
    const V t = dot_add(p.minus_normal, at3(tap, kNormal), set(1.0F));  // 1 - n.n'
    if constexpr (kWideNormals)
      return hn::NegMulAdd(set(s.normal_power), hn::Log(D(), hn::Max(hn::Sub(set(1.0F), t), set(1e-37F))), e);
    else
      return hn::Add(minus_log_narrow(t, set(s.normal_power)), e);
  }

 private:
  HWY_INLINE V depth_at(int x, int y) const {
    return in.depth && y >= 0 && y < in.depth.height ? pixels(in.depth, x, y) : set(kNoSurface);
  }
  // The smaller of the differences to both sides; neighbors without surface have none.
  static HWY_INLINE V difference(V middle, V before, V after) {
    const V none = set(kNoSurface);
    V back = hn::Sub(middle, before), ahead = hn::Sub(after, middle);
    back = hn::IfThenElse(hn::Lt(hn::Abs(before), none), back, none);
    ahead = hn::IfThenElse(hn::Lt(hn::Abs(after), none), ahead, none);
    const V smaller = hn::IfThenElse(hn::Lt(hn::Abs(ahead), hn::Abs(back)), ahead, back);
    return hn::IfThenElseZero(hn::Lt(hn::Abs(smaller), none), smaller);
  }
  HWY_INLINE V luminance_gain(const float* variance) const {
    if (!variance) return set(kNoGain);
    const V deviation = hn::Sqrt(hn::Max(hn::LoadU(D(), variance), zero()));
    return hn::Max(hn::Div(set(1.0F), hn::MulAdd(deviation, set(s.luminance_factor), set(1e-8F * kLn2))), set(kNoGain));
  }
};

// Dammertz et al. 2010, and the terms of the joint bilateral filter.
template <Stops kStops, bool kWideNormals>
struct GuidedStops {
  static constexpr int kNormal = 3, kPosition = 6, kVariance = 9, kCarrier = 0, kPlanes = 10;  // the carrier is red
  static constexpr float outside(int plane) { return plane == kCarrier ? kFar : 0; }

  const Images& in;
  const Settings& s;

  HWY_INLINE void gather(Mask counts, V3 color, int x, int y, float* to) const {
    const V3 normal = in.normal ? pixels3(in.normal, x, y) : zero3();
    if (in.normal) counts = hn::And(counts, is_surface(normal));
    const V3 position = in.position ? pixels3(in.position, x, y) : zero3();
    const V variance = in.variance ? pixels(in.variance, x, y) : zero();
    counts = hn::And(counts, hn::And(is_finite(position), is_finite(variance)));
    put(keep(counts, color), to, 0);
    put(hn::IfThenElse(counts, color.x, set(kFar)), to, kCarrier);
    put(keep(counts, normal), to, kNormal);
    put(keep(counts, position), to, kPosition);
    put(hn::IfThenElseZero(counts, variance), to, kVariance);
  }

  struct Pixel {
    V3 color, normal, position, plane;
  };
  HWY_INLINE Pixel pixel(const float* center, const float*, int, int) const {
    const V3 normal = at3(center, kNormal);
    return {at3(center, 0), normal, at3(center, kPosition), mul(set(s.plane_factor), normal)};
  }
  struct Nothing {};
  template <int kDx, int kDy>
  HWY_INLINE Nothing pair(const Pixel&) const {
    return {};
  }

  HWY_INLINE V exponent(const Pixel& p, Nothing, const float* tap, V e) const {
    const V3 contrast = sub(at3(tap, 0), p.color), turn = sub(at3(tap, kNormal), p.normal);
    const V3 way = sub(at3(tap, kPosition), p.position);
    const V chord = dot(turn, turn), squared_distance = dot_add(way, way, set(kTiny));
    V sum = dot(contrast, contrast);
    if constexpr (kStops == Stops::dammertz) {
      sum = hn::MulAdd(chord, set(s.normal_factor), hn::MulAdd(squared_distance, set(s.position_factor), sum));
    } else {
      const V height = dot(way, p.plane);
      sum = hn::Add(sum, hn::Div(hn::Mul(height, height), squared_distance));
      if constexpr (kWideNormals)
        sum = hn::MulAdd(squared_angle_wide(chord), set(s.normal_factor), sum);
      else
        sum = hn::MulAdd(angle_ratio_narrow(chord, set(s.normal_factor)), chord, sum);
    }
    return hn::MulAdd(sum, set(s.gain), e);
  }
};

}  // namespace quell::atrous::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
