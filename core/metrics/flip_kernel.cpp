// A tile is worked on in three steps: both pictures are brought into the opponent space, with an apron as wide as the filters, in
// which the pixels at the picture's border go on; then each row is filtered across rows, and what comes of it along the row,
// together with all that follows for each pixel. The rows between the two, 46 kB, stay in the nearest caches.
//
// Filters of features are sums of differences from the center, or of opposite pixels, so that flat areas give exactly 0 before
// kFlipEdgeRounding is added: features enter by a square root, which makes much of a rounding.
#include "quell/metrics/flip_kernel.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/metrics/flip_kernel.cpp"  // from the repository root
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include "quell/metrics/flip_math-inl.h"

#ifndef QUELL_FLIP_KERNEL_SHARED  // what is the same for all vector units
#define QUELL_FLIP_KERNEL_SHARED
namespace quell::flip_kernel {

constexpr int kMostLanes = 16;
constexpr int kRowsAhead = 3;  // of the row being read; the machine's own prefetching ends with each row of a tile
constexpr int kOpponents = 3;  // planes of a picture in the opponent space: luma, red-green, blue-yellow

// Planes of a picture that was filtered across rows. Blue-yellow was filtered by both of its Gaussians, luma by all its filters.
enum Filtered { kLuma, kRedGreen, kFirst, kSecond, kSmooth, kEdge, kPoint, kFilteredPlanes };

// Rows of what an observer sees: colors of the reference, each followed by those of the image, and how much features differ.
enum Seen { kSeenLuma = 0, kSeenRedGreen = 2, kSeenBlueYellow = 4, kSeenFeature = 6, kSeenPlanes = 7 };

// Where in the scratch memory things lie. Rows begin `radius` pixels left of the tile; planes of the reference come before those
// of the image.
struct Layout {
  int radius, stride;
  std::ptrdiff_t plane;  // elements of a plane in the opponent space
  explicit Layout(int filter_radius)
      : radius(filter_radius),
        stride((kTileWidth + 2 * filter_radius + 2 * kMostLanes + 15) / 16 * 16),
        plane(static_cast<std::ptrdiff_t>(kTileHeight + 2 * filter_radius) * stride) {}
  std::size_t size() const {
    return tile_errors() + static_cast<std::size_t>(2 * kOpponents * plane + 2 * kFilteredPlanes * stride) +
           std::size_t{kSeenPlanes} * kTileWidth;
  }
  float* opponent(float* scratch) const { return scratch + tile_errors(); }
  float* filtered(float* scratch) const { return opponent(scratch) + 2 * kOpponents * plane; }
  float* seen(float* scratch) const { return filtered(scratch) + 2 * kFilteredPlanes * stride; }
};

using Matrix3f = std::array<std::array<float, 3>, 3>;
inline Matrix3f to_float(const Matrix3& m) {
  Matrix3f result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[i][j] = static_cast<float>(m[i][j]);
  return result;
}

// What the formulas of a pixel need.
struct Constants {
  Matrix3f to_opponent = to_float(kRgbToOpponent), to_rgb = to_float(kOpponentToRgb), to_xyz = to_float(kRgbToXyz);
  float knee, log_knee_slope, rest;  // of color differences: see color_error()
  Constants() {
    const FlipRange range = flip_range();
    knee = static_cast<float>(range.knee);
    log_knee_slope = static_cast<float>(std::log2(kFlipKneeError / range.knee));
    rest = static_cast<float>((1 - kFlipKneeError) / (range.largest - range.knee));
  }
};
inline const Constants& constants() {
  static const Constants result;
  return result;
}

}  // namespace quell::flip_kernel
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::flip_kernel::HWY_NAMESPACE {
using namespace flip_math::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

// The same of the reference and the image.
struct Pair {
  V a, b;
};
HWY_INLINE Pair load_pair(const float* from, std::ptrdiff_t to_image) {
  return {hn::LoadU(D(), from), hn::LoadU(D(), from + to_image)};
}
HWY_INLINE void store_pair(Pair v, float* to, std::ptrdiff_t to_image) {
  hn::StoreU(v.a, D(), to);
  hn::StoreU(v.b, D(), to + to_image);
}
HWY_INLINE Pair add(Pair p, Pair q) { return {hn::Add(p.a, q.a), hn::Add(p.b, q.b)}; }
HWY_INLINE Pair sub(Pair p, Pair q) { return {hn::Sub(p.a, q.a), hn::Sub(p.b, q.b)}; }
HWY_INLINE Pair mul(V w, Pair p) { return {hn::Mul(w, p.a), hn::Mul(w, p.b)}; }
HWY_INLINE Pair mul_add(V w, Pair p, Pair q) { return {hn::MulAdd(w, p.a, q.a), hn::MulAdd(w, p.b, q.b)}; }

// Pixels at a distance on either side of the center: their sum, and how much the later one is larger.
struct Sides {
  const float* center;
  std::ptrdiff_t step, to_image;
  HWY_INLINE Pair before(int i) const { return load_pair(center - i * step, to_image); }
  HWY_INLINE Pair after(int i) const { return load_pair(center + i * step, to_image); }
  HWY_INLINE Pair sum(int i) const { return add(before(i), after(i)); }
};

// ---- To the opponent space ----

HWY_INLINE V tone_map(V x, V gain) {
  const auto k = [](std::size_t i) { return set(static_cast<float>(kFlipCurve[i])); };
  x = hn::Min(hn::Mul(hn::Max(x, zero()), gain), set(64.0F));  // the curve reaches 1 at 12.1
  return hn::Div(hn::Mul(x, hn::MulAdd(x, k(0), k(1))), hn::MulAdd(x, hn::MulAdd(x, k(2), k(3)), k(4)));
}

HWY_INLINE V row_dot(const std::array<float, 3>& row, V3 v) {
  return hn::MulAdd(set(row[2]), v.z, hn::MulAdd(set(row[1]), v.y, hn::Mul(set(row[0]), v.x)));
}
HWY_INLINE V3 times(const Matrix3f& m, V3 v) { return {row_dot(m[0], v), row_dot(m[1], v), row_dot(m[2], v)}; }
HWY_INLINE V clamp(V v) { return hn::Min(hn::Max(v, zero()), set(1.0F)); }
HWY_INLINE V3 clamp(V3 v) { return {clamp(v.x), clamp(v.y), clamp(v.z)}; }

// Pixels from `left` on of row y into three planes at `to`; the row and its first pixel may lie outside the picture.
template <bool kToneMap>
void convert_row(const Constants& k, FloatImage image, int left, int y, float gain, const Layout& layout, float* to) {
  const D d;
  const int end = layout.stride - kMostLanes;  // the last vector may end in the slack behind it
  const int first = std::max(0, -left), last = std::min(end, image.width - left);
  const float* row = image.row(std::clamp(y, 0, image.height - 1));
  const float* soon = image.row(std::clamp(y + kRowsAhead, 0, image.height - 1));
  for (int x = first; x < last; x += lanes()) {
    V3 rgb = load(row + (left + x), image.plane_stride);
    for (int c = 0; c < 3; ++c) hwy::Prefetch(soon + c * image.plane_stride + (left + x));
    if constexpr (kToneMap) rgb = {tone_map(rgb.x, set(gain)), tone_map(rgb.y, set(gain)), tone_map(rgb.z, set(gain))};
    const V3 opponent = times(k.to_opponent, clamp(rgb));
    hn::StoreU(opponent.x, d, to + x);
    hn::StoreU(opponent.y, d, to + layout.plane + x);
    hn::StoreU(opponent.z, d, to + 2 * layout.plane + x);
  }
  for (int c = 0; c < kOpponents; ++c, to += layout.plane) {
    std::fill_n(to, first, to[first]);
    std::fill(to + last, to + end + kMostLanes, to[last - 1]);
  }
}

template <bool kToneMap>
void convert(const Tile& tile, float gain, const Layout& layout, float* opponent) {
  for (const FloatImage& image : {tile.reference, tile.image}) {
    for (int i = 0; i < tile.height + 2 * layout.radius; ++i)
      convert_row<kToneMap>(constants(), image, tile.x - layout.radius, tile.y - layout.radius + i, gain, layout,
                            opponent + static_cast<std::ptrdiff_t>(i) * layout.stride);
    opponent += kOpponents * layout.plane;
  }
}

// ---- Filters ----

// Luma's filters across rows.
HWY_INLINE void filter_luma(const Weights& w, Sides at, float* to, int stride, std::ptrdiff_t to_image) {
  const Pair center = load_pair(at.center, at.to_image), twice = add(center, center);
  Pair blur = mul(set(w.luma[0].blur), center), smooth = center, edge{zero(), zero()}, point = edge;
  const int taps = static_cast<int>(w.luma.size());
  const auto features = [&](const Weights::Luma& tap, Pair before, Pair after, Pair sum) HWY_ATTR {
    const Pair above_center = sub(sum, twice);
    smooth = mul_add(set(tap.smooth), above_center, smooth);
    point = mul_add(set(tap.point), above_center, point);
    edge = mul_add(set(tap.edge), sub(after, before), edge);
  };
  int i = 1;
  for (; i < w.blur_taps; ++i) {
    const Weights::Luma& tap = w.luma[static_cast<std::size_t>(i)];
    const Pair before = at.before(i), after = at.after(i), sum = add(before, after);
    blur = mul_add(set(tap.blur), sum, blur);
    features(tap, before, after, sum);
  }
  for (; i < taps; ++i) {
    const Pair before = at.before(i), after = at.after(i);
    features(w.luma[static_cast<std::size_t>(i)], before, after, add(before, after));
  }
  store_pair(blur, to + kLuma * stride, to_image);
  store_pair(smooth, to + kSmooth * stride, to_image);
  store_pair(edge, to + kEdge * stride, to_image);
  store_pair(point, to + kPoint * stride, to_image);
}

HWY_INLINE Pair blur_red_green(const Weights& w, Sides at) {
  Pair blur = mul(set(w.red_green[0]), load_pair(at.center, at.to_image));
  for (int i = 1; i < static_cast<int>(w.red_green.size()); ++i)
    blur = mul_add(set(w.red_green[static_cast<std::size_t>(i)]), at.sum(i), blur);
  return blur;
}

HWY_INLINE void filter_blue_yellow(const Weights& w, Sides at, float* to, int stride, std::ptrdiff_t to_image) {
  const Pair center = load_pair(at.center, at.to_image);
  Pair first = mul(set(w.blue_yellow[0].first), center), second = mul(set(w.blue_yellow[0].second), center);
  for (int i = 1; i < static_cast<int>(w.blue_yellow.size()); ++i) {
    const Pair sum = at.sum(i);
    first = mul_add(set(w.blue_yellow[static_cast<std::size_t>(i)].first), sum, first);
    second = mul_add(set(w.blue_yellow[static_cast<std::size_t>(i)].second), sum, second);
  }
  store_pair(first, to + kFirst * stride, to_image);
  store_pair(second, to + kSecond * stride, to_image);
}

// One row, with its apron to the left and right, filtered across rows.
void filter_across(const Weights& w, const Layout& layout, int width, const float* opponent, float* to) {
  const std::ptrdiff_t to_image = kOpponents * layout.plane, filtered_image = std::ptrdiff_t{kFilteredPlanes} * layout.stride;
  for (int x = 0; x < width + 2 * layout.radius; x += lanes()) {
    filter_luma(w, {opponent + x, layout.stride, to_image}, to + x, layout.stride, filtered_image);
    store_pair(blur_red_green(w, {opponent + layout.plane + x, layout.stride, to_image}), to + kRedGreen * layout.stride + x,
               filtered_image);
    filter_blue_yellow(w, {opponent + 2 * layout.plane + x, layout.stride, to_image}, to + x, layout.stride, filtered_image);
  }
}

// Along a row.
HWY_INLINE Pair blur_luma(const Weights& w, Sides at) {
  Pair blur = mul(set(w.luma[0].blur), load_pair(at.center, at.to_image));
  for (int i = 1; i < w.blur_taps; ++i) blur = mul_add(set(w.luma[static_cast<std::size_t>(i)].blur), at.sum(i), blur);
  return blur;
}
HWY_INLINE Pair blur_blue_yellow(const Weights& w, Sides first, Sides second) {
  Pair blur = mul(set(w.blue_yellow[0].first), load_pair(first.center, first.to_image));
  blur = mul_add(set(w.blue_yellow[0].second), load_pair(second.center, second.to_image), blur);
  for (int i = 1; i < static_cast<int>(w.blue_yellow.size()); ++i) {
    blur = mul_add(set(w.blue_yellow[static_cast<std::size_t>(i)].first), first.sum(i), blur);
    blur = mul_add(set(w.blue_yellow[static_cast<std::size_t>(i)].second), second.sum(i), blur);
  }
  return blur;
}

// ---- Errors ----

HWY_INLINE V length(V x, V y) { return hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y))); }
HWY_INLINE V difference(Pair x, Pair y) { return hn::AbsDiff(length(x.a, y.a), length(x.b, y.b)); }

