// The images are worked on in tiles. A tile and an apron around it are first gathered in scratch memory, where taps that do not
// count (outside the image, no surface, not finite) have a color so far from all others that their weight is exactly 0. The loop
// over the taps is then the formula alone, without an edge or a mask in it.
//
// Error of a weight exp(-E), relative: 3.6e-6 (2^x) + 4.0e-6 E (angle) + 2e-7 E (roundings) + 2e-7 / sigma_plane sqrt(2 E) (the
// height over the plane is a difference). The center weighs 1, so that taps of large E are outweighed: a window of 33 x 33 taps
// of equal E is worst at E = 6, with 2.6e-5 where sigma_plane is 0.1. A result errs by at most twice that. Limits: colors below
// 1e18, positions below 1e9; points closer than 1e-15 coincide.
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

constexpr int kTileWidth = 128, kTileHeight = 8;  // px; with radius 16 a tile is 270 kB and stays in the second-level cache
constexpr int kPlanes = 9;                        // color, normal, position
constexpr int kNormal = 3, kPosition = 6;         // the first plane of each
constexpr float kFar = 1e18F;                     // red of a tap that does not count; its square is still finite
constexpr float kTiny = 1e-36F;                   // added to squared distances, which are then never 0

// Which terms a weight has, besides those of color and of the distance in pixels.
struct Terms {
  bool normal = false, wide_normals = false, position = false;
};

// Rows from `top` on, each of kPlanes planes one after the other, from pixel `left` on, in the coordinates of the image.
struct Tile {
  float* data;
  int stride, left, top;
  float* at(int x, int y) const { return data + static_cast<std::ptrdiff_t>(y - top) * kPlanes * stride + (x - left); }
};

// A row of a plane: the tile, its apron, and a vector that starts at the last pixel.
constexpr int tile_stride(int radius) { return (kTileWidth + 2 * radius + 16 + 15) / 16 * 16; }

}  // namespace quell::joint_bilateral
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::joint_bilateral::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

using Mask = hn::Mask<D>;

HWY_INLINE Mask is_finite(V3 v) { return hn::Eq(dot(v, {zero(), zero(), zero()}), zero()); }

HWY_INLINE void put(Mask counts, V3 v, float* to, int stride) {
  const D d;
  hn::StoreU(hn::IfThenElseZero(counts, v.x), d, to);
  hn::StoreU(hn::IfThenElseZero(counts, v.y), d, to + stride);
  hn::StoreU(hn::IfThenElseZero(counts, v.z), d, to + 2 * stride);
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
    put(counts, color, to, tile.stride);
    hn::StoreU(hn::IfThenElse(counts, color.x, set(kFar)), d, to);
    if constexpr (kTerms.normal) put(counts, normal, to + kNormal * tile.stride, tile.stride);
    if constexpr (kTerms.position) put(counts, position, to + kPosition * tile.stride, tile.stride);
  }
}

// Fills the rows of the tile that lie in the image.
template <Terms kTerms>
void gather(const Images& in, int radius, int y0, int y1, const Tile& tile) {
  const int x0 = std::max(0, tile.left), x1 = std::min(in.color.width, tile.left + kTileWidth + 2 * radius);
  for (int y = std::max(0, y0 - radius); y < std::min(in.color.height, y1 + radius); ++y) {
    float* row = tile.at(tile.left, y);
    std::fill_n(row, tile.stride, kFar);
    std::fill_n(row + tile.stride, (kPlanes - 1) * tile.stride, 0.0F);
    gather_row<kTerms>(in, y, x0, x1, tile);
  }
}

// Over the taps of a row, or of the window.
struct Sums {
  V weight;
  V3 color;
};

