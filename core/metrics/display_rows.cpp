// Error of a power x^p with x in 0..1 and p in 1/2.4..2.4, absolute: 9e-8 from 2^x, 3e-8 from log2, and the roundings of the
// exponent, x^p |log2 x^p| 6e-8 each; 4e-7 in all. The sRGB curve multiplies by 1.055. Seen over all of float: 2.8e-7.
#include "quell/metrics/display_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/metrics/display_rows.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include "quell/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace quell::detail::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

// log2 x for normal x > 0, relative error 7e-9 besides roundings: the exponent, and 2/ln 2 atanh(s), s = (m-1)/(m+1), for the
// mantissa m in [sqrt(1/2), sqrt 2). Own minimax fit.
HWY_INLINE V log2(V x) {
  const D d;
  const hn::RebindToSigned<D> di;
  const auto bits = hn::BitCast(di, x);
  const auto above = hn::Sub(bits, hn::Set(di, 0x3f3504f3));  // bits of sqrt(1/2)
  const auto exponent = hn::ShiftRight<23>(above);
  const V m = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
  const V s = hn::Div(hn::Sub(m, set(1.0F)), hn::Add(m, set(1.0F))), s2 = hn::Mul(s, s);
  V p = set(4.557595917e-1F);
  p = hn::MulAdd(p, s2, set(5.756726063e-1F));
  p = hn::MulAdd(p, s2, set(9.618100144e-1F));
  p = hn::MulAdd(p, s2, set(2.885390062F));
  return hn::MulAdd(p, s, hn::ConvertTo(d, exponent));
}

// 2^e for e in -126..0, relative error 9.2e-8 besides roundings. Own minimax fit of 2^f on [-1/2, 1/2], the constant 1 held.
HWY_INLINE V exp2(V e) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const V round = set(0x1.8p23F + 127.0F);  // the last bits of a sum with it are the rounded integer, biased as an exponent
  const V n = hn::Add(e, round);
  const V f = hn::Sub(e, hn::Sub(n, round));
  V p = set(1.326472712e-3F);
  p = hn::MulAdd(p, f, set(9.671512645e-3F));
  p = hn::MulAdd(p, f, set(5.550733743e-2F));
  p = hn::MulAdd(p, f, set(2.402224209e-1F));
  p = hn::MulAdd(p, f, set(6.931469776e-1F));
  p = hn::MulAdd(p, f, set(1.0F));
  return hn::Mul(p, hn::BitCast(d, hn::ShiftLeft<23>(hn::BitCast(du, n))));
}

// x^power for x in 0..1, 0 where x is below 1e-37, whose powers do not show.
HWY_INLINE V power(V x, float power) {
  const V tiny = set(1e-37F);
  const V e = hn::Max(hn::Mul(log2(hn::Max(x, tiny)), set(power)), set(-126.0F));
  return hn::IfThenElseZero(hn::Gt(x, tiny), exp2(e));
}

HWY_INLINE V clamp(V x) { return hn::Min(hn::Max(x, zero()), set(1.0F)); }

HWY_INLINE V encode_srgb(V light) {
  const V curve = hn::MulSub(set(1.055F), power(light, 1 / 2.4F), set(0.055F));
  return hn::IfThenElse(hn::Le(light, set(0.0031308F)), hn::Mul(set(12.92F), light), curve);
}

template <DisplayTransform kTransform>
HWY_INLINE V to_display(V x) {
  if constexpr (kTransform == DisplayTransform::reinhard) {
    x = hn::Max(x, zero());
    return power(hn::Div(x, hn::Add(x, set(1.0F))), 1 / 2.2F);
  }
  if constexpr (kTransform == DisplayTransform::gamma) return power(clamp(x), 1 / 2.2F);
  if constexpr (kTransform == DisplayTransform::srgb) return encode_srgb(clamp(x));
  if constexpr (kTransform == DisplayTransform::aces) {
    x = hn::Min(hn::Max(x, zero()), set(10.0F));  // where the curve is above 1, as it is from 7.3 on
    const V above = hn::Mul(x, hn::MulAdd(set(2.51F), x, set(0.03F)));
    const V below = hn::MulAdd(x, hn::MulAdd(set(2.43F), x, set(0.59F)), set(0.14F));
    return encode_srgb(clamp(hn::Div(above, below)));
  }
  return clamp(x);
}

