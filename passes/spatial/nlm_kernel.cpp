// The images are worked on in tiles, which are first gathered in scratch memory with an apron. For one offset after the other the
// distances of all pixels of a tile to those at the offset are found, averaged over patches by sums over columns and then over
// rows, and made weights of: each distance serves all patches that it is part of. Distances to pixels outside of the image are 0
// and are not counted.
//
// Error of a weight exp(-E), relative: 3.8e-6 (2^x) + 6e-7 E (reciprocal, roundings of sums over a patch).
#include "passes/spatial/nlm_kernel.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/spatial/nlm_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include "quell/simd/vectors-inl.h"

#ifndef QUELL_NLM_SHARED  // what is the same for all vector units
#define QUELL_NLM_SHARED
namespace quell::nlm {

constexpr int kTileWidth = 128, kTileHeight = 16;  // px
constexpr int kPadding = 16;                       // floats that a vector may reach past the end
constexpr int kPlanesOfFeature = 3 + 1 + 1;        // at most: itself, its variance, 1 over what is tolerated
constexpr int kPlanesOfColor = 3 + 3;              // at most: what patches are compared by, its variance; or those of luminance
constexpr float kEpsilon = 1e-10F;                 // of Rousselle et al. 2012: added to a denominator
constexpr float kFar = 1e30F;                      // as an exponent: a tap outside of the image

inline int apron(const Settings& s) { return std::max(s.radius + s.patch_radius, 1); }  // 1 for gradients
inline std::ptrdiff_t tile_stride(const Settings& s) { return kTileWidth + 2 * apron(s) + kPadding; }

// A tile with its apron: rows of planes. Pixels are named by their place in the image.
struct Tile {
  float* data;
  std::ptrdiff_t stride;
  int planes, left, top;
  float* at(int x, int y, int plane) const {
    return data + (static_cast<std::ptrdiff_t>(y - top) * planes + plane) * stride + (x - left);
  }
};

// What is found for one offset at a time, and over all of them.
struct Work {
  float *distances, *columns, *per_count, *far, *sums;
  std::ptrdiff_t stride;  // of all of them
};

// Where the planes of a feature are in a tile; variance -1: none.
struct FeaturePlanes {
  int first, channels, variance, per_tolerance;
  bool is_depth;
};
struct Layout {
  std::array<FeaturePlanes, kMaxFeatures> features;
  int planes;
};

inline Layout make_layout(const Images& in) {
  Layout layout{{}, kPlanesOfColor};
  for (int i = 0; i < in.feature_count; ++i) {
    const Feature& feature = in.features[static_cast<std::size_t>(i)];
    FeaturePlanes& planes = layout.features[static_cast<std::size_t>(i)];
    planes = {layout.planes, feature.image.channels, -1, 0, feature.is_depth};
    layout.planes += planes.channels;
    if (feature.variance) planes.variance = layout.planes++;
    planes.per_tolerance = layout.planes++;
  }
  return layout;
}

// The part of a row or column [0, size) whose pixels have one at the offset.
struct Range {
  int begin, end;
  bool contains(int i) const { return i >= begin && i < end; }
};
inline Range overlap(int size, int offset) { return {std::max(0, -offset), std::min(size, size - offset)}; }

// Pixels of a patch around `center` that lie in the range.
inline int count(Range range, int center, int radius) {
  return std::min(center + radius, range.end - 1) - std::max(center - radius, range.begin) + 1;
}

}  // namespace quell::nlm
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::nlm::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

HWY_INLINE V read(const float* from) { return hn::LoadU(D(), from); }
HWY_INLINE void write(V v, float* to) { hn::StoreU(v, D(), to); }

// The pixels [begin, end) of a plane, with zeros on both sides.
void gather_plane(const FloatImage& in, int y, int c, Range columns, const Tile& tile, int plane) {
  float* row = tile.at(tile.left, y, plane);
  std::fill_n(row, tile.stride, 0.0F);
  std::copy(in.row(y, c) + columns.begin, in.row(y, c) + columns.end, tile.at(columns.begin, y, plane));
}

