// Vectors of pixels, and the functions that weights are made of, for kernels on Highway. Included once for every vector unit,
// after hwy/foreach_target.h; passes/README.md shows a kernel.
//
// Error bounds are relative and hold on every vector unit, roundings of float (6e-8 each) included; tests/core/simd compares each
// with double precision over its whole domain. Coefficients are own fits: a minimax polynomial of the degree that is seen, on the
// interval and with the weight that stand beside it, by Remez exchange in double precision. All of it breaks under -ffast-math.
#if defined(QUELL_SIMD_VECTORS) == defined(HWY_TARGET_TOGGLE)
#ifdef QUELL_SIMD_VECTORS
#undef QUELL_SIMD_VECTORS
#else
#define QUELL_SIMD_VECTORS
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace quell::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kMaxLanes = 16;  // so that a whole vector may be loaded past the end of a row
using D = hn::CappedTag<float, kMaxLanes>;
using V = hn::Vec<D>;

struct V3 {
  V x, y, z;
};

HWY_INLINE V set(float value) { return hn::Set(D(), value); }
HWY_INLINE V zero() { return hn::Zero(D()); }
HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(D())); }

// Three planes of pixels from `first` on.
HWY_INLINE V3 load(const float* first, std::ptrdiff_t plane_stride) {
  const D d;
  return {hn::LoadU(d, first), hn::LoadU(d, first + plane_stride), hn::LoadU(d, first + 2 * plane_stride)};
}
// Stores the first `count` lanes, or all when there are fewer; what lies behind them stays untouched.
HWY_INLINE void store(V v, int count, float* to) {
  const D d;
  if (count >= lanes()) return hn::StoreU(v, d, to);
  HWY_ALIGN float buffer[kMaxLanes];
  hn::Store(v, d, buffer);
  std::copy_n(buffer, count, to);
}

// Three planes likewise.
HWY_INLINE void store(V3 v, int count, float* first, std::ptrdiff_t plane_stride) {
  store(v.x, count, first), store(v.y, count, first + plane_stride), store(v.z, count, first + 2 * plane_stride);
}

// Offsets [first, last] of the taps of a window around `center` that lie in an image of that size.
struct TapRange {
  int first, last;
};
HWY_INLINE TapRange clamped_taps(int center, int radius, int size) {
  return {std::max(-radius, -center), std::min(radius, size - 1 - center)};
}

HWY_INLINE V3 add(V3 a, V3 b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)}; }
HWY_INLINE V3 sub(V3 a, V3 b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }
HWY_INLINE V3 mul(V a, V3 b) { return {hn::Mul(a, b.x), hn::Mul(a, b.y), hn::Mul(a, b.z)}; }
HWY_INLINE V3 mul_add(V a, V3 b, V3 c) { return {hn::MulAdd(a, b.x, c.x), hn::MulAdd(a, b.y, c.y), hn::MulAdd(a, b.z, c.z)}; }
HWY_INLINE V3 if_then_else(hn::Mask<D> mask, V3 yes, V3 no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}
HWY_INLINE V dot(V3 a, V3 b) { return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x))); }
HWY_INLINE V dot_add(V3 a, V3 b, V c) { return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::MulAdd(a.x, b.x, c))); }

// exp2(x) is 2^x for x <= 0, -infinity but not NaN included: error 3.8e-6, exactly 1 at 0; below -126.5, where floats lose their
// precision, it is at most 2^-126, and exactly 0 from -150 on. exp2_negative(e, gain, limit) is 2^-(gain e) likewise, for e >= 0;
// `limit` is 127 / gain. To its error comes that of a rounded product, 6e-8 gain e.
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
// 2^x = 2^f 2^floor(x), where the unit yields f and applies the floor in one operation each. The fit is of 2^f on [0, 1],
// relative, the constant 1 held.
HWY_INLINE V exp2(V x) {
  constexpr int kFromFloor = 0x09;
  const V f{_mm512_reduce_ps(x.raw, kFromFloor)};
  V p = set(1.342668427e-2F);
  p = hn::MulAdd(p, f, set(5.224247422e-2F));
  p = hn::MulAdd(p, f, set(2.412802048e-1F));
  p = hn::MulAdd(p, f, set(6.930448449e-1F));
  p = hn::MulAdd(p, f, set(1.0F));
  return V{_mm512_scalef_ps(p.raw, x.raw)};
}
HWY_INLINE V exp2_negative(V e, V gain, V) { return exp2(hn::Mul(e, hn::Neg(gain))); }
#else
// In 2^x = 2^(f - n) with the nearest integer n, the fit is of 2^f on [-1/2, 1/2], relative, the constant 1 held. `biased` is n
// as the last bits of a float: adding to kExponentRound rounds, and biases as an exponent is biased.
constexpr float kExponentRound = 0x1.8p23F + 127.0F;
HWY_INLINE V exp2_parts(V f, V biased) {
  const D d;
  V p = set(9.782912553e-3F);
  p = hn::MulAdd(p, f, set(5.597688363e-2F));
  p = hn::MulAdd(p, f, set(2.402071108e-1F));
  p = hn::MulAdd(p, f, set(6.931136044e-1F));
  p = hn::MulAdd(p, f, set(1.0F));
  return hn::Mul(p, hn::BitCast(d, hn::ShiftLeft<23>(hn::BitCast(hn::RebindToUnsigned<D>(), biased))));
}
HWY_INLINE V exp2(V x) {
  x = hn::Max(x, set(-127.0F));
  const V biased = hn::Add(x, set(kExponentRound));
  return exp2_parts(hn::Sub(x, hn::Sub(biased, set(kExponentRound))), biased);
}
HWY_INLINE V exp2_negative(V e, V gain, V limit) {
  e = hn::Min(e, limit);
  const V biased = hn::NegMulAdd(gain, e, set(kExponentRound));
  return exp2_parts(hn::NegMulAdd(gain, e, hn::Sub(set(kExponentRound), biased)), biased);
}
#endif

