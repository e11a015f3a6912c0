// The functions of FLIP's formulas on vectors. Included once for every vector unit. Errors are those of the polynomials, to which
// a few roundings of float (6e-8 each) come. Coefficients: own Remez fits. All of it breaks under -ffast-math.
#if defined(QUELL_METRICS_FLIP_MATH) == defined(HWY_TARGET_TOGGLE)
#ifdef QUELL_METRICS_FLIP_MATH
#undef QUELL_METRICS_FLIP_MATH
#else
#define QUELL_METRICS_FLIP_MATH
#endif

#include "quell/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace quell::flip_math::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

// The cube root of t, 0.0088 <= t <= 1; relative error 8.4e-9.
HWY_INLINE V cube_root(V t) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const hn::RebindToSigned<D> di;
  // t^(-1/3) to within 3.5 %: the bits of a float are about its logarithm. The last bits of a sum with 0x1.8p23 are the rounded
  // integer, here in units of 2^12, for which the exponent and 11 bits of the mantissa have room.
  const V log_t = hn::ConvertTo(d, hn::BitCast(di, t));
  const V guess = hn::NegMulAdd(log_t, set(0x1p-12F / 3), set(0x1.8p23F + 0x54a23));
  const V r = hn::BitCast(d, hn::ShiftLeft<12>(hn::BitCast(du, guess)));
  const V u = hn::NegMulAdd(hn::Mul(t, r), hn::Mul(r, r), set(1.0F));  // t^(-1/3) = r (1 - u)^(-1/3)
  V p = set(1.244669432e-1F);
  p = hn::MulAdd(p, u, set(1.457983536e-1F));
  p = hn::MulAdd(p, u, set(1.728530799e-1F));
  p = hn::MulAdd(p, u, set(2.222152165e-1F));
  p = hn::MulAdd(p, u, set(3.333333003e-1F));
  p = hn::MulAdd(p, u, set(1.000000004F));
  const V root = hn::Mul(p, r);
  return hn::Mul(hn::Mul(t, root), root);
}

// log2 of t > 0 and normal; absolute error 3.0e-7, and a rounding of the result. The fit is of log2(1 + z) / z for 1 + z within
// sqrt(1/2)..sqrt(2).
HWY_INLINE V log2_of(V t) {
  const D d;
  const hn::RebindToSigned<D> di;
  const auto bits = hn::BitCast(di, t);
  const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3f3504f3)));
  const V z = hn::Sub(hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(exponent))), set(1.0F));
  V p = set(1.706345032e-1F);
  p = hn::MulAdd(p, z, set(-2.726979261e-1F));
  p = hn::MulAdd(p, z, set(2.972625868e-1F));
  p = hn::MulAdd(p, z, set(-3.589618507e-1F));
  p = hn::MulAdd(p, z, set(4.804650337e-1F));
  p = hn::MulAdd(p, z, set(-7.213758714e-1F));
  p = hn::MulAdd(p, z, set(1.442699726F));
  return hn::MulAdd(p, z, hn::ConvertTo(d, exponent));
}

// log2(1 - x), 0 <= x <= 0.05; relative error 1.1e-6.
HWY_INLINE V log2_of_nearly_1(V x) {
  V p = set(-5.092578785e-1F);
  p = hn::MulAdd(p, x, set(-7.208077158e-1F));
  p = hn::MulAdd(p, x, set(-1.442696550F));
  return hn::Mul(p, x);
}

// 2^x, x < 127; relative error 9.2e-8, exactly 1 at 0, exactly 0 below -126.5. The fit is of 2^f on [-1/2, 1/2], the constant 1
// held.
HWY_INLINE V exp2_of(V x) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const V round = set(0x1.8p23F + 127.0F);  // the last bits of a sum with it are the rounded integer, biased as an exponent
  x = hn::Max(x, set(-127.0F));
  const V n = hn::Add(x, round);
  const V f = hn::Sub(x, hn::Sub(n, round));
  V p = set(1.326472720e-3F);
  p = hn::MulAdd(p, f, set(9.671512640e-3F));
  p = hn::MulAdd(p, f, set(5.550733743e-2F));
  p = hn::MulAdd(p, f, set(2.402224209e-1F));
  p = hn::MulAdd(p, f, set(6.931469776e-1F));
  p = hn::MulAdd(p, f, set(1.0F));
  return hn::Mul(p, hn::BitCast(d, hn::ShiftLeft<23>(hn::BitCast(du, n))));
}

}  // namespace quell::flip_math::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
