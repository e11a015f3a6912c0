// The window is summed up as differences to its center: nothing cancels where all is bright and alike.
#include "passes/temporal/antilag_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/temporal/antilag_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes them visible again for every vector unit.
#include "passes/temporal/taps-inl.h"

#ifndef QUELL_ANTILAG_SHARED  // what is the same for all vector units
#define QUELL_ANTILAG_SHARED
namespace quell::antilag {

constexpr float kDarkest = 1e-6F;  // NRD's: what a difference between blacks is divided by

}  // namespace quell::antilag
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::antilag::HWY_NAMESPACE {
using namespace taps::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

void FindLag(const Images& in, const Settings& s, int y, const FloatOutput& confidence, const FloatOutput& length) {
  const int width = confidence.width;
  const FloatImage& now = in.color ? in.color : in.fast;
  const V one = set(1.0F);
  for (int x = 0; x < width; x += lanes()) {
    const V slow = luminance(read3(in.slow, x, y)), fast = luminance(read3(in.fast, x, y));
    const V center = luminance(read3(now, x, y));
    Spread fast_window, now_window;
    V total = zero();
    each_neighbor(s.radius, x, y, width, confidence.height, in.depth, [&](int tx, int ty, Mask counts) HWY_ATTR {
      fast_window.add(counts, hn::Sub(luminance(read3(in.fast, tx, ty)), fast));
      now_window.add(counts, hn::Sub(luminance(read3(now, tx, ty)), center));
      total = hn::Add(total, hn::IfThenElseZero(counts, one));
    });
    const V share = hn::Div(one, hn::Max(total, one));
    const V mean = hn::Add(center, now_window.mean(share));
    V tolerance = hn::Mul(fast_window.deviation(share), set(s.k_fast));
    if (in.color) tolerance = hn::MulAdd(now_window.deviation(share), set(s.k_color), tolerance);
    const V excess = hn::Max(hn::Sub(hn::Abs(hn::Sub(slow, mean)), tolerance), zero());
    const V scale = hn::Add(hn::Max(hn::Max(slow, mean), zero()), hn::Add(tolerance, set(kDarkest)));
    V lag = hn::Min(hn::Mul(set(s.sensitivity), hn::Div(excess, scale)), one);
    if (in.depth) lag = hn::IfThenElseZero(hn::Lt(read(in.depth.row(y), x), set(kNoSurface)), lag);
    const V trust = hn::Sub(one, lag);
    const V old = in.length ? hn::Max(read(in.length.row(y), x), one) : set(s.max_length);
    store(trust, width - x, confidence.row(y) + x);
    store(hn::MulAdd(trust, hn::Sub(old, one), one), width - x, length.row(y) + x);
  }
}

}  // namespace quell::antilag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::antilag {

HWY_EXPORT(FindLag);

void find_lag(const Images& in, const Settings& settings, int y, const FloatOutput& confidence, const FloatOutput& length) {
  HWY_DYNAMIC_DISPATCH(FindLag)(in, settings, y, confidence, length);
}

}  // namespace quell::antilag
#endif