// Of a linear color with BT.709 primaries; error 3e-7 for components that are at least 0.
HWY_INLINE V luminance(V3 color) { return dot(color, {set(0.2126F), set(0.7152F), set(0.0722F)}); }

// 1 / x for 1e-37 <= |x| <= 1e37, for a Newton step to go on from; error below 2^-11. That of Arm, 2^-8, has a step behind it.
HWY_INLINE V estimate_reciprocal(V x) {
  V r = hn::ApproximateReciprocal(x);
#if HWY_ARCH_ARM
  r = hn::MulAdd(r, hn::NegMulAdd(r, x, set(1.0F)), r);
#endif
  return r;
}
// 1 / x in that range; error 4e-7: a Newton step squares that of the estimate. Against a division: the same speed on 8 lanes, the
// faster the more there are.
HWY_INLINE V reciprocal(V x) {
  const V r = estimate_reciprocal(x);
  return hn::MulAdd(r, hn::NegMulAdd(r, x, set(1.0F)), r);
}

// max(x, 0)^128, by squaring seven times; error 8e-6 where the result is above 1e-30; what is smaller stays so.
HWY_INLINE V pow128(V x) {
  x = hn::Max(x, zero());
  for (int i = 0; i < 7; ++i) x = hn::Mul(x, x);
  return x;
}

// e - factor ln(1 - t), so that 2^-it is a power of 1 - t = n.n'. With e = 0 and factor = k log2(e) for a k of 64 and more, that
// power, (1 - t)^k, is within 1.5e-6 absolutely for t in [0, 2], where it counts as 0 from t = 1 on; roundings of t come to it
// k-fold. The fit is of (1 - t)^64, absolute, the linear coefficient 1 held.
HWY_INLINE V add_log_narrow(V t, V factor, V e) {
  V p = hn::Mul(factor, set(3.463023e-1F));
  p = hn::MulAdd(p, t, hn::Mul(factor, set(0.5F)));
  p = hn::MulAdd(p, t, factor);
  return hn::MulAdd(p, t, e);
}

// The square of the angle between two normals is taken from chord = |n - n'|^2 = 2 - 2 n.n', which does not cancel where they are
// close: acos(n.n')^2 = chord (1 + chord / 12 + chord^2 / 90 + ...).

// factor acos(n.n')^2 / chord, for n.n' >= 1/2; error 4.3e-6 on chords up to 1. For longer ones it grows on.
HWY_INLINE V angle_ratio_narrow(V chord, V factor) {
  V p = hn::Mul(factor, set(2.643988578e-3F));
  p = hn::MulAdd(p, chord, hn::Mul(factor, set(1.052100582e-2F)));
  p = hn::MulAdd(p, chord, hn::Mul(factor, set(8.345733023e-2F)));
  return hn::MulAdd(p, chord, hn::Mul(factor, set(9.999959988e-1F)));
}

// acos(n.n')^2 for any n.n'; error 2.5e-6. The fit is for chords up to 2; acos(-x) = pi - acos(x) gives the others.
HWY_INLINE V squared_angle_wide(V chord) {
  const V opposite_chord = hn::Max(hn::Sub(set(4.0F), chord), zero());
  const V x = hn::Min(chord, opposite_chord);
  V p = set(2.677239314e-4F);
  p = hn::MulAdd(p, x, set(-2.997667832e-4F));
  p = hn::MulAdd(p, x, set(2.524761743e-3F));
  p = hn::MulAdd(p, x, set(1.073130883e-2F));
  p = hn::MulAdd(p, x, set(8.340292365e-2F));
  p = hn::MulAdd(p, x, set(9.999979619e-1F));
  p = hn::Mul(p, x);
  const V rest = hn::Sub(set(3.14159265F), hn::Sqrt(p));
  return hn::IfThenElse(hn::Gt(chord, opposite_chord), hn::Mul(rest, rest), p);
}

}  // namespace quell::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
