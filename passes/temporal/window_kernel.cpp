#include "passes/temporal/window_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/temporal/window_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes them visible again for every vector unit.
#include "passes/temporal/taps-inl.h"

#ifndef QUELL_WINDOW_SHARED  // what is the same for all vector units
#define QUELL_WINDOW_SHARED
namespace quell::window {

constexpr float kSmallestVariance = 1e-30F;  // its reciprocal is still finite

}  // namespace quell::window
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::window::HWY_NAMESPACE {
using namespace taps::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

HWY_INLINE Mask valid_at(const Aligned& frame, int x, int y) {
  return frame.valid ? hn::Gt(read(frame.valid.row(y), x), set(0.5F)) : hn::Ge(zero(), zero());
}

// How alike the frame is to the one in the middle, around the pixels from (x, y) on.
HWY_INLINE V likeness(const Aligned& middle, const Aligned& frame, const FloatImage& variance, const Settings& s, int x, int y) {
  V difference = zero(), expected = zero();
  each_neighbor(s.radius, x, y, middle.color.width, middle.color.height, {}, [&](int tx, int ty, Mask counts) HWY_ATTR {
    counts = hn::And(counts, valid_at(frame, tx, ty));
    const V step = luminance(sub(read3(frame.color, tx, ty), read3(middle.color, tx, ty)));
    const V spread = hn::Add(read(middle.variance.row(ty), tx), read(variance.row(ty), tx));
    difference = hn::Add(difference, hn::IfThenElseZero(counts, step));
    expected = hn::Add(expected, hn::IfThenElseZero(counts, spread));
  });
  const V squared = hn::Mul(hn::Mul(difference, difference), set(s.factor));
  return exp2(hn::Neg(hn::Div(squared, hn::Max(expected, set(kSmallestVariance)))));
}

void AverageRow(const Aligned& middle, std::span<const Aligned> frames, const Settings& s, int y, const Outputs& out) {
  for (int x = 0; x < out.color.width; x += lanes()) {
    const int count = out.color.width - x;
    V3 sum = read3(middle.color, x, y);
    V total = set(1.0F), squares = set(1.0F), variance = middle.variance ? read(middle.variance.row(y), x) : zero();
    for (const Aligned& frame : frames) {
      const FloatImage& own_variance = frame.variance ? frame.variance : middle.variance;
      V weight = middle.variance ? likeness(middle, frame, own_variance, s, x, y) : set(1.0F);
      const Mask valid = valid_at(frame, x, y);
      weight = hn::IfThenElseZero(valid, weight);
      const V square = hn::Mul(weight, weight);
      // Chosen, not multiplied by 0: what is not valid need not be finite.
      const V3 color = if_then_else(valid, read3(frame.color, x, y), {zero(), zero(), zero()});
      sum = mul_add(weight, color, sum);
      total = hn::Add(total, weight);
      squares = hn::Add(squares, square);
      if (middle.variance) variance = hn::MulAdd(square, hn::IfThenElseZero(valid, read(own_variance.row(y), x)), variance);
    }
    const V scale = hn::Div(set(1.0F), total);
    store(mul(scale, sum), count, out.color.row(y) + x, out.color.plane_stride);
    store(hn::Mul(variance, hn::Mul(scale, scale)), count, out.variance.row(y) + x);
    store(hn::Div(hn::Mul(total, total), squares), count, out.length.row(y) + x);
  }
}

}  // namespace quell::window::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::window {

HWY_EXPORT(AverageRow);

void average_row(const Aligned& middle, std::span<const Aligned> frames, const Settings& settings, int y, const Outputs& out) {
  HWY_DYNAMIC_DISPATCH(AverageRow)(middle, frames, settings, y, out);
}

}  // namespace quell::window
#endif
