// The images are worked on in tiles. A tile and an apron around it are first gathered in scratch memory, where taps that do not
// count (outside the image, no surface, not finite) have a color so far from all others that their weight is exactly 0. The loop
// over the taps is then the formula alone, without an edge or a mask in it.
//
// Error of a weight exp(-E), relative: 3.8e-6 (2^x) + 4.3e-6 E (angle) + 9e-7 E (roundings, reciprocal) + 2e-7 / sigma_plane
// sqrt(2 E) (the height over the plane is a difference). The center weighs 1, so that taps of large E are outweighed: where
// sigma_plane is 0.1, a window of 33 x 33 taps of equal E is worst at E = 5.3, with 3.2e-5, one of 129 x 129 at E = 7.6, with
// 4.6e-5. A result errs by at most twice that; roundings mostly cancel, and renderings see 2e-6. Limits: colors below 1e18,
// positions below 1e9; points closer than 1e-15 coincide.
#include "passes/spatial/joint_bilateral_kernel.h"

#include <algorithm>
#include <cstdlib>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/spatial/joint_bilateral_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include "quell/simd/vectors-inl.h"

#ifndef QUELL_JOINT_BILATERAL_SHARED  // what is the same for all vector units
#define QUELL_JOINT_BILATERAL_SHARED
namespace quell::joint_bilateral {

constexpr int kTileWidth = 128, kTileHeight = 8;  // px; with radius 16 a tile is 230 kB and stays in the second-level cache
// Floats from a plane to the next in a tile: its width, its apron, and a vector that starts at the last pixel. One for all radii:
// an address is then a row and a constant.
constexpr int kStride = kTileWidth + 2 * kMaxRadius + 16;
constexpr int kPlanes = 9;                 // color, normal, position
constexpr int kNormal = 3, kPosition = 6;  // the first plane of each
constexpr float kFar = 1e18F;              // red of a tap that does not count; its square is still finite
constexpr float kTiny = 1e-36F;            // added to squared distances, which are then never 0

// Which terms a weight has, besides those of color and of the distance in pixels.
struct Terms {
  bool normal = false;
  NormalTerm normal_term = NormalTerm::narrow_angle;
  bool position = false;
  bool z = false;  // of the position
};

// Rows from `top` on, each of kPlanes planes one after the other, from pixel `left` on, in the coordinates of the image.
struct Tile {
  float* data;
  int left, top;
  float* at(int x, int y) const { return data + static_cast<std::ptrdiff_t>(y - top) * kPlanes * kStride + (x - left); }
};

}  // namespace quell::joint_bilateral
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::joint_bilateral::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

using Mask = hn::Mask<D>;

HWY_INLINE Mask is_finite(V3 v) { return hn::Eq(dot(v, {zero(), zero(), zero()}), zero()); }

// Three planes of a tile, from that of `first` on.
HWY_INLINE V3 get(const float* first) { return load(first, kStride); }
HWY_INLINE void put(Mask counts, V3 v, float* to) {
  const D d;
  hn::StoreU(hn::IfThenElseZero(counts, v.x), d, to);
  hn::StoreU(hn::IfThenElseZero(counts, v.y), d, to + kStride);
  hn::StoreU(hn::IfThenElseZero(counts, v.z), d, to + 2 * kStride);
}

// Copies pixels [x0, x1) of row y into the tile.
template <Terms kTerms>
void gather_row(const Images& in, int y, int x0, int x1, const Tile& tile) {
  const D d;
  for (int x = x0; x < x1; x += lanes()) {
    float* to = tile.at(x, y);
    V3 color = load(in.color.row(y) + x, in.color.plane_stride), normal{}, position{};
    Mask counts = hn::And(hn::FirstN(d, static_cast<std::size_t>(x1 - x)), is_finite(color));
    if constexpr (kTerms.normal) {
      normal = load(in.normal.row(y) + x, in.normal.plane_stride);
      counts = hn::And(counts, hn::And(is_finite(normal), hn::Gt(dot(normal, normal), zero())));
    }
    if constexpr (kTerms.position) {
      position = load(in.position.row(y) + x, in.position.plane_stride);
      counts = hn::And(counts, is_finite(position));
    }
    put(counts, color, to);
    hn::StoreU(hn::IfThenElse(counts, color.x, set(kFar)), d, to);
    if constexpr (kTerms.normal) put(counts, normal, to + kNormal * kStride);
    if constexpr (kTerms.position) put(counts, position, to + kPosition * kStride);
  }
}