// By how much edges or points, whichever differ more, do.
HWY_INLINE V feature_difference(const Weights& w, Sides smooth, Sides edge, Sides point) {
  const Pair center = load_pair(smooth.center, smooth.to_image), twice = add(center, center);
  Pair edge_x = mul(set(kFlipEdgeRounding), center), point_x{zero(), zero()};
  Pair edge_y = mul_add(set(w.luma[0].smooth), load_pair(edge.center, edge.to_image), edge_x);
  Pair point_y = mul(set(w.luma[0].smooth), load_pair(point.center, point.to_image));
  for (int i = 1; i < static_cast<int>(w.luma.size()); ++i) {
    const Weights::Luma& tap = w.luma[static_cast<std::size_t>(i)];
    const Pair before = smooth.before(i), after = smooth.after(i);
    edge_x = mul_add(set(tap.edge), sub(after, before), edge_x);
    point_x = mul_add(set(tap.point), sub(add(after, before), twice), point_x);
    edge_y = mul_add(set(tap.smooth), edge.sum(i), edge_y);
    point_y = mul_add(set(tap.smooth), point.sum(i), point_y);
  }
  return hn::Max(difference(edge_x, edge_y), difference(point_x, point_y));
}

// CIELAB's curve.
HWY_INLINE V lab_curve(V t) {
  const V knee = set(216.0F / 24389);
  const V line = hn::MulAdd(t, set(24389.0F / 27 / 116), set(16.0F / 116));
  return hn::IfThenElse(hn::Gt(t, knee), cube_root(hn::Max(t, knee)), line);
}
// L, and a and b made smaller by 0.01 L (Hunt).
HWY_INLINE V3 adjusted_lab(const Constants& k, V3 opponent) {
  const V3 xyz = times(k.to_xyz, clamp(times(k.to_rgb, opponent)));
  const V fx = lab_curve(xyz.x), fy = lab_curve(xyz.y), fz = lab_curve(xyz.z);
  const V l = hn::MulAdd(fy, set(116.0F), set(-16.0F));
  return {l, hn::Mul(hn::Mul(l, set(5.0F)), hn::Sub(fx, fy)), hn::Mul(hn::Mul(l, set(2.0F)), hn::Sub(fy, fz))};
}

