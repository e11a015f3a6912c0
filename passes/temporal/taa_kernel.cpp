#include "passes/temporal/taa_kernel.h"

#include <cstdlib>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/temporal/taa_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes them visible again for every vector unit.
#include "passes/temporal/taps-inl.h"

#ifndef QUELL_TAA_SHARED  // what is the same for all vector units
#define QUELL_TAA_SHARED
namespace quell::taa {

constexpr float kSmallestExtent = 1e-30F;  // of a box: its reciprocal is still finite

}  // namespace quell::taa
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::taa::HWY_NAMESPACE {
using namespace taps::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

// Components of a box.
struct Limits {
  V3 lower, upper;
};

HWY_INLINE V3 min(V3 a, V3 b) { return {hn::Min(a.x, b.x), hn::Min(a.y, b.y), hn::Min(a.z, b.z)}; }
HWY_INLINE V3 max(V3 a, V3 b) { return {hn::Max(a.x, b.x), hn::Max(a.y, b.y), hn::Max(a.z, b.z)}; }

// Of the pixel and those of its neighbors that lie in the image.
HWY_INLINE Limits find_range(const Images& in, int x, int y, V3 own, Box box) {
  Limits square{own, own}, cross = square;
  each_tap(1, 1, x, y, in.color.width, in.color.height, [&](int, int dx, int dy, int tx, int ty) HWY_ATTR {
    const V3 neighbor = if_then_else(inside(tx, in.color.width), ycocg(read3(in.color, tx, ty)), own);
    square = {min(square.lower, neighbor), max(square.upper, neighbor)};
    if (std::abs(dx) + std::abs(dy) <= 1) cross = {min(cross.lower, neighbor), max(cross.upper, neighbor)};
  });
  if (box == Box::range) return square;
  const V half = set(0.5F);
  return {mul(half, add(square.lower, cross.lower)), mul(half, add(square.upper, cross.upper))};
}

HWY_INLINE Limits find_variance(const Images& in, int x, int y, V3 own, float k) {
  Spread first, second, third;
  V total = zero();
  each_neighbor(1, x, y, in.color.width, in.color.height, {}, [&](int tx, int ty, Mask counts) HWY_ATTR {
    const V3 difference = sub(ycocg(read3(in.color, tx, ty)), own);
    first.add(counts, difference.x), second.add(counts, difference.y), third.add(counts, difference.z);
    total = hn::Add(total, hn::IfThenElseZero(counts, set(1.0F)));
  });
  const V share = hn::Div(set(1.0F), hn::Max(total, set(1.0F)));
  const V3 mean = add(own, {first.mean(share), second.mean(share), third.mean(share)});
  const V3 reach = mul(set(k), {first.deviation(share), second.deviation(share), third.deviation(share)});
  return {sub(mean, reach), add(mean, reach)};
}

// How many times farther from the center of the box than its side.
HWY_INLINE V excess(V from_center, V extent) { return hn::Div(hn::Abs(from_center), hn::Max(extent, set(kSmallestExtent))); }

// What lies in the box stays as it is.
HWY_INLINE V3 apply(const Limits& box, V3 history, Limit limit) {
  if (limit == Limit::clamp) return min(max(history, box.lower), box.upper);
  const V half = set(0.5F), one = set(1.0F);
  const V3 center = mul(half, add(box.upper, box.lower)), extent = mul(half, sub(box.upper, box.lower));
  const V3 way = sub(history, center);
  const V farthest = hn::Max(hn::Max(excess(way.x, extent.x), excess(way.y, extent.y)), excess(way.z, extent.z));
  return if_then_else(hn::Gt(farthest, one), mul_add(hn::Div(one, farthest), way, center), history);
}

void BlendRow(const Images& in, const Settings& s, int y, const FloatOutput& color) {
  const V one = set(1.0F);
  for (int x = 0; x < color.width; x += lanes()) {
    const V3 frame = read3(in.color, x, y), own = ycocg(frame);
    V3 history = ycocg(read3(in.history, x, y));
    if (s.limit != Limit::none)
      history =
          apply(s.box == Box::variance ? find_variance(in, x, y, own, s.k) : find_range(in, x, y, own, s.box), history, s.limit);
    V now = set(s.alpha), before = set(1 - s.alpha);
    if (s.weigh) {
      now = hn::Div(now, hn::Add(one, hn::Max(own.x, zero())));
      before = hn::Div(before, hn::Add(one, hn::Max(history.x, zero())));
    }
    const V scale = hn::Div(one, hn::Add(now, before));
    V3 result = mul_add(hn::Mul(now, scale), frame, mul(hn::Mul(before, scale), rgb(history)));
    if (in.valid) result = if_then_else(hn::Gt(read(in.valid.row(y), x), set(0.5F)), result, frame);
    store(result, color.width - x, color.row(y) + x, color.plane_stride);
  }
}

}  // namespace quell::taa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::taa {

HWY_EXPORT(BlendRow);

void blend_row(const Images& in, const Settings& settings, int y, const FloatOutput& color) {
  HWY_DYNAMIC_DISPATCH(BlendRow)(in, settings, y, color);
}

}  // namespace quell::taa
#endif
