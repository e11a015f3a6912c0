#include "quell/metrics/difference_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/metrics/difference_rows.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace quell::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;

HWY_INLINE V load(const float* from) { return hn::PromoteTo(D(), hn::LoadU(hn::Rebind<float, D>(), from)); }
HWY_INLINE double sum_lanes(V v) { return hn::GetLane(hn::SumOfLanes(D(), v)); }
HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(D())); }

template <class Error>
HWY_INLINE double sum_errors(FloatImage reference, FloatImage image, int y, const Error& error) {
  V sum = hn::Zero(D());
  for (int c = 0; c < 3; ++c) {
    const float *r = reference.row(y, c), *a = image.row(y, c);
    for (int x = 0; x < reference.width; x += lanes()) sum = hn::Add(sum, error(load(r + x), load(a + x)));
  }
  return sum_lanes(sum) / 3;
}

double SquaredErrors(FloatImage reference, FloatImage image, int y) {
  return sum_errors(reference, image, y, [](V r, V a) {
    const V error = hn::Sub(a, r);
    return hn::Mul(error, error);
  });
}

double RelativeSquaredErrors(FloatImage reference, FloatImage image, int y) {
  return sum_errors(reference, image, y, [](V r, V a) {
    const V error = hn::Sub(a, r);
    return hn::Div(hn::Mul(error, error), hn::MulAdd(r, r, hn::Set(D(), 1e-2)));
  });
}

double SymmetricErrors(FloatImage reference, FloatImage image, int y) {
  return sum_errors(reference, image, y, [](V r, V a) {
    const V size = hn::Add(hn::Add(hn::Abs(a), hn::Abs(r)), hn::Set(D(), 1e-2));
    return hn::Div(hn::Abs(hn::Sub(a, r)), size);
  });
}

Score SquaredChangeErrors(const Shown& now, const Shown& before, int y) {
  V sum = hn::Zero(D()), count = sum;
  for (int x = 0; x < now.counts.width; x += lanes()) {
    const V counts = hn::Mul(load(now.counts.row(y) + x), load(before.counts.row(y) + x));
    count = hn::Add(count, counts);
    for (int c = 0; c < 3; ++c) {
      const V change = hn::Sub(load(now.image.row(y, c) + x), load(before.image.row(y, c) + x));
      const V wanted = hn::Sub(load(now.reference.row(y, c) + x), load(before.reference.row(y, c) + x));
      const V error = hn::Sub(change, wanted);
      sum = hn::MulAdd(counts, hn::Mul(error, error), sum);
    }
  }
  return {sum_lanes(sum) / 3, static_cast<std::uint64_t>(sum_lanes(count))};
}

}  // namespace quell::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::detail {

HWY_EXPORT(SquaredErrors);
HWY_EXPORT(RelativeSquaredErrors);
HWY_EXPORT(SymmetricErrors);
HWY_EXPORT(SquaredChangeErrors);

double squared_errors(FloatImage reference, FloatImage image, int y) {
  return HWY_DYNAMIC_DISPATCH(SquaredErrors)(reference, image, y);
}
double relative_squared_errors(FloatImage reference, FloatImage image, int y) {
  return HWY_DYNAMIC_DISPATCH(RelativeSquaredErrors)(reference, image, y);
}
double symmetric_errors(FloatImage reference, FloatImage image, int y) {
  return HWY_DYNAMIC_DISPATCH(SymmetricErrors)(reference, image, y);
}
Score squared_change_errors(const Shown& now, const Shown& before, int y) {
  return HWY_DYNAMIC_DISPATCH(SquaredChangeErrors)(now, before, y);
}

}  // namespace quell::detail
#endif