// (HyAB^0.7 mapped to 0..1)^(1 - sqrt(feature / sqrt(2))). The map is linear up to the knee, so that there its logarithm needs no
// power.
HWY_INLINE V error_of(const Constants& k, V3 a, V3 b, V feature) {
  const V3 apart = sub(a, b);
  const V hyab = hn::Add(hn::Abs(apart.x), length(apart.y, apart.z));
  const V log_power = hn::Mul(log2_of(hn::Max(hyab, set(1e-30F))), set(static_cast<float>(kFlipColorPower)));
  const V power = exp2_of(log_power);
  const V below_1 = hn::NegMulAdd(hn::Sub(power, set(k.knee)), set(k.rest), set(static_cast<float>(1 - kFlipKneeError)));
  const V beyond = log2_of_nearly_1(hn::Max(below_1, zero()));
  const V below = hn::Add(log_power, set(k.log_knee_slope));
  const V log_color = hn::IfThenElse(hn::Lt(power, set(k.knee)), below, beyond);
  const V root = hn::Sqrt(hn::Min(hn::Mul(feature, set(0.707106781F)), set(1.0F)));
  const V error = exp2_of(hn::NegMulAdd(log_color, root, log_color));
  return hn::IfThenElseZero(hn::Gt(hyab, zero()), hn::Min(error, set(1.0F)));
}