// The taps of one row, the leftmost at `tap`, for the pixels at `center`.
template <Terms kTerms>
HWY_INLINE Sums sum_taps(const Settings& s, const float* center, const float* tap, const float* distances, int stride) {
  const V gain = set(s.gain), limit = set(127.0F / s.gain);
  const V normal_factor = set(s.normal_factor), position_factor = set(s.position_factor);
  const V3 color0 = load(center, stride), normal0 = load(center + kNormal * stride, stride);
  const V3 position0 = load(center + kPosition * stride, stride), plane0 = mul(set(s.plane_factor), normal0);
  Sums sums{zero(), {zero(), zero(), zero()}};
  for (int i = 0; i <= 2 * s.radius; ++i, ++tap) {
    // The plane term comes first and is added last: its division takes as long as the other terms together.
    V squared_distance = zero(), plane_term = zero();
    if constexpr (kTerms.position) {
      const V3 way = sub(load(tap + kPosition * stride, stride), position0);
      const V height = dot(way, plane0);
      squared_distance = dot_add(way, way, set(kTiny));
      plane_term = hn::Div(hn::Mul(height, height), squared_distance);
    }
    const V3 color = load(tap, stride), contrast = sub(color, color0);
    V e = dot_add(contrast, contrast, set(distances[i]));
    if constexpr (kTerms.normal) {
      const V3 turn = sub(load(tap + kNormal * stride, stride), normal0);
      const V chord = dot(turn, turn);
      if constexpr (kTerms.wide_normals)
        e = hn::MulAdd(squared_angle_wide(chord), normal_factor, e);
      else
        e = hn::MulAdd(angle_ratio_narrow(chord, normal_factor), chord, e);
    }
    if constexpr (kTerms.position) e = hn::Add(hn::MulAdd(squared_distance, position_factor, e), plane_term);
    const V weight = exp2_negative(e, gain, limit);
    sums.weight = hn::Add(sums.weight, weight);
    sums.color = mul_add(weight, color, sums.color);
  }
  return sums;
}

// Filters the pixels [x, x + lanes) of row y; `end` is the first that is not wanted.
template <Terms kTerms>
void filter_pixels(const Images& in, const Settings& s, const FloatOutput& out, int x, int end, int y, const Tile& tile) {
  const D d;
  const int r = s.radius;
  const float* center = tile.at(x, y);
  Sums sums{zero(), {zero(), zero(), zero()}};
  // Rows are summed by themselves: thousands of additions to one float would cost more digits than the weights' errors.
  for (int dy = std::max(-r, -y); dy <= std::min(r, out.height - 1 - y); ++dy) {
    const float* distances = s.pixel_distances.data() + static_cast<std::ptrdiff_t>(std::abs(dy)) * (2 * r + 1);
    const Sums row = sum_taps<kTerms>(s, center, tile.at(x - r, y + dy), distances, tile.stride);
    sums.weight = hn::Add(sums.weight, row.weight);
    sums.color = add(sums.color, row.color);
  }
  const Mask counts = hn::Lt(hn::LoadU(d, center), set(kFar));
  const V3 own = load(in.color.row(y) + x, in.color.plane_stride);
  store(hn::IfThenElse(counts, hn::Div(sums.color.x, sums.weight), own.x), end - x, out.row(y, 0) + x);
  store(hn::IfThenElse(counts, hn::Div(sums.color.y, sums.weight), own.y), end - x, out.row(y, 1) + x);
  store(hn::IfThenElse(counts, hn::Div(sums.color.z, sums.weight), own.z), end - x, out.row(y, 2) + x);
}

template <Terms kTerms>
void filter_tiles(const Images& in, const Settings& s, const FloatOutput& out, int y0, int y1, float* scratch) {
  for (int top = y0; top < y1; top += kTileHeight)
    for (int left = 0; left < out.width; left += kTileWidth) {
      const int bottom = std::min(y1, top + kTileHeight), right = std::min(out.width, left + kTileWidth);
      const Tile tile{scratch, tile_stride(s.radius), left - s.radius, top - s.radius};
      gather<kTerms>(in, s.radius, top, bottom, tile);
      for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; x += lanes()) filter_pixels<kTerms>(in, s, out, x, right, y, tile);
    }
}

void FilterRows(const Images& in, const Settings& s, const FloatOutput& out, int y0, int y1, float* scratch) {
  const bool position = in.position && (in.normal || s.position_factor > 0);
  auto* filter = position ? filter_tiles<Terms{false, false, true}> : filter_tiles<Terms{}>;
  if (in.normal) filter = position ? filter_tiles<Terms{true, false, true}> : filter_tiles<Terms{true, false, false}>;
  if (in.normal && s.wide_normals)
    filter = position ? filter_tiles<Terms{true, true, true}> : filter_tiles<Terms{true, true, false}>;
  filter(in, s, out, y0, y1, scratch);
}

}  // namespace quell::joint_bilateral::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::joint_bilateral {

std::size_t scratch_bytes(int radius) {
  return static_cast<std::size_t>(kTileHeight + 2 * radius) * kPlanes * static_cast<std::size_t>(tile_stride(radius)) *
         sizeof(float);
}

HWY_EXPORT(FilterRows);

void filter_rows(const Images& in, const Settings& settings, const FloatOutput& out, int y0, int y1, float* scratch) {
  HWY_DYNAMIC_DISPATCH(FilterRows)(in, settings, out, y0, y1, scratch);
}

}  // namespace quell::joint_bilateral
#endif