// Lays pixels [x0, x1) of a row outside of the image.
inline void fill_outside(int x0, int x1, int y, const Tile& tile) {
  for (int plane = 0; plane < kPlanes && x0 < x1; ++plane)
    std::fill_n(tile.at(x0, y) + plane * kStride, x1 - x0, plane == 0 ? kFar : 0.0F);
}

// Fills the rows of the tile that lie in the image.
template <Terms kTerms>
void gather(const Images& in, const Settings& s, int y0, int y1, const Tile& tile) {
  const int end = tile.left + kTileWidth + 2 * s.radius_x, x0 = std::max(0, tile.left), x1 = std::min(in.color.width, end);
  for (int y = std::max(0, y0 - s.radius_y); y < std::min(in.color.height, y1 + s.radius_y); ++y) {
    fill_outside(tile.left, x0, y, tile);
    fill_outside(x1, end + kMaxLanes, y, tile);
    gather_row<kTerms>(in, y, x0, x1, tile);
  }
}

// Over the taps of a row, or of the window.
struct Sums {
  V weight;
  V3 color;
};

// What the weights of a pixel's taps are made of besides the taps.
struct Center {
  V3 color, normal, position, plane;
};

template <Terms kTerms>
Center load_center(const Settings& s, const float* pixel) {
  Center center{};
  center.color = get(pixel);
  if constexpr (kTerms.normal) center.normal = get(pixel + kNormal * kStride);
  if constexpr (kTerms.normal) center.plane = mul(set(s.plane_factor), center.normal);
  if constexpr (kTerms.position) center.position = get(pixel + kPosition * kStride);
  return center;
}

// In what a tap differs from the center.
struct Differences {
  V color;                     // squared distance of color, and the part of the exponent that depends on the distance in pixels
  V chord;                     // squared distance of normals
  V height, squared_distance;  // of positions: over the plane, scaled, or the squared difference of z; and in all
};

template <Terms kTerms>
HWY_INLINE Differences find_differences(const Center& center, const float* tap, float pixel_distance) {
  Differences d{};
  if constexpr (kTerms.position) {
    const V3 way = sub(center.position, get(tap + kPosition * kStride));
    if constexpr (kTerms.z)
      d.height = hn::Mul(way.z, way.z);
    else if constexpr (kTerms.normal)
      d.height = dot(way, center.plane);
    d.squared_distance = dot_add(way, way, set(kTiny));
  }
  if constexpr (kTerms.normal) {
    const V3 turn = sub(center.normal, get(tap + kNormal * kStride));
    d.chord = dot(turn, turn);
  }
  const V3 contrast = sub(center.color, get(tap));
  d.color = dot_add(contrast, contrast, set(pixel_distance));
  return d;
}

template <Terms kTerms>
HWY_INLINE V find_exponent(const Settings& s, const Differences& d) {
  V e = d.color;
  if constexpr (kTerms.position) e = hn::MulAdd(d.squared_distance, set(s.position_factor), e);
  if constexpr (kTerms.position && kTerms.z) {
    e = hn::MulAdd(d.height, set(s.z_factor), e);
  } else if constexpr (kTerms.position && kTerms.normal) {
    // height^2 / distance^2, by an estimate r of 1 / distance^2 and a step of Newton's: (height r) (height (2 - distance^2 r))
    const V r = estimate_reciprocal(d.squared_distance);
    const V rest = hn::NegMulAdd(d.squared_distance, r, set(2.0F));
    e = hn::MulAdd(hn::Mul(d.height, r), hn::Mul(d.height, rest), e);
  }
  if constexpr (kTerms.normal && kTerms.normal_term == NormalTerm::narrow_angle)
    e = hn::MulAdd(angle_ratio_narrow(d.chord, set(s.normal_factor)), d.chord, e);
  else if constexpr (kTerms.normal && kTerms.normal_term == NormalTerm::wide_angle)
    e = hn::MulAdd(squared_angle_wide(d.chord), set(s.normal_factor), e);
  else if constexpr (kTerms.normal)
    e = hn::MulAdd(d.chord, set(s.normal_factor), e);
  return e;
}

HWY_INLINE void add_tap(const Settings& s, V e, const float* tap, Sums& sums) {
  const V weight = exp2_negative(e, set(s.gain), set(127.0F / s.gain));
  sums.weight = hn::Add(sums.weight, weight);
  sums.color = mul_add(weight, get(tap), sums.color);
}

