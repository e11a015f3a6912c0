// Rows that are a step apart are worked on one after the other, so that the five rows which a row is made of stay in the
// second-level cache whatever the level. Each is first gathered in scratch memory, in tiles, with an apron, where taps that do
// not count (outside the image, no surface, not finite) have a color or a luminance so far from all others that their weight is
// exactly 0. The loop over the taps is then the formula alone, without an edge or a mask in it.
//
// Error of a weight 2^-E, relative: 3.6e-6 (2^x) + 2e-7 E (roundings) + sigma_n 1.5e-7 (the cosine's roundings, svgf) +
// 4.0e-6 E (angle, joint_bilateral). A result errs by at most twice that; so does a variance, twice.
#include "passes/spatial/atrous_kernel.h"

#include <algorithm>
#include <cstdlib>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/spatial/atrous_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include "passes/spatial/atrous_stops-inl.h"

#ifndef QUELL_ATROUS_SHARED  // what is the same for all vector units
#define QUELL_ATROUS_SHARED
namespace quell::atrous {

constexpr int kReach = 2;              // steps
constexpr int kRows = 2 * kReach + 1;  // that a row of results is made of

// The rows that are `step` apart, from `first` on.
struct Phase {
  int first, count;
};
struct Turn {
  Phase phase;
  int index;  // of the row within the phase
};
inline Turn turn_at(int turn, int step, int height) {
  const int shorter = height / step, longer = height % step;  // a phase's rows, and how many phases have one more
  if (turn < longer * (shorter + 1)) return {{turn / (shorter + 1), shorter + 1}, turn % (shorter + 1)};
  turn -= longer * (shorter + 1);
  return {{longer + turn / shorter, shorter}, turn % shorter};
}

constexpr std::size_t magnitude(int offset) { return static_cast<std::size_t>(offset < 0 ? -offset : offset); }
// Of the weight at an offset in steps: what is not a power of 2.
constexpr float mantissa(int dx, int dy) { return kSpline[magnitude(dx)].mantissa * kSpline[magnitude(dy)].mantissa; }

}  // namespace quell::atrous
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::atrous::HWY_NAMESPACE {

constexpr int kMaxPlanes = 10;
constexpr int kRowFloats = kMaxPlanes * kStride;

// Where results go, and the columns [left, right) that are worked on.
struct Job {
  const FloatOutput& color;
  const FloatOutput& variance;
  int step, left, right;
  float* memory;  // kRows rows with an apron of the taps' reach, one that does not count, and one of blurred variances

  int apron() const { return (kReach * step + 15) / 16 * 16; }
  int tile_width() const { return kStride - 2 * apron() - 16; }  // the last vector may start at the last pixel
  // The pixel at `left` of row `index` of a phase.
  float* row(int index) const { return memory + (index + kRows) % kRows * kRowFloats + apron(); }
  float* outside_row() const { return memory + kRows * kRowFloats + apron(); }
  float* blurred() const { return memory + (kRows + 1) * kRowFloats + 16; }
};

// Lays [begin, end) of a row, counted from the tile's left, outside of the image.
template <class AnyStops>
void fill_outside(int begin, int end, float* row) {
  for (int plane = 0; plane < AnyStops::kPlanes; ++plane)
    std::fill(row + plane * kStride + begin, row + plane * kStride + std::max(begin, end), AnyStops::outside(plane));
}

template <class AnyStops>
void gather_row(const AnyStops& stops, const Job& job, int y, float* row) {
  const int reach = kReach * job.step, x0 = std::max(0, job.left - reach), x1 = std::min(job.color.width, job.right + reach);
  for (int x = x0; x < x1; x += lanes()) {
    const V3 color = pixels3(stops.in.color, x, y);
    const Mask counts = hn::And(hn::FirstN(D(), static_cast<std::size_t>(x1 - x)), is_finite(color));
    stops.gather(counts, color, x, y, row + (x - job.left));
  }
  fill_outside<AnyStops>(-reach, x0 - job.left, row);
  fill_outside<AnyStops>(x1 - job.left, job.right - job.left + reach + 16, row);
}

struct Sums {
  V weight;
  V3 color;
  V variance;
};

template <int kDx, int kDy, class AnyStops, class Pair>
HWY_INLINE void add_tap(const AnyStops& stops, const typename AnyStops::Pixel& pixel, const Pair& pair, const float* tap,
                        Sums& sums) {
  const V start = set(stops.s.offset_exponents[magnitude(kDy)][magnitude(kDx)]);
  V weight = exp2_negative(stops.exponent(pixel, pair, tap, start));
  if constexpr (mantissa(kDx, kDy) != 1) weight = hn::Mul(weight, set(mantissa(kDx, kDy)));
  sums.weight = hn::Add(sums.weight, weight);
  sums.color = mul_add(weight, at3(tap, 0), sums.color);
  sums.variance = hn::MulAdd(hn::Mul(weight, weight), at(tap, AnyStops::kVariance), sums.variance);
}

// Where the taps of a vector of pixels lie.
struct Window {
  const float* rows[kRows];
  int step;
};

template <int kDx, int kDy, class AnyStops>
HWY_INLINE void add_pair(const AnyStops& stops, const typename AnyStops::Pixel& pixel, const Window& window, Sums& sums) {
  const auto pair = stops.template pair<kDx, kDy>(pixel);
  add_tap<kDx, kDy>(stops, pixel, pair, window.rows[kReach + kDy] + kDx * window.step, sums);
  add_tap<-kDx, -kDy>(stops, pixel, pair, window.rows[kReach - kDy] - kDx * window.step, sums);
}

template <class AnyStops>
HWY_INLINE Sums sum_taps(const AnyStops& stops, const typename AnyStops::Pixel& pixel, const Window& window) {
  const float* center = window.rows[kReach];
  const V own = set(mantissa(0, 0) / 16);
  Sums sums{own, mul(own, at3(center, 0)), hn::Mul(hn::Mul(own, own), at(center, AnyStops::kVariance))};
  add_pair<1, 0>(stops, pixel, window, sums);
  add_pair<2, 0>(stops, pixel, window, sums);
  add_pair<-2, 1>(stops, pixel, window, sums);
  add_pair<-1, 1>(stops, pixel, window, sums);
  add_pair<0, 1>(stops, pixel, window, sums);
  add_pair<1, 1>(stops, pixel, window, sums);
  add_pair<2, 1>(stops, pixel, window, sums);
  add_pair<-2, 2>(stops, pixel, window, sums);
  add_pair<-1, 2>(stops, pixel, window, sums);
  add_pair<0, 2>(stops, pixel, window, sums);
  add_pair<1, 2>(stops, pixel, window, sums);
  add_pair<2, 2>(stops, pixel, window, sums);
  return sums;
}

template <class AnyStops>
void filter_row(const AnyStops& stops, const Job& job, const Phase& phase, int index, const float* blurred) {
  const int y = phase.first + index * job.step;
  Window window{{}, job.step};
  for (int j = 0; j < kRows; ++j) {
    const int tap = index + j - kReach;
    window.rows[j] = tap >= 0 && tap < phase.count ? job.row(tap) : job.outside_row();
  }
  for (int x = job.left; x < job.right; x += lanes()) {
    const float* center = window.rows[kReach];
    const Sums sums = sum_taps(stops, stops.pixel(center, blurred, x, y), window);
    const V scale = hn::Div(set(1.0F), sums.weight);
    const Mask counts = hn::Lt(at(center, AnyStops::kCarrier), set(kFar));
    const V3 own = pixels3(stops.in.color, x, y);
    const V own_variance = stops.in.variance ? pixels(stops.in.variance, x, y) : zero();
    const int count = job.right - x;
    store(hn::IfThenElse(counts, hn::Mul(sums.color.x, scale), own.x), count, job.color.row(y, 0) + x);
    store(hn::IfThenElse(counts, hn::Mul(sums.color.y, scale), own.y), count, job.color.row(y, 1) + x);
    store(hn::IfThenElse(counts, hn::Mul(sums.color.z, scale), own.z), count, job.color.row(y, 2) + x);
    store(hn::IfThenElse(counts, hn::Mul(sums.variance, hn::Mul(scale, scale)), own_variance), count, job.variance.row(y) + x);
    for (const float*& row : window.rows) row += lanes();
    if (blurred) blurred += lanes();
  }
}

// Row y of the variance, blurred by 1/4, 1/2, 1/4 in both directions; weights of pixels in the image alone.
const float* blur_row(const FloatImage& variance, const Job& job, int y) {
  // A neighbor outside that leaves the mean to those inside.
  const auto mirror = [](float border, float inner) { return (2 * border + inner) / 3; };
  const auto column = [&](int x) {
    const float middle = variance.at(x, y);
    const bool above = y > 0, below = y + 1 < variance.height;
    const float before = above ? variance.at(x, y - 1) : below ? mirror(middle, variance.at(x, y + 1)) : middle;
    const float after = below ? variance.at(x, y + 1) : above ? mirror(middle, variance.at(x, y - 1)) : middle;
    return (before + 2 * middle + after) / 4;
  };
  float* blurred = job.blurred();
  float* columns = blurred + kStride;
  const int x0 = std::max(0, job.left - 1), x1 = std::min(variance.width, job.right + 1);
  for (int x = x0; x < x1; ++x) columns[x - job.left] = column(x);
  const int last = variance.width - 1;
  if (job.left == 0) columns[-1] = last > 0 ? mirror(columns[0], columns[1]) : columns[0];
  if (job.right > last)
    columns[last + 1 - job.left] = last > job.left ? mirror(columns[last - job.left], columns[last - 1 - job.left])
                                   : last > 0      ? mirror(columns[0], columns[-1])
                                                   : columns[0];
  for (int x = 0; x < job.right - job.left; ++x) blurred[x] = (columns[x - 1] + 2 * columns[x] + columns[x + 1]) / 4;
  return blurred;
}

// Rows [begin, end) of a phase.
template <class AnyStops>
void filter_tile(const AnyStops& stops, const Job& job, const Phase& phase, int begin, int end) {
  const auto gather = [&](int index) {
    if (index >= 0 && index < phase.count) gather_row(stops, job, phase.first + index * job.step, job.row(index));
  };
  for (int index = begin - kReach; index < begin + kReach; ++index) gather(index);
  for (int index = begin; index < end; ++index) {
    gather(index + kReach);
    const int y = phase.first + index * job.step;
    const float* blurred = nullptr;
    if (stops.s.stops == Stops::svgf) {
      if (stops.in.blurred_variance)
        blurred = stops.in.blurred_variance.row(y) + job.left;
      else if (stops.in.variance)
        blurred = blur_row(stops.in.variance, job, y);
    }
    filter_row(stops, job, phase, index, blurred);
  }
}

template <class AnyStops>
void filter_phases(const Images& in, const Settings& s, const FloatOutput& color, const FloatOutput& variance, int begin, int end,
                   float* memory) {
  const AnyStops stops{in, s};
  Job job{color, variance, s.step, 0, 0, memory};
  fill_outside<AnyStops>(-job.apron(), kStride - job.apron(), job.outside_row());
  for (int turn = begin; turn < end;) {
    const Turn at = turn_at(turn, s.step, color.height);
    const int rows = std::min(end - turn, at.phase.count - at.index);
    for (job.left = 0; job.left < color.width; job.left += job.tile_width()) {
      job.right = std::min(color.width, job.left + job.tile_width());
      filter_tile(stops, job, at.phase, at.index, at.index + rows);
    }
    turn += rows;
  }
}

void FilterTurns(const Images& in, const Settings& s, const FloatOutput& color, const FloatOutput& variance, int begin, int end,
                 float* memory) {
  auto* filter = filter_phases<GuidedStops<Stops::dammertz, false>>;
  if (s.stops == Stops::joint_bilateral)
    filter = s.wide_normals ? filter_phases<GuidedStops<Stops::joint_bilateral, true>>
                            : filter_phases<GuidedStops<Stops::joint_bilateral, false>>;
  if (s.stops == Stops::svgf && in.depth_gradient)
    filter = s.wide_normals ? filter_phases<SvgfStops<true, true>> : filter_phases<SvgfStops<false, true>>;
  if (s.stops == Stops::svgf && !in.depth_gradient)
    filter = s.wide_normals ? filter_phases<SvgfStops<true, false>> : filter_phases<SvgfStops<false, false>>;
  filter(in, s, color, variance, begin, end, memory);
}

}  // namespace quell::atrous::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::atrous {

std::size_t scratch_bytes() { return (kRows + 2) * std::size_t{10 * 1040} * sizeof(float); }

HWY_EXPORT(FilterTurns);

void filter_turns(const Images& in, const Settings& settings, const FloatOutput& color, const FloatOutput& variance, int begin,
                  int end, float* scratch) {
  HWY_DYNAMIC_DISPATCH(FilterTurns)(in, settings, color, variance, begin, end, scratch);
}

}  // namespace quell::atrous
#endif
