// A result is one of its taps plus the weighted differences of the others to it: the mean of equal values is that value, bit for
// bit.
#include "passes/pointwise/scale_kernel.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/pointwise/scale_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes them visible again for every vector unit.
#include <hwy/contrib/math/math-inl.h>

#include "quell/simd/vectors-inl.h"

#ifndef QUELL_SCALE_SHARED  // what is the same for all vector units
#define QUELL_SCALE_SHARED
namespace quell::scale {

constexpr float kSmallestDepth = 1e-30F;   // that differences are divided by
constexpr float kSmallestCosine = 1e-37F;  // its logarithm is still finite
constexpr float kFloor = 1e-6F;            // weight of guides that differ wholly

}  // namespace quell::scale
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::scale::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

using DI = hn::RebindToSigned<D>;
using VI = hn::Vec<DI>;

// The two pixels of the small image around those of the large one, along an axis, and how far from the first to the second.
struct Columns {
  VI first, second;
  V way;
};
HWY_INLINE Columns columns(int x, float factor, int width) {
  const D d;
  const DI di;
  const V at = hn::Sub(hn::Mul(hn::Add(hn::Iota(d, static_cast<float>(x)), set(0.5F)), set(factor)), set(0.5F));
  const V floor = hn::Floor(at);
  const VI first = hn::ConvertTo(di, floor);
  const auto clamp = [&](VI v) HWY_ATTR { return hn::Min(hn::Max(v, hn::Zero(di)), hn::Set(di, width - 1)); };
  return {clamp(first), clamp(hn::Add(first, hn::Set(di, 1))), hn::Sub(at, floor)};
}

struct Rows {
  int first, second;
  float way;
};
Rows rows(int y, float factor, int height) {
  const float at = (static_cast<float>(y) + 0.5F) * factor - 0.5F, floor = std::floor(at);
  const int first = static_cast<int>(floor);
  return {std::clamp(first, 0, height - 1), std::clamp(first + 1, 0, height - 1), at - floor};
}

HWY_INLINE V pick(const float* row, VI at) { return hn::GatherIndex(D(), row, at); }
HWY_INLINE V3 pick3(const FloatImage& image, int y, VI at) {
  return {pick(image.row(y, 0), at), pick(image.row(y, 1), at), pick(image.row(y, 2), at)};
}

// What the pixels of the large image from (x, y) on compare their taps with.
class Likeness {
 public:
  HWY_INLINE Likeness(const Guides& guides, const Settings& s, int x, int y)
      : guides_(guides), s_(s), depth_(zero()), per_depth_(zero()), normal_{zero(), zero(), zero()} {
    if (guides.full_depth) {
      depth_ = hn::LoadU(D(), guides.full_depth.row(y) + x);
      per_depth_ = hn::Div(set(s.inverse_sigma_z), hn::Max(hn::Abs(depth_), set(kSmallestDepth)));
    }
    if (guides.full_normal) normal_ = load(guides.full_normal.row(y) + x, guides.full_normal.plane_stride);
  }

  // 2^-e of the taps in that row and in those columns.
  HWY_INLINE V weight(int y, VI x) const {
    V e = zero();
    if (guides_.full_depth) e = hn::Mul(hn::Abs(hn::Sub(pick(guides_.depth.row(y), x), depth_)), per_depth_);
    if (guides_.full_normal) {
      // 1 - |n - n'|^2 / 2 is n.n' of unit normals, and 1 where both are 0.
      const V3 chord = sub(pick3(guides_.normal, y, x), normal_);
      const V cosine = hn::NegMulAdd(set(0.5F), dot(chord, chord), set(1.0F));
      e = hn::NegMulAdd(set(s_.normal_power), hn::Log(D(), hn::Max(cosine, set(kSmallestCosine))), e);
    }
    return hn::Add(exp2(hn::Neg(hn::Max(e, zero()))), set(kFloor));
  }

 private:
  const Guides& guides_;
  const Settings& s_;
  V depth_, per_depth_;
  V3 normal_;
};

void EnlargeRow(const FloatImage& small, const Guides& guides, const Settings& s, int y, const FloatOutput& large) {
  const Rows row = rows(y, s.factor_y, small.height);
  const V one = set(1.0F), below = set(row.way), above = set(1 - row.way);
  const bool is_guided = guides.full_depth || guides.full_normal;
  for (int x = 0; x < large.width; x += lanes()) {
    const Columns column = columns(x, s.factor_x, small.width);
    const V right = column.way, left = hn::Sub(one, column.way);
    V weights[4] = {hn::Mul(left, above), hn::Mul(right, above), hn::Mul(left, below), hn::Mul(right, below)};
    if (is_guided) {
      const Likeness likeness(guides, s, x, y);
      weights[0] = hn::Mul(weights[0], likeness.weight(row.first, column.first));
      weights[1] = hn::Mul(weights[1], likeness.weight(row.first, column.second));
      weights[2] = hn::Mul(weights[2], likeness.weight(row.second, column.first));
      weights[3] = hn::Mul(weights[3], likeness.weight(row.second, column.second));
    }
    const V scale = hn::Div(one, hn::Add(hn::Add(weights[0], weights[1]), hn::Add(weights[2], weights[3])));
    for (int c = 0; c < large.channels; ++c) {
      const float *upper = small.row(row.first, c), *lower = small.row(row.second, c);
      const V base = pick(upper, column.first);
      V way = hn::Mul(weights[1], hn::Sub(pick(upper, column.second), base));
      way = hn::MulAdd(weights[2], hn::Sub(pick(lower, column.first), base), way);
      way = hn::MulAdd(weights[3], hn::Sub(pick(lower, column.second), base), way);
      store(hn::Mul(set(s.gains[c == 0 ? 0 : 1]), hn::MulAdd(way, scale, base)), large.width - x, large.row(y, c) + x);
    }
  }
}

}  // namespace quell::scale::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::scale {

HWY_EXPORT(EnlargeRow);

void enlarge_row(const FloatImage& small, const Guides& guides, const Settings& settings, int y, const FloatOutput& large) {
  HWY_DYNAMIC_DISPATCH(EnlargeRow)(small, guides, settings, y, large);
}

}  // namespace quell::scale
#endif
