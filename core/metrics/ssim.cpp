// The window is separable: columns are weighed first, into a row of sums, and then along that row. In double, because the
// variances are differences of nearly equal numbers.
#include "quell/metrics/ssim.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "quell/metrics/bands.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/metrics/ssim.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include <hwy/highway.h>

#ifndef QUELL_SSIM_SHARED  // what is the same for all vector units
#define QUELL_SSIM_SHARED
namespace quell::detail {

constexpr int kRadius = kSsimRadius;
constexpr int kSums = 4;  // r, a, r^2 + a^2, r a

using SsimWeights = std::array<double, kRadius + 1>;  // by the distance from the center

// The sums of a row: `stride` doubles each, one after the other.
struct SsimScratch {
  double* data;
  std::ptrdiff_t stride;
};

}  // namespace quell::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;

HWY_INLINE V load(const float* from) { return hn::PromoteTo(D(), hn::LoadU(hn::Rebind<float, D>(), from)); }

void weigh_columns(const Shown& in, int y, int c, const SsimWeights& weights, const SsimScratch& to) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int x = 0; x < in.reference.width; x += lanes) {
    V sum_r = hn::Zero(d), sum_a = sum_r, sum_squares = sum_r, sum_products = sum_r;
    for (int dy = -kRadius; dy <= kRadius; ++dy) {
      const V w = hn::Set(d, weights[static_cast<std::size_t>(std::abs(dy))]);
      const V r = load(in.reference.row(y + dy, c) + x), a = load(in.image.row(y + dy, c) + x);
      sum_r = hn::MulAdd(w, r, sum_r);
      sum_a = hn::MulAdd(w, a, sum_a);
      sum_squares = hn::MulAdd(w, hn::MulAdd(r, r, hn::Mul(a, a)), sum_squares);
      sum_products = hn::MulAdd(w, hn::Mul(r, a), sum_products);
    }
    hn::StoreU(sum_r, d, to.data + x);
    hn::StoreU(sum_a, d, to.data + to.stride + x);
    hn::StoreU(sum_squares, d, to.data + 2 * to.stride + x);
    hn::StoreU(sum_products, d, to.data + 3 * to.stride + x);
  }
}

// The window's mean at the columns from `center` on.
HWY_INLINE V weigh_row(const double* center, const SsimWeights& weights) {
  const D d;
  V sum = hn::Mul(hn::Set(d, weights[0]), hn::LoadU(d, center));
  for (int dx = 1; dx <= kRadius; ++dx) {
    const V pair = hn::Add(hn::LoadU(d, center - dx), hn::LoadU(d, center + dx));
    sum = hn::MulAdd(hn::Set(d, weights[static_cast<std::size_t>(dx)]), pair, sum);
  }
  return sum;
}

// Exactly 1 where the windows are alike: sums of squares are twice those of products then, to the last bit, and so are those of
// the means. (Products of two floats are exact in double; those of means are not, so that they take no fused addition.)
HWY_INLINE V similarity(const double* sums, std::ptrdiff_t stride, const SsimWeights& weights) {
  const D d;
  const V c1 = hn::Set(d, 0.01 * 0.01), c2 = hn::Set(d, 0.03 * 0.03), two = hn::Set(d, 2);
  const V mean_r = weigh_row(sums, weights), mean_a = weigh_row(sums + stride, weights);
  const V squares = weigh_row(sums + 2 * stride, weights), products = weigh_row(sums + 3 * stride, weights);
  const V of_means = hn::Mul(mean_r, mean_a), of_squares = hn::Add(hn::Mul(mean_r, mean_r), hn::Mul(mean_a, mean_a));
  const V above = hn::Mul(hn::MulAdd(two, of_means, c1), hn::MulAdd(two, hn::Sub(products, of_means), c2));
  const V below = hn::Mul(hn::Add(of_squares, c1), hn::Add(hn::Sub(squares, of_squares), c2));
  return hn::Div(above, below);
}

Score SsimRow(const Shown& in, int y, const SsimWeights& weights, const SsimScratch& scratch) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d)), end = in.reference.width - kRadius;
  V sum = hn::Zero(d), count = sum;
  for (int c = 0; c < 3; ++c) {
    weigh_columns(in, y, c, weights, scratch);
    for (int x = kRadius; x < end; x += lanes) {
      const auto inside = hn::FirstN(d, static_cast<std::size_t>(end - x));
      const V counts = hn::IfThenElseZero(inside, load(in.counts.row(y) + x));
      sum = hn::MulAdd(counts, similarity(scratch.data + x, scratch.stride, weights), sum);
      if (c == 0) count = hn::Add(count, counts);
    }
  }
  const auto total = [&](V v) { return hn::GetLane(hn::SumOfLanes(d, v)); };
  return {total(sum) / 3, static_cast<std::uint64_t>(total(count))};
}

}  // namespace quell::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::detail {
namespace {

HWY_EXPORT(SsimRow);

SsimWeights gaussian() {
  SsimWeights weights{};
  double sum = 0;
  for (int i = -kRadius; i <= kRadius; ++i) {
    const double w = std::exp(-i * i / (2 * 1.5 * 1.5));
    weights[static_cast<std::size_t>(std::abs(i))] = w;
    sum += w;
  }
  for (double& w : weights) w /= sum;
  return weights;
}

}  // namespace

Score ssim(const Shown& shown, const Parallel& parallel) {
  const SsimWeights weights = gaussian();
  const int width = shown.reference.width, rows = shown.reference.height - 2 * kRadius;
  if (rows <= 0 || width <= 2 * kRadius) return {};
  const std::ptrdiff_t stride = width + 16;  // what a vector from the last pixel's window on takes, and more
  return sum_bands<Score>(rows, parallel, [&](int y0, int y1) {
    std::vector<double> sums(static_cast<std::size_t>(kSums * stride));
    Score score;
    for (int y = y0; y < y1; ++y)
      score += HWY_DYNAMIC_DISPATCH(SsimRow)(shown, y + kRadius, weights, SsimScratch{sums.data(), stride});
    return score;
  });
}

}  // namespace quell::detail
#endif