HWY_INLINE V to_light(V display) {
  const V curve = power(hn::Mul(hn::Add(display, set(0.055F)), set(1 / 1.055F)), 2.4F);
  return hn::IfThenElse(hn::Le(display, set(0.04045F)), hn::Mul(display, set(1 / 12.92F)), curve);
}

template <class Function>
HWY_INLINE void map_row(FloatImage from, int y, FloatOutput to, const Function& function) {
  const D d;
  for (int c = 0; c < 3; ++c)
    for (int x = 0; x < from.width; x += lanes()) hn::Store(function(hn::Load(d, from.row(y, c) + x)), d, to.row(y, c) + x);
}

template <DisplayTransform kTransform>
void map_to_display(FloatImage radiance, int y, FloatOutput display) {
  map_row(radiance, y, display, [](V x) { return to_display<kTransform>(x); });
}

void DisplayRow(DisplayTransform transform, FloatImage radiance, int y, FloatOutput display) {
  switch (transform) {
    case DisplayTransform::reinhard:
      return map_to_display<DisplayTransform::reinhard>(radiance, y, display);
    case DisplayTransform::gamma:
      return map_to_display<DisplayTransform::gamma>(radiance, y, display);
    case DisplayTransform::srgb:
      return map_to_display<DisplayTransform::srgb>(radiance, y, display);
    case DisplayTransform::aces:
      return map_to_display<DisplayTransform::aces>(radiance, y, display);
    case DisplayTransform::none:
      return map_to_display<DisplayTransform::none>(radiance, y, display);
  }
}

void LightRow(FloatImage display, int y, FloatOutput light) {
  map_row(display, y, light, [](V x) { return to_light(x); });
}

using Mask = hn::Mask<D>;

HWY_INLINE Mask is_finite(V3 v) { return hn::Eq(dot(v, {zero(), zero(), zero()}), zero()); }

HWY_INLINE void put(Mask counts, V3 v, int x, int y, FloatOutput to) {
  const D d;
  hn::Store(hn::IfThenElseZero(counts, v.x), d, to.row(y, 0) + x);
  hn::Store(hn::IfThenElseZero(counts, v.y), d, to.row(y, 1) + x);
  hn::Store(hn::IfThenElseZero(counts, v.z), d, to.row(y, 2) + x);
}

BadPixels CleanRow(FloatImage reference, FloatImage image, int y, FloatOutput clean_reference, FloatOutput clean_image,
                   FloatOutput counts) {
  const D d;
  BadPixels bad;
  for (int x = 0; x < reference.width; x += lanes()) {
    const V3 r = load(reference.row(y) + x, reference.plane_stride), a = load(image.row(y) + x, image.plane_stride);
    const Mask inside = hn::FirstN(d, static_cast<std::size_t>(reference.width - x));
    const Mask good_r = is_finite(r), good_a = is_finite(a), good = hn::And(inside, hn::And(good_r, good_a));
    bad.in_reference += hn::CountTrue(d, hn::AndNot(good_r, inside));
    bad.in_image += hn::CountTrue(d, hn::AndNot(good_a, inside));
    bad.in_either += hn::CountTrue(d, hn::AndNot(good, inside));
    put(good, r, x, y, clean_reference);
    put(good, a, x, y, clean_image);
    hn::Store(hn::IfThenElseZero(good, set(1.0F)), d, counts.row(y) + x);
  }
  return bad;
}

}  // namespace quell::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::detail {

HWY_EXPORT(CleanRow);
HWY_EXPORT(DisplayRow);
HWY_EXPORT(LightRow);

BadPixels clean_row(FloatImage reference, FloatImage image, int y, FloatOutput clean_reference, FloatOutput clean_image,
                    FloatOutput counts) {
  return HWY_DYNAMIC_DISPATCH(CleanRow)(reference, image, y, clean_reference, clean_image, counts);
}
void display_row(DisplayTransform transform, FloatImage radiance, int y, FloatOutput display) {
  HWY_DYNAMIC_DISPATCH(DisplayRow)(transform, radiance, y, display);
}
void light_row(FloatImage display, int y, FloatOutput light) { HWY_DYNAMIC_DISPATCH(LightRow)(display, y, light); }

}  // namespace quell::detail
#endif