// Filters the row along, to the planes of Seen. Errors follow in a loop of their own, so that a pixel's long formula runs beside
// those of the next.
void filter_along(const Weights& w, const Layout& layout, int width, const float* filtered, float* seen) {
  const std::ptrdiff_t to_image = std::ptrdiff_t{kFilteredPlanes} * layout.stride;
  for (int x = 0; x < width; x += lanes()) {
    const auto at = [&](Filtered plane) HWY_ATTR {
      return Sides{filtered + plane * layout.stride + layout.radius + x, 1, to_image};
    };
    const auto store_seen = [&](Pair v, Seen plane) HWY_ATTR { store_pair(v, seen + plane * kTileWidth + x, kTileWidth); };
    store_seen(blur_luma(w, at(kLuma)), kSeenLuma);
    store_seen(blur_red_green(w, at(kRedGreen)), kSeenRedGreen);
    store_seen(blur_blue_yellow(w, at(kFirst), at(kSecond)), kSeenBlueYellow);
    hn::StoreU(feature_difference(w, at(kSmooth), at(kEdge), at(kPoint)), D(), seen + kSeenFeature * kTileWidth + x);
  }
}

template <bool kLargest>
void finish_row(int width, const float* seen, float* errors) {
  const D d;
  const Constants& k = constants();
  for (int x = 0; x < width; x += lanes()) {
    const auto of = [&](int plane) HWY_ATTR { return hn::LoadU(d, seen + plane * kTileWidth + x); };
    const V3 reference{of(kSeenLuma), of(kSeenRedGreen), of(kSeenBlueYellow)};
    const V3 image{of(kSeenLuma + 1), of(kSeenRedGreen + 1), of(kSeenBlueYellow + 1)};
    V error = error_of(k, adjusted_lab(k, reference), adjusted_lab(k, image), of(kSeenFeature));
    if constexpr (kLargest) error = hn::Max(error, hn::LoadU(d, errors + x));
    hn::StoreU(error, d, errors + x);
  }
}

