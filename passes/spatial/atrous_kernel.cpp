// Rows that are a step apart are worked on one after the other, so that the five rows which a row is made of stay in the
// second-level cache whatever the level. Each is first gathered in scratch memory, in tiles, with an apron, where taps that do
// not count (outside the image, no surface, not finite) have a color or a luminance so far from all others that their weight is
// exactly 0. The loop over the taps is then the formula alone, without an edge or a mask in it.
//
// Error of a weight h 2^-E, relative, h being part of the exponent: 3.8e-6 (2^x) + 2e-7 E (roundings), with svgf + 1.5e-7 sigma_n
// (the cosine is a sum of rounded products) + 6e-7 l / (sigma_l deviation) (so are luminances, whose difference counts), with
// joint_bilateral + 4.3e-6 E (angle) + 2e-7 / sigma_plane sqrt(2 E) (the height over the plane is a difference). The pixel itself
// weighs 9/64, so that taps of large E are outweighed, and a result errs by at most twice that, a variance by four times. With
// sigma_n = 128 and luminances up to 40 sigma_l deviations that is 1e-4 at the very worst; roundings mostly cancel, and the tests
// see 1e-5. Only fireflies are not outweighed: then it counts that the series of the cosine's power is right to 1.5e-6
// absolutely, and to 1.4e-4 relatively while (n.n')^128 is above 2e-4.
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

}  // namespace quell::atrous
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::atrous::HWY_NAMESPACE {

constexpr int kRowFloats = kMaxPlanes * kStride;

// Where results go, and the columns [left, right) that are worked on.
struct Job {
  const FloatOutput& color;
  const FloatOutput& variance;
  int step, left, right;
  float* memory;  // kRows rows with an apron of the taps' reach, one that does not count, and one of what is prepared for a row
                  // of results

  int apron() const { return (kReach * step + 15) / 16 * 16; }
  int tile_width() const { return kStride - 2 * apron() - 16; }  // the last vector may start at the last pixel
  // The columns that are gathered; they begin where vectors do not cross cache lines.
  int first_read() const { return std::max(0, left - apron()); }
  int end_of_read() const { return std::min(color.width, right + kReach * step); }
  // The pixel at `left` of row `index` of a phase.
  float* row(int index) const { return memory + (index + kRows) % kRows * kRowFloats + apron(); }
  float* outside_row() const { return memory + kRows * kRowFloats + apron(); }
  float* prepared() const { return memory + (kRows + 1) * kRowFloats + 16; }
};

// Lays [begin, end) of a row, counted from the tile's left, outside of the image.
template <class AnyStops>
void fill_outside(int begin, int end, float* row) {
  for (int plane = 0; plane < AnyStops::kPlanes; ++plane)
    std::fill(row + plane * kStride + begin, row + plane * kStride + std::max(begin, end), AnyStops::outside(plane));
}

template <class AnyStops>
void gather_row(const AnyStops& stops, const Job& job, int y, float* row) {
  const int begin = job.first_read(), end = job.end_of_read();
  int x = begin;
  for (; x < end; x += lanes()) {
    const V3 color = pixels3(stops.in.color, x, y);
    const Mask counts = hn::And(hn::FirstN(D(), static_cast<std::size_t>(end - x)), is_finite(color));
    stops.gather(counts, color, x, y, row + (x - job.left));
  }
  if (x > end) fill_outside<AnyStops>(end - job.left, x - job.left, row);
}

// What lies outside of the image in the rows of a tile. No row that is gathered changes it.
template <class AnyStops>
void fill_aprons(const Job& job) {
  for (int index = 0; index < kRows; ++index) {
    fill_outside<AnyStops>(-job.apron(), job.first_read() - job.left, job.row(index));
    fill_outside<AnyStops>(job.end_of_read() - job.left, job.right - job.left + kReach * job.step + 16, job.row(index));
  }
}

struct Sums {
  V weight;
  V3 color;
  V variance;
};

// Where the taps of a row of pixels begin; those of a pair lie opposite to each other.
struct Taps {
  std::array<const float*, 2 * kPairs.size()> first;
  const float* center;
};

Taps find_taps(const Job& job, const Phase& phase, int index) {
  const auto row = [&](int dy) {
    const int tap = index + dy;
    return tap >= 0 && tap < phase.count ? job.row(tap) : job.outside_row();
  };
  Taps taps{{}, job.row(index)};
  for (std::size_t i = 0; i < kPairs.size(); ++i) {
    const int dx = static_cast<int>(kPairs[i].dx) * job.step, dy = static_cast<int>(kPairs[i].dy);
    taps.first[2 * i] = row(dy) + dx;
    taps.first[2 * i + 1] = row(-dy) - dx;
  }
  return taps;
}

template <class AnyStops>
HWY_INLINE void add_tap(V weight, const float* tap, Sums& sums) {
  sums.weight = hn::Add(sums.weight, weight);
  sums.color = mul_add(weight, at3(tap, 0), sums.color);
  sums.variance = hn::MulAdd(hn::Mul(weight, weight), at(tap, AnyStops::kVariance), sums.variance);
}

// In groups of pairs: a tap's way from the first to the last operation is so long that a processor cannot look far enough ahead
// to be busy with several, unless they go side by side.
template <class AnyStops>
HWY_INLINE Sums sum_taps(const AnyStops& stops, const typename AnyStops::Pixel& pixel, const Taps& taps, int x) {
  constexpr std::size_t kGroup = 2;
  const V own = set(kB3[0] * kB3[0]);
  Sums sums{own, mul(own, at3(taps.center + x, 0)), hn::Mul(hn::Mul(own, own), at(taps.center + x, AnyStops::kVariance))};
  for (std::size_t first = 0; first < kPairs.size(); first += kGroup) {
    V weight[2 * kGroup];
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kGroup; ++k) {
      const std::size_t i = first + k;
      const auto pair = stops.pair(pixel, i);
      weight[2 * k] = stops.exponent(pixel, pair, taps.first[2 * i] + x, i);
      weight[2 * k + 1] = stops.exponent(pixel, pair, taps.first[2 * i + 1] + x, i);
    }
#pragma GCC unroll 8
    for (V& w : weight) w = exp2(w);
#pragma GCC unroll 8
    for (std::size_t k = 0; k < 2 * kGroup; ++k) add_tap<AnyStops>(weight[k], taps.first[2 * first + k] + x, sums);
  }
  return sums;
}