// The same of a variance, which is at least 0: distances are divided by it.
void gather_variance(const FloatImage& in, int y, int c, Range columns, const Tile& tile, int plane) {
  gather_plane(in, y, c, columns, tile, plane);
  float* row = tile.at(columns.begin, y, plane);
  for (int i = 0; i < columns.end - columns.begin; ++i) row[i] = std::max(row[i], 0.0F);
}

void gather_row(const Images& in, const Layout& layout, int y, Range columns, const Tile& tile) {
  const int channels = in.variance.channels;
  for (int c = 0; c < channels; ++c) gather_variance(in.variance, y, c, columns, tile, 3 + c);
  for (int c = 0; c < 3; ++c) gather_plane(in.color, y, c, columns, tile, c);
  for (int x = columns.begin; x < columns.end && channels == 1; x += lanes())  // into a plane that is else of variance
    store(luminance(load(in.color.row(y) + x, in.color.plane_stride)), columns.end - x, tile.at(x, y, 4));
  for (int i = 0; i < in.feature_count; ++i) {
    const Feature& feature = in.features[static_cast<std::size_t>(i)];
    const FeaturePlanes& planes = layout.features[static_cast<std::size_t>(i)];
    for (int c = 0; c < planes.channels; ++c) gather_plane(feature.image, y, c, columns, tile, planes.first + c);
    if (planes.variance >= 0) gather_variance(feature.variance, y, 0, columns, tile, planes.variance);
  }
}

// The squared slope of a plane from one pixel to the next in one direction, by differences of `value` at the places before, at
// and after a pixel. Pixels that show nothing have no slope: where one of them stands beside, the difference is from the pixel
// itself.
template <class Value>
float squared_slope(int before, int at, int after, bool is_depth, const Value& value) {
  const auto is_known = [&](int place) { return !is_depth || value(place) < QUELL_NO_SURFACE_DEPTH; };
  if (!is_known(at)) return 0;
  if (!is_known(before)) before = at;
  if (!is_known(after)) after = at;
  if (before == after) return 0;
  const float slope = (value(after) - value(before)) / static_cast<float>(after - before);
  return slope * slope;
}

// 1 / (k^2 max(tau, variance, gradient^2)) of a feature at the pixels of `columns` in row y.
void find_tolerances(const Images& in, const Settings& s, const FeaturePlanes& planes, int y, Range columns, const Tile& tile) {
  const int above = std::max(y - 1, 0), below = std::min(y + 1, in.color.height - 1);
  for (int x = columns.begin; x < columns.end; ++x) {
    const int before = std::max(x - 1, 0), after = std::min(x + 1, in.color.width - 1);
    float gradient = 0;
    for (int c = planes.first; c < planes.first + planes.channels; ++c) {
      gradient += squared_slope(before, x, after, planes.is_depth, [&](int at) { return *tile.at(at, y, c); });
      gradient += squared_slope(above, y, below, planes.is_depth, [&](int at) { return *tile.at(x, at, c); });
    }
    const float variance = planes.variance >= 0 ? *tile.at(x, y, planes.variance) : 0;
    *tile.at(x, y, planes.per_tolerance) = 1 / (s.k_feature_squared * std::max({s.tau, variance, gradient}));
  }
}

// The distance of Rousselle et al. 2012 for nonuniform variance, summed over the channels, for the pixels [begin, end) of row y.
template <int kChannels>
void find_distances(const Settings& s, const Tile& tile, Range columns, int y, int dx, int dy, float* to) {
  constexpr int kValue = kChannels == 1 ? 4 : 0, kVariance = 3;
  const V k_squared = set(s.k_squared), alpha = set(s.alpha);
  for (int x = columns.begin; x < columns.end; x += lanes()) {
    V sum = zero();
    for (int c = 0; c < kChannels; ++c) {
      const V difference = hn::Sub(read(tile.at(x, y, kValue + c)), read(tile.at(x + dx, y + dy, kValue + c)));
      const V own = read(tile.at(x, y, kVariance + c)), other = read(tile.at(x + dx, y + dy, kVariance + c));
      const V noise = hn::Add(own, s.symmetric ? other : hn::Min(own, other));
      const V distance = hn::NegMulAdd(alpha, noise, hn::Mul(difference, difference));
      sum = hn::MulAdd(distance, reciprocal(hn::MulAdd(k_squared, hn::Add(own, other), set(kEpsilon))), sum);
    }
    write(sum, to + (x - columns.begin));
  }
}