template <bool kToneMap, bool kLargest>
void errors_of_tile(const Tile& tile, const Weights& w, float gain, float* scratch) {
  const Layout layout(w.radius);
  float* const opponent = layout.opponent(scratch);
  float* const filtered = layout.filtered(scratch);
  float* const seen = layout.seen(scratch);
  convert<kToneMap>(tile, gain, layout, opponent);
  for (int y = 0; y < tile.height; ++y) {
    filter_across(w, layout, tile.width, opponent + static_cast<std::ptrdiff_t>(y + layout.radius) * layout.stride, filtered);
    filter_along(w, layout, tile.width, filtered, seen);
    finish_row<kLargest>(tile.width, seen, scratch + static_cast<std::ptrdiff_t>(y) * kTileWidth);
  }
}

void DisplayErrors(const Tile& tile, const Weights& weights, float* scratch) {
  errors_of_tile<false, false>(tile, weights, 1, scratch);
}
void RadianceErrors(const Tile& tile, const Weights& weights, const std::vector<float>& gains, float* scratch) {
  errors_of_tile<true, false>(tile, weights, gains[0], scratch);
  for (std::size_t i = 1; i < gains.size(); ++i) errors_of_tile<true, true>(tile, weights, gains[i], scratch);
}

}  // namespace quell::flip_kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::flip_kernel {

HWY_EXPORT(DisplayErrors);
HWY_EXPORT(RadianceErrors);

Weights::Weights(const FlipFilters& filters) : red_green(filters.red_green), radius(filters.radius) {
  const auto at = [](const HalfFilter& filter, std::size_t i) { return i < filter.size() ? filter[i] : 0.0F; };
  const std::size_t taps = std::max(filters.smooth.size(), filters.luma.size());
  for (std::size_t i = 0; i < taps; ++i)
    luma.push_back({at(filters.luma, i), at(filters.smooth, i), at(filters.edge, i), at(filters.point, i)});
  for (std::size_t i = 0; i < filters.blue_yellow[0].size(); ++i)
    blue_yellow.push_back({filters.blue_yellow[0][i], filters.blue_yellow[1][i]});
  blur_taps = static_cast<int>(filters.luma.size());
}

std::size_t scratch_size(int radius) { return Layout(radius).size(); }

void display_errors(const Tile& tile, const Weights& weights, float* scratch) {
  HWY_DYNAMIC_DISPATCH(DisplayErrors)(tile, weights, scratch);
}
void radiance_errors(const Tile& tile, const Weights& weights, const std::vector<float>& gains, float* scratch) {
  HWY_DYNAMIC_DISPATCH(RadianceErrors)(tile, weights, gains, scratch);
}

}  // namespace quell::flip_kernel
#endif