// The taps of one row, the leftmost at `tap`, for the pixels at `center`.
template <Terms kTerms>
HWY_INLINE Sums sum_taps(const Settings& s, const Center& center, const float* tap, const float* distances) {
  Sums sums{zero(), {zero(), zero(), zero()}};
  // Each round ends one tap, is in the midst of the next, and begins the one after that: the results that a tap would otherwise
  // wait for are there when it goes on.
  const auto begin = [&](int i) { return find_differences<kTerms>(center, tap + i, distances[i]); };
  const int last = 2 * s.radius_x;
  Differences next = begin(0);
  V e = find_exponent<kTerms>(s, next);
  if (last > 0) next = begin(1);
  for (int i = 0; i < last; ++i) {
    add_tap(s, e, tap + i, sums);
    e = find_exponent<kTerms>(s, next);
    if (i + 2 <= last) next = begin(i + 2);
  }
  add_tap(s, e, tap + last, sums);
  return sums;
}

// Filters the pixels [x, x + lanes) of row y; `end` is the first that is not wanted.
template <Terms kTerms>
void filter_pixels(const Images& in, const Settings& s, const FloatOutput& out, int x, int end, int y, const Tile& tile) {
  const Center center = load_center<kTerms>(s, tile.at(x, y));
  Sums sums{zero(), {zero(), zero(), zero()}};
  // Rows are summed by themselves: thousands of additions to one float would cost more digits than the weights' errors.
  const TapRange rows = clamped_taps(y, s.radius_y, out.height);
  for (int dy = rows.first; dy <= rows.last; ++dy) {
    const float* distances = s.pixel_distances.data() + static_cast<std::ptrdiff_t>(std::abs(dy)) * (2 * s.radius_x + 1);
    const Sums row = sum_taps<kTerms>(s, center, tile.at(x - s.radius_x, y + dy), distances);
    sums.weight = hn::Add(sums.weight, row.weight);
    sums.color = add(sums.color, row.color);
  }
  const Mask counts = hn::Lt(center.color.x, set(kFar));
  const V3 own = load(in.color.row(y) + x, in.color.plane_stride);
  const V3 mean{hn::Div(sums.color.x, sums.weight), hn::Div(sums.color.y, sums.weight), hn::Div(sums.color.z, sums.weight)};
  store(if_then_else(counts, mean, own), end - x, out.row(y) + x, out.plane_stride);
}

template <Terms kTerms>
void filter_tiles(const Images& in, const Settings& s, const FloatOutput& out, int y0, int y1, float* scratch) {
  for (int top = y0; top < y1; top += kTileHeight)
    for (int left = 0; left < out.width; left += kTileWidth) {
      const int bottom = std::min(y1, top + kTileHeight), right = std::min(out.width, left + kTileWidth);
      const Tile tile{scratch, left - s.radius_x, top - s.radius_y};
      gather<kTerms>(in, s, top, bottom, tile);
      for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; x += lanes()) filter_pixels<kTerms>(in, s, out, x, right, y, tile);
    }
}

using Filter = void (*)(const Images& in, const Settings& s, const FloatOutput& out, int y0, int y1, float* scratch);

template <NormalTerm kTerm>
Filter find_filter(bool position, bool z) {
  if (!position) return filter_tiles<Terms{true, kTerm, false, false}>;
  return z ? filter_tiles<Terms{true, kTerm, true, true}> : filter_tiles<Terms{true, kTerm, true, false}>;
}

void FilterRows(const Images& in, const Settings& s, const FloatOutput& out, int y0, int y1, float* scratch) {
  const bool z = in.position && s.compares_z, position = in.position && (in.normal || z || s.position_factor > 0);
  Filter filter = position ? filter_tiles<Terms{.position = true}> : filter_tiles<Terms{}>;
  if (z) filter = filter_tiles<Terms{.position = true, .z = true}>;
  if (in.normal) {
    filter = find_filter<NormalTerm::narrow_angle>(position, z);
    if (s.normal_term == NormalTerm::wide_angle) filter = find_filter<NormalTerm::wide_angle>(position, z);
    if (s.normal_term == NormalTerm::difference) filter = find_filter<NormalTerm::difference>(position, z);
  }
  filter(in, s, out, y0, y1, scratch);
}

}  // namespace quell::joint_bilateral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::joint_bilateral {

std::size_t scratch_bytes(int radius_y) {
  return static_cast<std::size_t>(kTileHeight + 2 * radius_y) * kPlanes * kStride * sizeof(float);
}

HWY_EXPORT(FilterRows);

void filter_rows(const Images& in, const Settings& settings, const FloatOutput& out, int y0, int y1, float* scratch) {
  HWY_DYNAMIC_DISPATCH(FilterRows)(in, settings, out, y0, y1, scratch);
}

}  // namespace quell::joint_bilateral
#endif