// The largest of the features' distances (Rousselle et al. 2013), or 0.
HWY_INLINE V compare_features(const Layout& layout, int count, const Tile& tile, int x, int y, int dx, int dy) {
  V largest = zero();
  for (int i = 0; i < count; ++i) {
    const FeaturePlanes& planes = layout.features[static_cast<std::size_t>(i)];
    V distance = zero();
    for (int c = planes.first; c < planes.first + planes.channels; ++c) {
      const V difference = hn::Sub(read(tile.at(x, y, c)), read(tile.at(x + dx, y + dy, c)));
      distance = hn::MulAdd(difference, difference, distance);
    }
    if (planes.variance >= 0) {
      const V own = read(tile.at(x, y, planes.variance)), other = read(tile.at(x + dx, y + dy, planes.variance));
      distance = hn::Sub(distance, hn::Add(own, hn::Min(own, other)));
    }
    largest = hn::Max(largest, hn::Mul(distance, read(tile.at(x, y, planes.per_tolerance))));
  }
  return largest;
}

// A tile that is being filtered: columns [left, right) of rows [top, bottom).
struct Job {
  const Images& in;
  const Settings& s;
  const Layout& layout;
  Tile tile;
  Work work;
  int left, right, top, bottom;
};

// The tables of an offset: 1 over the pixels of a patch in a row, and whether there is a tap.
void prepare_columns(const Job& job, Range across, float per_channel) {
  for (int x = job.left; x < job.right; ++x) {
    const bool has_tap = across.contains(x);
    job.work.per_count[x - job.left] =
        has_tap ? per_channel / static_cast<float>(count(across, x, job.s.patch_radius)) : per_channel;
    job.work.far[x - job.left] = has_tap ? 0 : kFar;
  }
}

// The taps at an offset, of row y. `down` are the rows that have pixels there.
void add_taps(const Job& job, Range down, int y, int dx, int dy) {
  constexpr float kLog2E = 1.44269504F;
  const int f = job.s.patch_radius;
  const Work& work = job.work;
  const int first = std::max(y - f, down.begin), last = std::min(y + f, down.end - 1), width = job.right - job.left;
  const float* rows = work.distances + static_cast<std::ptrdiff_t>(first - (job.top - f)) * work.stride;
  for (int x = 0; x < width + 2 * f; x += lanes()) {
    V sum = zero();
    for (int row = 0; row <= last - first; ++row) sum = hn::Add(sum, read(rows + row * work.stride + x));
    write(sum, work.columns + x);
  }
  const V per_rows = set(1 / static_cast<float>(last - first + 1));
  float* sums = work.sums + static_cast<std::ptrdiff_t>(y - job.top) * 4 * work.stride;
  for (int x = 0; x < width; x += lanes()) {
    V patch = zero();
    for (int i = 0; i <= 2 * f; ++i) patch = hn::Add(patch, read(work.columns + x + i));
    const V distance = hn::Mul(patch, hn::Mul(per_rows, read(work.per_count + x)));
    V e = hn::Max(distance, compare_features(job.layout, job.in.feature_count, job.tile, job.left + x, y, dx, dy));
    e = hn::MulAdd(e, set(kLog2E), read(work.far + x));
    const V weight = exp2_negative(e, set(1.0F), set(127.0F));
    write(hn::Add(read(sums + x), weight), sums + x);
    for (int c = 0; c < 3; ++c) {
      float* sum = sums + (c + 1) * work.stride + x;
      write(hn::MulAdd(weight, read(job.tile.at(job.left + x + dx, y + dy, c)), read(sum)), sum);
    }
  }
}

