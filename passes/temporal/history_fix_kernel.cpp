// Neighbors mostly have a history of the same length, and so taps at the same distance: the lanes of each distance are done at a
// time. A result is the pixel plus weighted differences of the taps to it: the mean of equal values is that value, bit for bit.
#include "passes/temporal/history_fix_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/temporal/history_fix_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes them visible again for every vector unit.
#include <hwy/contrib/math/math-inl.h>

#include "passes/temporal/taps-inl.h"

#ifndef QUELL_HISTORY_FIX_SHARED  // what is the same for all vector units
#define QUELL_HISTORY_FIX_SHARED
namespace quell::history_fix {

constexpr int kTaps = (2 * kTapsAside + 1) * (2 * kTapsAside + 1);
constexpr float kSmallestGradient = 1e-8F;    // Falcor's, as in the pass variance
constexpr float kSmallestTolerance = 1e-30F;  // of a difference in depth; its reciprocal is still finite
constexpr float kSmallestCosine = 1e-37F;     // its logarithm is still finite

}  // namespace quell::history_fix
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::history_fix::HWY_NAMESPACE {
using namespace taps::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

// What the pixels from (x, y) on compare their taps with.
class Center {
 public:
  HWY_INLINE Center(const Guides& in, const Settings& s, int x, int y)
      : in_(in), s_(s), compares_plane_(in.normal && in.position), compares_depth_(in.depth && in.depth_gradient) {
    if (in.depth) depth_ = read(in.depth.row(y), x);
    if (in.normal) normal_ = read3(in.normal, x, y);
    if (in.id) id_ = read(in.id.row(y), x);
    if (compares_plane_) {
      position_ = read3(in.position, x, y);
      tolerance_ = hn::MulAdd(depth_, set(s.plane_relative), set(s.plane_absolute));
    }
    if (compares_depth_) {
      const V gradient = hn::Max(read(in.depth_gradient.row(y), x), set(kSmallestGradient));
      tolerated_ = hn::Mul(gradient, set(s.depth_factor));
    }
  }

  HWY_INLINE Mask surface() const {
    Mask is_surface = hn::Lt(depth_, set(kNoSurface));
    if (in_.id) is_surface = hn::And(is_surface, hn::RebindMask(D(), hn::Ne(id_, hn::Set(DU(), QUELL_NO_ID))));
    return is_surface;
  }

  // Of lanes of `of` that are `distance` pixels from their taps, which are the pixels from (x, y) on; 0 for other lanes.
  HWY_INLINE V weight(Mask of, float distance, int x, int y) const {
    of = hn::And(of, inside(x, in_.length.width));
    if (in_.id) of = hn::And(of, hn::RebindMask(D(), hn::Eq(read(in_.id.row(y), x), id_)));
    V e = zero();
    if (in_.depth) {
      const V depth = read(in_.depth.row(y), x);
      of = hn::And(of, hn::Lt(depth, set(kNoSurface)));
      if (compares_depth_ && !compares_plane_)
        e = hn::Div(hn::Abs(hn::Sub(depth, depth_)), hn::Max(hn::Mul(tolerated_, set(distance)), set(kSmallestTolerance)));
    }
    if (compares_plane_) {
      const V height = dot(normal_, sub(read3(in_.position, x, y), position_));
      of = hn::And(of, hn::Le(hn::Abs(height), tolerance_));
    }
    if (in_.normal && s_.normal_power > 0) {
      const V cosine = dot(normal_, read3(in_.normal, x, y));
      of = hn::And(of, hn::Gt(cosine, zero()));
      e = hn::NegMulAdd(set(s_.normal_power), hn::Log(D(), hn::Max(cosine, set(kSmallestCosine))), e);
    }
    // Normals that are a little longer than 1 make e negative.
    return hn::IfThenElseZero(of, exp2(hn::Neg(hn::Max(e, zero()))));
  }

 private:
  const Guides& in_;
  const Settings& s_;
  bool compares_plane_, compares_depth_;
  V depth_ = zero(), tolerance_ = zero(), tolerated_ = zero();
  V3 normal_{zero(), zero(), zero()}, position_{zero(), zero(), zero()};
  hn::Vec<DU> id_ = hn::Zero(DU());
};

// Lanes of `of` of the pixels from (x, y) on, whose taps are `stride` pixels apart.
HWY_INLINE void fix_lanes(const Guides& in, const Center& center, std::span<const Fixed> images, int x, int y, int stride,
                          Mask of) {
  const int width = in.length.width, height = in.length.height;
  V weights[kTaps];
  V sum = set(1.0F);  // of the center
  each_tap(kTapsAside, stride, x, y, width, height, [&](int i, int dx, int dy, int tx, int ty) HWY_ATTR {
    if (dx == 0 && dy == 0) return;
    const float distance = static_cast<float>(stride) * std::sqrt(static_cast<float>(dx * dx + dy * dy));
    weights[i] = center.weight(of, distance, tx, ty);
    sum = hn::Add(sum, weights[i]);
  });
  const V scale = hn::Div(set(1.0F), sum);
  for (const Fixed& image : images)
    for (int c = 0; c < image.to.channels; ++c) {
      const V own = read(image.from.row(y, c), x);
      V way = zero();
      each_tap(kTapsAside, stride, x, y, width, height, [&](int i, int dx, int dy, int tx, int ty) HWY_ATTR {
        if (dx == 0 && dy == 0) return;
        // Chosen, not multiplied by 0: what does not count need not be finite.
        const V difference = hn::IfThenElseZero(hn::Ne(weights[i], zero()), hn::Sub(read(image.from.row(ty, c), tx), own));
        way = hn::MulAdd(weights[i], difference, way);
      });
      float* to = image.to.row(y, c) + x;
      store(hn::IfThenElse(of, hn::MulAdd(way, scale, own), hn::LoadU(D(), to)), width - x, to);
    }
}

void FixRow(const Guides& in, const Settings& s, std::span<const Fixed> images, int y) {
  const D d;
  const int width = in.length.width;
  for (const Fixed& image : images)
    for (int c = 0; c < image.to.channels; ++c) std::copy_n(image.from.row(y, c), width, image.to.row(y, c));
  for (int x = 0; x < width; x += lanes()) {
    const V length = read(in.length.row(y), x);
    Mask young = hn::And(hn::Lt(length, set(s.min_length)), inside(x, width));
    if (hn::AllFalse(d, young)) continue;
    const Center center(in, s, x, y);
    young = hn::And(young, center.surface());
    const V strides = hn::Round(hn::Div(set(s.stride), hn::Add(set(1.0F), hn::Max(length, set(1.0F)))));
    HWY_ALIGN float each_stride[kMaxLanes];
    hn::Store(strides, d, each_stride);
    while (!hn::AllFalse(d, young)) {
      const float stride = each_stride[hn::FindFirstTrue(d, young)];
      const Mask same = hn::And(young, hn::Eq(strides, set(stride)));
      young = hn::AndNot(same, young);
      if (stride > 0) fix_lanes(in, center, images, x, y, static_cast<int>(stride), same);
    }
  }
}

}  // namespace quell::history_fix::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::history_fix {

HWY_EXPORT(FixRow);

int stride(const Settings& settings, float length) {
  return static_cast<int>(std::nearbyint(settings.stride / (1 + std::max(length, 1.0F))));
}

void fix_row(const Guides& in, const Settings& settings, std::span<const Fixed> images, int y) {
  HWY_DYNAMIC_DISPATCH(FixRow)(in, settings, images, y);
}

}  // namespace quell::history_fix
#endif
