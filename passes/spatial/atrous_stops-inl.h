// What stops the à-trous filter at an edge: for each kind of stops what a row in scratch memory holds, in planes, and the
// exponent of a tap's weight. Included once for every vector unit.
#if defined(QUELL_ATROUS_STOPS) == defined(HWY_TARGET_TOGGLE)
#ifdef QUELL_ATROUS_STOPS
#undef QUELL_ATROUS_STOPS
#else
#define QUELL_ATROUS_STOPS
#endif

#include <hwy/contrib/math/math-inl.h>

#include <algorithm>

#include "passes/spatial/atrous_kernel.h"
#include "quell/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace quell::atrous::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

constexpr float kFar = 1e18F;    // in the carrier: a tap that does not count; its square is still finite
constexpr float kTiny = 1e-36F;  // added to squared distances, which are then never 0
constexpr float kNoSurface = QUELL_NO_SURFACE_DEPTH;
constexpr float kSteepest = 1e20F;            // that a slope counts for: times a factor it is still finite
constexpr float kNoGain = 1e-15F;             // with it luminances do not matter, but kFar does
constexpr float kSmallestTolerance = 1e-15F;  // so that no difference is divided by 0

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
// Where the square of a distance is still finite.
HWY_INLINE Mask is_near(V3 v) { return hn::Lt(hn::Max(hn::Max(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z)), set(kFar)); }
HWY_INLINE Mask is_surface(V3 normal) { return hn::And(is_finite(normal), hn::Gt(dot(normal, normal), zero())); }

// Schied et al. 2017, equations 3 to 5.
template <bool kWideNormals, bool kScalarGradient>
struct SvgfStops {
  static constexpr int kDepth = 3, kNormal = 4, kVariance = 7, kCarrier = 8, kPlanes = 9;  // the carrier is the luminance
  static constexpr float outside(int plane) { return plane == kCarrier ? kFar : plane == kDepth ? kNoSurface : 0; }

  const Images& in;
  const Settings& s;

  // Stores what taps at the pixels from x on are made of.
  HWY_INLINE void gather(Mask counts, V3 color, int x, int y, float* to) const {
    const V3 normal = in.normal ? pixels3(in.normal, x, y) : V3{zero(), zero(), set(1.0F)};
    if (in.normal) counts = hn::And(counts, is_surface(normal));
    const V depth = in.depth ? pixels(in.depth, x, y) : zero();
    const Mask has_depth = hn::Lt(hn::Abs(depth), set(kNoSurface));
    counts = hn::And(counts, has_depth);
    const V variance = in.variance ? pixels(in.variance, x, y) : zero();
    counts = hn::And(counts, is_finite(variance));
    put(keep(counts, color), to, 0);
    put(hn::IfThenElse(has_depth, depth, set(kNoSurface)), to, kDepth);  // of taps that do not count, too: slopes need it
    put(keep(counts, normal), to, kNormal);
    put(hn::IfThenElseZero(counts, variance), to, kVariance);
    put(hn::IfThenElse(counts, luminance(color), set(kFar)), to, kCarrier);
  }

  // Computes what pixel() needs of the pixels [left, right) of row y, which is gathered at `center`. Beforehand, since a root and
  // a quotient that the first tap waited for would hold up the others.
  void prepare(const float* center, int left, int right, int y, float* to) const {
    if (in.variance && !in.blurred_variance) blur_columns(left, right, y, to + kColumns * kStride);
    for (int x = left; x < right; x += lanes(), center += lanes(), to += lanes()) {
      put(luminance_gain(to + kColumns * kStride, x, y), to, kGain);
      if constexpr (kScalarGradient) {
        const V slope = hn::Min(hn::Abs(pixels(in.depth_gradient, x, y)), set(kSteepest));
        put(hn::Mul(slope, set(s.slope_factor)), to, kSlope);
      } else {
        const V depth = at(center, kDepth);
        put(slope(depth, at(center - 1, kDepth), at(center + 1, kDepth)), to, kSlope);
        put(slope(depth, depth_at(x, y - 1), depth_at(x, y + 1)), to, kSlope + 1);
      }
    }
  }

  // What is the same for all taps of a pixel.
  struct Pixel {
    V luminance, luminance_gain, depth, eps, slope_x, slope_y;
    V3 minus_normal;
  };
  HWY_INLINE Pixel pixel(const float* center, const float* prepared) const {
    const V depth = at(center, kDepth);
    const V eps = hn::Max(hn::Mul(hn::Abs(depth), set(s.depth_eps)), set(kSmallestTolerance));
    return {at(center, kCarrier),
            at(prepared, kGain),
            depth,
            eps,
            at(prepared, kSlope),
            at(prepared, kSlope + 1),
            sub(zero3(), at3(center, kNormal))};
  }

  // What a tap has in common with the one opposite to it: the gain of a difference in depth.
  HWY_INLINE V pair(const Pixel& p, std::size_t i) const {
    if constexpr (kScalarGradient) {
      return reciprocal(hn::MulAdd(p.slope_x, set(kPairs[i].length), p.eps));
    } else {
      // Differences of depths are mostly exact, so that what cancels here is, too; only then the factor.
      const V change = hn::MulAdd(p.slope_x, set(kPairs[i].dx), hn::Mul(p.slope_y, set(kPairs[i].dy)));
      return reciprocal(hn::MulAdd(hn::Abs(change), set(s.slope_factor), p.eps));
    }
  }