template <int kChannels>
void add_offset(const Job& job, Range across, int dx, int dy) {
  const int f = job.s.patch_radius;
  const Range down = overlap(job.in.color.height, dy);
  const Range columns{std::max(job.left - f, across.begin), std::min(job.right + f, across.end)};
  for (int y = std::max(job.top - f, down.begin); y < std::min(job.bottom + f, down.end); ++y) {
    float* row = job.work.distances + static_cast<std::ptrdiff_t>(y - (job.top - f)) * job.work.stride;
    const int begin = columns.begin - (job.left - f), end = columns.end - (job.left - f);
    find_distances<kChannels>(job.s, job.tile, columns, y, dx, dy, row + begin);
    std::fill(row, row + begin, 0.0F);
    std::fill(row + end, row + job.work.stride, 0.0F);
  }
  for (int y = std::max(job.top, down.begin); y < std::min(job.bottom, down.end); ++y) add_taps(job, down, y, dx, dy);
}

template <int kChannels>
void filter_tile(const Job& job, const FloatOutput& out) {
  const int r = job.s.radius, f = job.s.patch_radius;
  std::fill_n(job.work.sums, (job.bottom - job.top) * 4 * job.work.stride, 0.0F);
  for (int dx = -r; dx <= r; ++dx) {
    const Range across = overlap(out.width, dx);
    if (std::max(job.left - f, across.begin) >= std::min(job.right + f, across.end)) continue;
    prepare_columns(job, across, 1.0F / kChannels);
    for (int dy = -r; dy <= r; ++dy) add_offset<kChannels>(job, across, dx, dy);
  }
  for (int y = job.top; y < job.bottom; ++y) {
    const float* sums = job.work.sums + static_cast<std::ptrdiff_t>(y - job.top) * 4 * job.work.stride;
    for (int x = 0; x < job.right - job.left; x += lanes()) {
      const V scale = hn::Div(set(1.0F), read(sums + x));  // the pixel itself weighs 1
      store(mul(scale, load(sums + job.work.stride + x, job.work.stride)), job.right - job.left - x, out.row(y) + job.left + x,
            out.plane_stride);
    }
  }
}

void FilterRows(const Images& in, const Settings& s, const FloatOutput& out, int y0, int y1, float* scratch) {
  const Layout layout = make_layout(in);
  const int a = apron(s), width = out.width, height = out.height;
  const std::ptrdiff_t stride = tile_stride(s);
  Work work{scratch, nullptr, nullptr, nullptr, nullptr, stride};
  work.columns = work.distances + (kTileHeight + 2 * s.patch_radius) * stride;
  work.per_count = work.columns + stride;
  work.far = work.per_count + stride;
  work.sums = work.far + stride;
  float* data = work.sums + 4 * kTileHeight * stride;
  for (int top = y0; top < y1; top += kTileHeight)
    for (int left = 0; left < width; left += kTileWidth) {
      const int bottom = std::min(top + kTileHeight, y1), right = std::min(left + kTileWidth, width);
      const Tile tile{data, stride, layout.planes, left - a, top - a};
      const Range columns{std::max(left - a, 0), std::min(right + a, width)};
      for (int y = std::max(top - a, 0); y < std::min(bottom + a, height); ++y) gather_row(in, layout, y, columns, tile);
      for (int i = 0; i < in.feature_count; ++i)
        for (int y = top; y < bottom; ++y)
          find_tolerances(in, s, layout.features[static_cast<std::size_t>(i)], y, {left, right}, tile);
      const Job job{in, s, layout, tile, work, left, right, top, bottom};
      in.variance.channels == 1 ? filter_tile<1>(job, out) : filter_tile<3>(job, out);
    }
}

}  // namespace quell::nlm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::nlm {

std::size_t scratch_bytes(const Settings& s, std::size_t features) {
  const auto rows = static_cast<std::size_t>(kTileHeight);
  const std::size_t planes = kPlanesOfColor + features * kPlanesOfFeature;
  const std::size_t work = rows + 2 * static_cast<std::size_t>(s.patch_radius) + 3 + 4 * rows;
  const std::size_t tile = (rows + 2 * static_cast<std::size_t>(apron(s))) * planes;
  return ((work + tile) * static_cast<std::size_t>(tile_stride(s)) + kPadding) * sizeof(float);
}

HWY_EXPORT(FilterRows);

void filter_rows(const Images& in, const Settings& settings, const FloatOutput& out, int y0, int y1, float* scratch) {
  HWY_DYNAMIC_DISPATCH(FilterRows)(in, settings, out, y0, y1, scratch);
}

}  // namespace quell::nlm
#endif