// The row that is gathered after this one is filtered: memory yields it while there is arithmetic to do.
class Ahead {
 public:
  Ahead(const Images& in, int y) {  // no row when y is negative
    for (const FloatImage* image : {&in.color, &in.normal, &in.position, &in.depth, &in.variance})
      for (int c = 0; *image && y >= 0 && c < image->channels; ++c) planes_[count_++] = image->row(y, c);
  }
  HWY_INLINE void fetch(int x) const {
    constexpr int kToRead = 0, kSecondLevelCache = 2;
    for (int i = 0; i < count_; ++i) __builtin_prefetch(planes_[static_cast<std::size_t>(i)] + x, kToRead, kSecondLevelCache);
  }

 private:
  std::array<const float*, 11> planes_;
  int count_ = 0;
};

template <class AnyStops>
void filter_row(const AnyStops& stops, const Job& job, const Phase& phase, int index) {
  const int y = phase.first + index * job.step;
  const Taps taps = find_taps(job, phase, index);
  stops.prepare(taps.center, job.left, job.right, y, job.prepared());
  const Ahead ahead(stops.in, index + kReach + 1 < phase.count ? y + (kReach + 1) * job.step : -1);
  for (int x = job.left; x < job.right; x += lanes()) {
    const int column = x - job.left;
    const float* center = taps.center + column;
    ahead.fetch(x);
    const Sums sums = sum_taps(stops, stops.pixel(center, job.prepared() + column), taps, column);
    const V scale = hn::Div(set(1.0F), sums.weight);
    const Mask counts = hn::Lt(at(center, AnyStops::kCarrier), set(kFar));
    const V3 own = pixels3(stops.in.color, x, y);
    const V own_variance = stops.in.variance ? pixels(stops.in.variance, x, y) : zero();
    const int count = job.right - x;
    store(if_then_else(counts, mul(scale, sums.color), own), count, job.color.row(y) + x, job.color.plane_stride);
    store(hn::IfThenElse(counts, hn::Mul(sums.variance, hn::Mul(scale, scale)), own_variance), count, job.variance.row(y) + x);
  }
}

// Rows [begin, end) of a phase.
template <class AnyStops>
void filter_tile(const AnyStops& stops, const Job& job, const Phase& phase, int begin, int end) {
  const auto gather = [&](int index) {
    if (index >= 0 && index < phase.count) gather_row(stops, job, phase.first + index * job.step, job.row(index));
  };
  fill_aprons<AnyStops>(job);
  for (int index = begin - kReach; index < begin + kReach; ++index) gather(index);
  for (int index = begin; index < end; ++index) {
    gather(index + kReach);
    filter_row(stops, job, phase, index);
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

std::size_t scratch_bytes() { return std::size_t{(kRows + 2) * kMaxPlanes * kStride} * sizeof(float); }

HWY_EXPORT(FilterTurns);

void filter_turns(const Images& in, const Settings& settings, const FloatOutput& color, const FloatOutput& variance, int begin,
                  int end, float* scratch) {
  HWY_DYNAMIC_DISPATCH(FilterTurns)(in, settings, color, variance, begin, end, scratch);
}

}  // namespace quell::atrous
#endif
