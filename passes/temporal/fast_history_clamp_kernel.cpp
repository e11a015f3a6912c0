// The window is summed up as differences to the center of the fast history: nothing cancels where both are bright and alike.
#include "passes/temporal/fast_history_clamp_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/temporal/fast_history_clamp_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes them visible again for every vector unit.
#include "passes/temporal/taps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace quell::fast_history_clamp::HWY_NAMESPACE {
using namespace taps::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

// The difference of a component to the center, limited; and whether that changed it.
struct Limited {
  V value;
  Mask changed;
};
HWY_INLINE Limited limit(V difference, const Spread& window, V share, const Settings& s) {
  const V mean = window.mean(share), reach = hn::Mul(window.deviation(share), set(s.k));
  V lower = hn::Sub(mean, reach), upper = hn::Add(mean, reach);
  if (s.include_center) lower = hn::Min(lower, zero()), upper = hn::Max(upper, zero());
  const V value = hn::Min(hn::Max(difference, lower), upper);
  return {value, hn::Ne(value, difference)};
}

template <Space kSpace>
HWY_INLINE void clamp_pixels(const Images& in, const Settings& s, int x, int y, const FloatOutput& color,
                             const FloatOutput& clamped) {
  const auto convert = [](V3 v) HWY_ATTR { return kSpace == Space::ycocg ? ycocg(v) : v; };
  const int width = color.width, count = width - x;
  const V3 slow = read3(in.color, x, y), fast = read3(in.fast, x, y), center = convert(fast);
  Spread first, second, third;
  V total = zero();
  each_neighbor(s.radius, x, y, width, color.height, in.depth, [&](int tx, int ty, Mask counts) HWY_ATTR {
    const V3 difference = sub(convert(read3(in.fast, tx, ty)), center);
    first.add(counts, difference.x), second.add(counts, difference.y), third.add(counts, difference.z);
    total = hn::Add(total, hn::IfThenElseZero(counts, set(1.0F)));
  });
  const V share = hn::Div(set(1.0F), hn::Max(total, set(1.0F)));
  const V3 difference = sub(convert(slow), center);
  const Limited a = limit(difference.x, first, share, s), b = limit(difference.y, second, share, s),
                c = limit(difference.z, third, share, s);
  Mask changed = hn::Or(hn::Or(a.changed, b.changed), c.changed);
  if (in.depth) changed = hn::And(changed, hn::Lt(read(in.depth.row(y), x), set(kNoSurface)));
  if (in.length) changed = hn::And(changed, hn::Ge(read(in.length.row(y), x), set(s.min_length)));
  const V3 limited = add(center, {a.value, b.value, c.value});
  const V3 result = if_then_else(changed, kSpace == Space::ycocg ? rgb(limited) : limited, slow);
  // How far luma went from the slow to the fast history.
  const V from = ycocg(slow).x, whole = hn::Sub(ycocg(fast).x, from), way = hn::Sub(ycocg(result).x, from);
  const Mask moved = hn::And(changed, hn::Ne(whole, zero()));
  const V part = hn::Min(hn::Max(hn::Div(way, hn::IfThenElse(moved, whole, set(1.0F))), zero()), set(1.0F));
  store(hn::IfThenElseZero(moved, part), count, clamped.row(y) + x);
  store(result, count, color.row(y) + x, color.plane_stride);
}

void ClampRow(const Images& in, const Settings& s, int y, const FloatOutput& color, const FloatOutput& clamped) {
  for (int x = 0; x < color.width; x += lanes()) {
    if (s.space == Space::ycocg)
      clamp_pixels<Space::ycocg>(in, s, x, y, color, clamped);
    else
      clamp_pixels<Space::rgb>(in, s, x, y, color, clamped);
  }
}

}  // namespace quell::fast_history_clamp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::fast_history_clamp {

HWY_EXPORT(ClampRow);

void clamp_row(const Images& in, const Settings& settings, int y, const FloatOutput& color, const FloatOutput& clamped) {
  HWY_DYNAMIC_DISPATCH(ClampRow)(in, settings, y, color, clamped);
}

}  // namespace quell::fast_history_clamp
#endif