  HWY_INLINE V exponent(const Pixel& p, V depth_gain, const float* tap, std::size_t i) const {
    V x = set(s.offset_exponents[i]);
    x = hn::NegMulAdd(hn::Abs(hn::Sub(at(tap, kCarrier), p.luminance)), p.luminance_gain, x);
    x = hn::NegMulAdd(hn::Abs(hn::Sub(at(tap, kDepth), p.depth)), depth_gain, x);
    const V t = dot_add(p.minus_normal, at3(tap, kNormal), set(1.0F));  // 1 - n.n'
    if constexpr (kWideNormals)
      return hn::MulAdd(set(s.normal_power), hn::Log(D(), hn::Max(hn::Sub(set(1.0F), t), set(1e-37F))), x);
    else
      return add_log_narrow(t, set(-s.normal_power), x);
  }

 private:
  static constexpr int kGain = 0, kSlope = 1, kColumns = 3;  // what is prepared

  HWY_INLINE V depth_at(int x, int y) const {
    return in.depth && y >= 0 && y < in.depth.height ? pixels(in.depth, x, y) : set(kNoSurface);
  }
  // Of the smaller of the differences to both sides; neighbors without surface have none.
  HWY_INLINE V slope(V middle, V before, V after) const {
    const V none = set(kNoSurface);
    const V back = hn::IfThenElse(hn::Lt(hn::Abs(before), none), hn::Sub(middle, before), none);
    const V ahead = hn::IfThenElse(hn::Lt(hn::Abs(after), none), hn::Sub(after, middle), none);
    const V smaller = hn::IfThenElse(hn::Lt(hn::Abs(ahead), hn::Abs(back)), ahead, back);
    return hn::IfThenElseZero(hn::Lt(hn::Abs(smaller), none), smaller);
  }

  // The variance is blurred by 1/4, 1/2, 1/4 down the columns, and then along the row. A neighbor outside of the image is made up
  // so that the mean is that of those inside.
  static HWY_INLINE V made_up(V border, V inner) { return hn::MulAdd(border, set(2.0F / 3), hn::Mul(inner, set(1.0F / 3))); }
  static HWY_INLINE V blur(V before, V middle, V after) {
    return hn::MulAdd(middle, set(0.5F), hn::Mul(hn::Add(before, after), set(0.25F)));
  }
  // Pixels [left - 1, right] of row y; left is at `to`.
  void blur_columns(int left, int right, int y, float* to) const {
    const FloatImage& image = in.variance;
    const bool above = y > 0, below = y + 1 < image.height;
    for (int x = std::max(0, left - 1); x < std::min(image.width, right + 1); x += lanes()) {
      const V middle = pixels(image, x, y);
      const V up = above ? pixels(image, x, y - 1) : middle, down = below ? pixels(image, x, y + 1) : middle;
      hn::StoreU(blur(above ? up : made_up(middle, down), middle, below ? down : made_up(middle, up)), D(), to + (x - left));
    }
    const int last = image.width - 1 - left;
    const auto make_up = [to](int border, int inner) { return (2 * to[border] + to[inner]) / 3; };
    if (left == 0) to[-1] = make_up(0, std::min(1, last));
    if (right == image.width) to[last + 1] = make_up(last, image.width > 1 ? last - 1 : last);
  }
  HWY_INLINE V luminance_gain(const float* columns, int x, int y) const {
    if (!in.variance && !in.blurred_variance) return set(kNoGain);
    const V variance = in.blurred_variance
                           ? pixels(in.blurred_variance, x, y)
                           : blur(hn::LoadU(D(), columns - 1), hn::LoadU(D(), columns), hn::LoadU(D(), columns + 1));
    const V deviation = hn::Sqrt(hn::Max(hn::Add(variance, set(s.variance_eps)), zero()));
    const V tolerated = hn::Max(hn::MulAdd(deviation, set(s.luminance_factor), set(s.luminance_eps)), set(kSmallestTolerance));
    return hn::Max(hn::Div(set(1.0F), tolerated), set(kNoGain));
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
    counts = hn::And(counts, hn::And(hn::And(is_finite(position), is_near(position)), is_finite(variance)));
    put(keep(counts, color), to, 0);
    put(hn::IfThenElse(counts, color.x, set(kFar)), to, kCarrier);
    put(keep(counts, normal), to, kNormal);
    put(keep(counts, position), to, kPosition);
    put(hn::IfThenElseZero(counts, variance), to, kVariance);
  }

  void prepare(const float*, int, int, int, float*) const {}

  struct Pixel {
    V3 color, normal, position, plane;
  };
  HWY_INLINE Pixel pixel(const float* center, const float*) const {
    const V3 normal = at3(center, kNormal);
    return {at3(center, 0), normal, at3(center, kPosition), mul(set(s.plane_factor), normal)};
  }
  struct Nothing {};
  HWY_INLINE Nothing pair(const Pixel&, std::size_t) const { return {}; }

  HWY_INLINE V exponent(const Pixel& p, Nothing, const float* tap, std::size_t i) const {
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
    return hn::NegMulAdd(sum, set(s.gain), set(s.offset_exponents[i]));
  }
};

}  // namespace quell::atrous::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
