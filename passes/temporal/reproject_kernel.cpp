// Neighbors in a vector mostly fetch from neighbors: of each tap the lanes then lie one behind the other, or, where the motion
// passes a whole number, in two such runs, and are loaded as such. Where they are scattered, or a tap or the last lane may lie
// outside of the image, each lane is fetched by itself.
//
// A result is one of its taps plus the weighted differences of the others to it: the mean of equal values is that value, bit for
// bit, and a result errs by its own rounding, 6e-8 of it, and that of the weights, 3e-7 of the range of the taps.
#include "passes/temporal/reproject_kernel.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes/temporal/reproject_kernel.cpp"  // from the repository root
#include <hwy/foreach_target.h>
// After foreach_target.h, which makes it visible again for every vector unit.
#include "quell/simd/vectors-inl.h"

#ifndef QUELL_REPROJECT_SHARED  // what is the same for all vector units
#define QUELL_REPROJECT_SHARED
namespace quell::reproject {

constexpr int kAhead =
    128;  // px from a site: what rows will be loaded from 8 vectors of 16 later, about the time that memory takes
constexpr float kFarthest = 1048576;  // px that a motion can have; images are at most 65536 wide, and such an int is exact

// Which taps a result has, relative to the pixel that the fetch names. Those that limit a result come first.
struct Offset {
  int dx, dy;
};
inline constexpr Offset kPoint[] = {{0, 0}};
inline constexpr Offset kFour[] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
inline constexpr Offset kWindow[] = {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
inline constexpr Offset kSixteen[] = {{0, 0},  {1, 0}, {0, 1},  {1, 1}, {-1, -1}, {0, -1}, {1, -1}, {2, -1},
                                      {-1, 0}, {2, 0}, {-1, 1}, {2, 1}, {-1, 2},  {0, 2},  {1, 2},  {2, 2}};

}  // namespace quell::reproject
#endif

HWY_BEFORE_NAMESPACE();
namespace quell::reproject::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;  // NOLINT: the vocabulary of kernels

using Mask = hn::Mask<D>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;
using VI = hn::Vec<DI>;

HWY_INLINE VI set_int(int value) { return hn::Set(DI(), value); }
HWY_INLINE Mask float_mask(hn::Mask<DI> mask) { return hn::RebindMask(D(), mask); }
template <class T>
using Tag = std::conditional_t<std::is_same_v<T, float>, D, DU>;

// Lanes whose pixels are neighbors: that of lane i is (x + i, y).
struct Run {
  int x = 0, y = 0;
};

// Sites are the pixels of the previous frame that the lanes' taps are relative to. What a site makes of a plane yields the value
// of each lane's tap.

// One run or two, of which all taps lie in the image.
template <int kRuns>
struct RunSite {
  Run first, second;
  Mask in_first;

  template <class T>
  struct Plane {
    const T *first, *second;
    std::ptrdiff_t row_stride;
    Mask in_first;
    HWY_INLINE auto operator()(Offset tap) const {
      const Tag<T> d;
      const std::ptrdiff_t way = tap.dy * row_stride + tap.dx;
      if constexpr (kRuns == 1) return hn::LoadU(d, first + way);
      return hn::IfThenElse(hn::RebindMask(d, in_first), hn::LoadU(d, first + way), hn::LoadU(d, second + way));
    }
  };
  template <class Image, class T>
  HWY_INLINE Plane<T> plane(const Image& image, const T* at) const {
    __builtin_prefetch(at + (first.y + 1) * image.row_stride + first.x + kAhead);
    return {at + first.y * image.row_stride + first.x, at + second.y * image.row_stride + second.x, image.row_stride, in_first};
  }
  HWY_INLINE Mask inside(Mask of, Offset, int, int) const { return of; }
};

// Pixels anywhere. Of taps outside of the image the value is that of some pixel.
struct ScatteredSite {
  VI x, y;

  template <class T>
  struct Plane {
    VI x, y;
    const T* at;
    int width, height;
    std::ptrdiff_t row_stride;
    HWY_INLINE auto operator()(Offset tap) const {
      const DI di;
      const Tag<T> d;
      const auto clamp = [&](VI v, int size) { return hn::Min(hn::Max(v, hn::Zero(di)), set_int(size - 1)); };
      const VI tap_x = clamp(hn::Add(x, set_int(tap.dx)), width), tap_y = clamp(hn::Add(y, set_int(tap.dy)), height);
      if (HWY_LIKELY(height * row_stride <= std::numeric_limits<std::int32_t>::max()))
        return hn::GatherIndex(d, at, hn::Add(hn::Mul(tap_y, set_int(static_cast<int>(row_stride))), tap_x));
      HWY_ALIGN int xs[kMaxLanes], ys[kMaxLanes];
      HWY_ALIGN T values[kMaxLanes];
      hn::Store(tap_x, di, xs), hn::Store(tap_y, di, ys);
      for (int i = 0; i < lanes(); ++i) values[i] = at[ys[i] * row_stride + xs[i]];
      return hn::Load(d, values);
    }
  };
  template <class Image, class T>
  HWY_INLINE Plane<T> plane(const Image& image, const T* at) const {
    return {x, y, at, image.width, image.height, image.row_stride};
  }
  // Lanes of `of` whose tap lies in the image.
  HWY_INLINE Mask inside(Mask of, Offset tap, int width, int height) const {
    const VI tap_x = hn::Add(x, set_int(tap.dx)), tap_y = hn::Add(y, set_int(tap.dy)), before = set_int(-1);
    of = hn::And(of, float_mask(hn::And(hn::Gt(tap_x, before), hn::Lt(tap_x, set_int(width)))));
    return hn::And(of, float_mask(hn::And(hn::Gt(tap_y, before), hn::Lt(tap_y, set_int(height)))));
  }
};

// Calls with_site for the site at (x, y). Lanes that are not `active` may be anywhere.
template <const auto& kOffsets, class WithSite>
HWY_INLINE void at_site(VI x, VI y, Mask active, int width, int height, const WithSite& with_site) {
  constexpr int kLeft = std::ranges::min(kOffsets, {}, &Offset::dx).dx, kRight = std::ranges::max(kOffsets, {}, &Offset::dx).dx;
  constexpr int kAbove = std::ranges::min(kOffsets, {}, &Offset::dy).dy, kBelow = std::ranges::max(kOffsets, {}, &Offset::dy).dy;
  const VI first_x = hn::Sub(x, hn::Iota(DI(), 0));
  const auto run_of = [&](Mask of) {
    const auto mask = hn::RebindMask(DI(), of);
    return Run{hn::GetLane(hn::Compress(first_x, mask)), hn::GetLane(hn::Compress(y, mask))};
  };
  const auto in_run = [&](Run run) { return float_mask(hn::And(hn::Eq(first_x, set_int(run.x)), hn::Eq(y, set_int(run.y)))); };
  const auto is_inside = [&](Run run) {
    return run.x + kLeft >= 0 && run.x + lanes() - 1 + kRight < width && run.y + kAbove >= 0 && run.y + kBelow < height;
  };
  const D d;
  const Run first = run_of(active);
  const Mask in_first = in_run(first), others = hn::AndNot(in_first, active);
  if (HWY_LIKELY(is_inside(first))) {
    if (hn::AllFalse(d, others)) return with_site(RunSite<1>{first, first, in_first});
    const Run second = run_of(others);
    if (is_inside(second) && hn::AllFalse(d, hn::AndNot(in_run(second), others)))
      return with_site(RunSite<2>{first, second, in_first});
  }
  with_site(ScatteredSite{x, y});
}

// Pixels from (x, y) on.
HWY_INLINE V pixels(const FloatImage& image, int x, int y) { return hn::LoadU(D(), image.row(y) + x); }
HWY_INLINE V3 pixels3(const FloatImage& image, int x, int y) { return load(image.row(y) + x, image.plane_stride); }
HWY_INLINE hn::Vec<DU> ids(const IdImage& image, int x, int y) { return hn::LoadU(DU(), image.row(y) + x); }

// What the taps of the pixels from (x, y) on are tested by.
class Tests {
 public:
  HWY_INLINE Tests(const Images& in, const Settings& s, int x, int y) : in_(in), plane_tolerance_(set(s.plane_absolute)) {
    tests_id_ = in.id && in.previous_id;
    tests_depth_ = in.depth && in.previous_depth;
    tests_normal_ = in.normal && in.previous_normal;
    tests_plane_ = in.normal && in.position && in.previous_position;
    if (tests_id_) id_ = ids(in.id, x, y);
    if (tests_depth_) {
      depth_ = pixels(in.depth, x, y);
      depth_tolerance_ = hn::MulAdd(hn::Abs(depth_), set(s.depth_relative), set(s.depth_absolute));
      if (in.depth_gradient) depth_tolerance_ = hn::MulAdd(pixels(in.depth_gradient, x, y), set(s.depth_slope), depth_tolerance_);
    }
    if (in.normal) normal_ = pixels3(in.normal, x, y);
    V turn = set(s.normal_absolute);
    if (in.normal_gradient) turn = hn::MulAdd(pixels(in.normal_gradient, x, y), set(s.normal_slope), turn);
    squared_turn_ = hn::Mul(turn, turn);
    if (tests_plane_) position_ = pixels3(in.position, x, y);
  }

  // Leaves of passes[i] the lanes whose tap i passes. What is not a number fails.
  template <const auto& kOffsets, class Site>
  HWY_INLINE void test(const Site& site, Mask* passes) const {
    constexpr std::size_t kCount = std::size(kOffsets);
    if (tests_id_) {
      const auto id = site.plane(in_.previous_id, in_.previous_id.row(0));
      for (std::size_t i = 0; i < kCount; ++i) passes[i] = hn::And(passes[i], hn::RebindMask(D(), hn::Eq(id(kOffsets[i]), id_)));
    }
    if (tests_depth_) {
      const auto depth = site.plane(in_.previous_depth, in_.previous_depth.row(0));
      for (std::size_t i = 0; i < kCount; ++i)
        passes[i] = hn::And(passes[i], hn::Le(hn::Abs(hn::Sub(depth(kOffsets[i]), depth_)), depth_tolerance_));
    }
    if (tests_normal_) {
      const Planes<Site> normal(site, in_.previous_normal);
      for (std::size_t i = 0; i < kCount; ++i) {
        const V3 turn = sub(normal_, normal(kOffsets[i]));
        passes[i] = hn::And(passes[i], hn::Le(dot(turn, turn), squared_turn_));
      }
    }
    if (tests_plane_) {
      const Planes<Site> position(site, in_.previous_position);
      for (std::size_t i = 0; i < kCount; ++i) {
        const V height = dot(normal_, sub(position_, position(kOffsets[i])));
        passes[i] = hn::And(passes[i], hn::Le(hn::Abs(height), plane_tolerance_));
      }
    }
  }

 private:
  template <class Site>
  struct Planes {
    typename Site::template Plane<float> x, y, z;
    HWY_INLINE Planes(const Site& site, const FloatImage& image)
        : x(site.plane(image, image.row(0, 0))), y(site.plane(image, image.row(0, 1))), z(site.plane(image, image.row(0, 2))) {}
    HWY_INLINE V3 operator()(Offset tap) const { return {x(tap), y(tap), z(tap)}; }
  };

  const Images& in_;
  bool tests_id_, tests_depth_, tests_normal_, tests_plane_;
  hn::Vec<DU> id_ = hn::Zero(DU());
  V depth_ = zero(), depth_tolerance_ = zero(), squared_turn_, plane_tolerance_;
  V3 normal_{zero(), zero(), zero()}, position_{zero(), zero(), zero()};
};

// Each lane's taps at kOffsets from its pixel of `site`; whoever makes them gives the weights.
template <const auto& kOffsets, class Site>
class Taps {
 public:
  static constexpr int kCount = static_cast<int>(std::size(kOffsets));
  V weight[kCount];
  V left, failed;  // sums of weights
  Mask all, any;   // lanes whose taps pass

  HWY_INLINE explicit Taps(const Site& site) : site_(site) {}

  // Only taps with a weight above 0 count.
  HWY_INLINE void test(const Tests& tests, Mask active, int width, int height) {
    Mask counts[kCount];
    for (int i = 0; i < kCount; ++i) {
      counts[i] = hn::And(active, hn::Ne(weight[i], zero()));
      passes_[i] = site_.inside(counts[i], kOffsets[i], width, height);
    }
    tests.test<kOffsets>(site_, passes_);
    all = active, any = hn::Lt(zero(), zero());
    left = failed = zero();
    for (int i = 0; i < kCount; ++i) {
      const Mask fails = hn::AndNot(passes_[i], counts[i]);
      failed = hn::Add(failed, hn::IfThenElseZero(fails, weight[i]));
      all = hn::AndNot(fails, all);
      any = hn::Or(any, passes_[i]);
      weight[i] = hn::IfThenElseZero(passes_[i], weight[i]);
      left = hn::Add(left, weight[i]);
    }
  }
  HWY_INLINE void normalize() {
    const V scale = hn::Div(set(1.0F), left);
    for (V& w : weight) w = hn::Mul(w, scale);
  }

  HWY_INLINE V fetch(const FloatImage& image, const float* at) const {
    const auto plane = site_.plane(image, at);
    V values[kCount];
    for (int i = 0; i < kCount; ++i) values[i] = plane(kOffsets[i]);
    V base = values[kCount - 1];
    for (int i = kCount - 2; i >= 0; --i) base = hn::IfThenElse(passes_[i], values[i], base);
    if constexpr (kCount == 1) return base;
    V way = zero();
    for (int i = 0; i < kCount; ++i) way = hn::MulAdd(weight[i], hn::IfThenElseZero(passes_[i], hn::Sub(values[i], base)), way);
    V result = hn::Add(base, way);
    if constexpr (kCount == std::size(kSixteen))
      result = hn::Clamp(result, hn::Min(hn::Min(values[0], values[1]), hn::Min(values[2], values[3])),
                         hn::Max(hn::Max(values[0], values[1]), hn::Max(values[2], values[3])));
    return result;
  }

 private:
  const Site& site_;
  Mask passes_[kCount];
};

// Where the point lies: the pixel above and to the left of it, by centers, and how far behind that.
struct Point {
  VI x, y;
  V fx, fy;
};
HWY_INLINE Point point(V motion_x, V motion_y, int x, int y) {
  const DI d;
  const V floor_x = hn::Floor(motion_x), floor_y = hn::Floor(motion_y);
  return {hn::Add(hn::ConvertTo(d, floor_x), hn::Iota(d, x)), hn::Add(hn::ConvertTo(d, floor_y), set_int(y)),
          hn::Sub(motion_x, floor_x), hn::Sub(motion_y, floor_y)};
}

// The pixel that contains the point; of `truncate`, as C converts, what lies less than a pixel off the left or upper border is on
// it.
template <bool kTruncates>
HWY_INLINE VI nearest(VI pixel, V f) {
  const DI d;
  const V half = set(0.5F);
  VI result = hn::IfThenElse(hn::RebindMask(d, hn::Ge(f, half)), hn::Add(pixel, set_int(1)), pixel);
  if constexpr (kTruncates)
    result = hn::IfThenElse(hn::And(hn::Eq(result, set_int(-1)), hn::RebindMask(d, hn::Ne(f, half))), hn::Zero(d), result);
  return result;
}

HWY_INLINE void bilinear_weights(const Point& p, V* weight) {
  const V one = set(1.0F), gx = hn::Sub(one, p.fx), gy = hn::Sub(one, p.fy);
  weight[0] = hn::Mul(gx, gy), weight[1] = hn::Mul(p.fx, gy), weight[2] = hn::Mul(gx, p.fy), weight[3] = hn::Mul(p.fx, p.fy);
}

// Catmull and Rom's spline at the four pixels around a point that lies `f` behind the second.
HWY_INLINE void spline(V f, V* weight) {
  const V half = set(0.5F), square = hn::Mul(f, f);
  weight[0] = hn::Mul(f, hn::MulAdd(f, hn::NegMulAdd(half, f, set(1.0F)), set(-0.5F)));
  weight[1] = hn::MulAdd(square, hn::MulAdd(set(1.5F), f, set(-2.5F)), set(1.0F));
  weight[2] = hn::Mul(f, hn::MulAdd(f, hn::NegMulAdd(set(1.5F), f, set(2.0F)), half));
  weight[3] = hn::Mul(square, hn::MulAdd(half, f, set(-0.5F)));
}
HWY_INLINE void catmull_rom_weights(const Point& p, V* weight) {
  V wx[4], wy[4];
  spline(p.fx, wx), spline(p.fy, wy);
  for (std::size_t i = 0; i < std::size(kSixteen); ++i) weight[i] = hn::Mul(wx[kSixteen[i].dx + 1], wy[kSixteen[i].dy + 1]);
}

// The pixels of a row from x on, as many as a vector has lanes or as there are.
struct Pixels {
  int x, y, count;
};

// Stores validity, and for each plane of the history what `fetch` makes of it, 0 where not valid.
template <class Fetched>
HWY_INLINE void store_history(const Pixels& at, Mask is_valid, std::span<const Moved> history, const FloatOutput& valid,
                              const Fetched& fetch) {
  store(hn::IfThenElseZero(is_valid, set(1.0F)), at.count, valid.row(at.y) + at.x);
  for (const Moved& image : history)
    for (int c = 0; image.to && c < image.to.channels; ++c)
      store(hn::IfThenElseZero(is_valid, fetch(image.from, image.from.row(0, c))), at.count, image.to.row(at.y, c) + at.x);
}

// Stores the same over that, in the rescued lanes alone.
template <class Fetched>
HWY_INLINE void store_rescued(const Pixels& at, Mask is_rescued, std::span<const Moved> history, const FloatOutput& valid,
                              const Fetched& fetch) {
  const auto store_over = [&](V v, float* to) { store(hn::IfThenElse(is_rescued, v, hn::LoadU(D(), to)), at.count, to); };
  store_over(set(1.0F), valid.row(at.y) + at.x);
  for (const Moved& image : history)
    for (int c = 0; image.to && c < image.to.channels; ++c)
      store_over(fetch(image.from, image.from.row(0, c)), image.to.row(at.y, c) + at.x);
}

// Lanes of `active` fetch by the taps `found`, or, where `is_better`, what `better` makes of that; the window around point p
// rescues those that have too little weight left.
template <class AnyTaps, class Better>
HWY_INLINE void fetch_pixels(const Settings& s, const Pixels& at, std::span<const Moved> history, const FloatOutput& valid,
                             const FloatOutput& rejected, const Tests& tests, Mask active, const Point& p, AnyTaps& found,
                             Mask is_better, const Better& better) {
  const D d;
  const int width = history[0].from.width, height = history[0].from.height;
  const V failed = hn::IfThenElse(hn::And(active, found.any), hn::Min(found.failed, set(1.0F)), set(1.0F));
  store(hn::IfThenElseZero(hn::Not(is_better), failed), at.count, rejected.row(at.y) + at.x);
  const Mask enough = hn::And(found.any, hn::Ge(found.left, set(s.min_weight)));
  found.normalize();
  const Mask is_found = hn::Or(enough, is_better);
  store_history(at, is_found, history, valid,
                [&](const FloatImage& image, const float* plane) { return better(image, plane, found.fetch(image, plane)); });
  const Mask lost = hn::AndNot(is_found, active);
  if (!s.rescue || hn::AllFalse(d, lost)) return;
  at_site<kWindow>(nearest<false>(p.x, p.fx), nearest<false>(p.y, p.fy), lost, width, height, [&](const auto& site) {
    Taps<kWindow, std::decay_t<decltype(site)>> window(site);
    for (V& w : window.weight) w = set(1.0F);
    window.test(tests, lost, width, height);
    if (hn::AllFalse(d, window.any)) return;
    window.normalize();
    store_rescued(at, window.any, history, valid,
                  [&](const FloatImage& image, const float* plane) { return window.fetch(image, plane); });
  });
}

template <Fetch kFetch>
HWY_INLINE void reproject_pixels(const Images& in, const Settings& s, const Pixels& at, std::span<const Moved> history,
                                 const FloatOutput& valid, const FloatOutput& rejected) {
  const D d;
  const int width = history[0].from.width, height = history[0].from.height;
  V mx = hn::LoadU(d, in.motion.row(at.y, 0) + at.x), my = hn::LoadU(d, in.motion.row(at.y, 1) + at.x);
  Mask active = hn::And(hn::Lt(hn::Abs(mx), set(kFarthest)), hn::Lt(hn::Abs(my), set(kFarthest)));
  active = hn::And(active, hn::FirstN(d, static_cast<std::size_t>(at.count)));
  if (in.id) active = hn::And(active, hn::RebindMask(d, hn::Ne(ids(in.id, at.x, at.y), hn::Set(DU(), QUELL_NO_ID))));
  if (hn::AllFalse(d, active)) {
    store(set(1.0F), at.count, rejected.row(at.y) + at.x);
    return store_history(at, active, history, valid, [](const FloatImage&, const float*) { return zero(); });
  }
  mx = hn::IfThenElseZero(active, mx), my = hn::IfThenElseZero(active, my);
  const Tests tests(in, s, at.x, at.y);
  const Point p = point(mx, my, at.x, at.y);
  const Mask none = hn::Lt(zero(), zero());
  const auto no_better = [](const FloatImage&, const float*, V own) { return own; };
  if constexpr (kFetch == Fetch::nearest || kFetch == Fetch::truncate) {
    constexpr bool kTruncates = kFetch == Fetch::truncate;
    const VI x = nearest<kTruncates>(p.x, p.fx), y = nearest<kTruncates>(p.y, p.fy);
    at_site<kPoint>(x, y, active, width, height, [&](const auto& site) {
      Taps<kPoint, std::decay_t<decltype(site)>> taps(site);
      taps.weight[0] = set(1.0F);
      taps.test(tests, active, width, height);
      fetch_pixels(s, at, history, valid, rejected, tests, active, p, taps, none, no_better);
    });
  } else if constexpr (kFetch == Fetch::bilinear) {
    at_site<kFour>(p.x, p.y, active, width, height, [&](const auto& site) {
      Taps<kFour, std::decay_t<decltype(site)>> taps(site);
      bilinear_weights(p, taps.weight);
      taps.test(tests, active, width, height);
      fetch_pixels(s, at, history, valid, rejected, tests, active, p, taps, none, no_better);
    });
  } else {
    at_site<kSixteen>(p.x, p.y, active, width, height, [&](const auto& site) {
      using Site = std::decay_t<decltype(site)>;
      Taps<kFour, Site> taps(site);
      bilinear_weights(p, taps.weight);
      taps.test(tests, active, width, height);
      Taps<kSixteen, Site> sixteen(site);
      for (V& w : sixteen.weight) w = set(1.0F);  // a tap without weight must pass, too
      sixteen.test(tests, active, width, height);
      catmull_rom_weights(p, sixteen.weight);
      const auto better = [&](const FloatImage& image, const float* plane, V own) {
        return hn::IfThenElse(sixteen.all, sixteen.fetch(image, plane), own);
      };
      fetch_pixels(s, at, history, valid, rejected, tests, active, p, taps, sixteen.all, better);
    });
  }
}

// What the pixels of a row are told of in this frame, for memory to yield it beforehand: there are more streams than the
// processor follows by itself.
class Ahead {
 public:
  Ahead(const Images& in, int y) {
    for (const FloatImage* image : {&in.motion, &in.depth, &in.depth_gradient, &in.normal, &in.normal_gradient, &in.position})
      for (int c = 0; *image && c < image->channels; ++c) planes_[count_++] = image->row(y, c);
    if (in.id) planes_[count_++] = in.id.row(y);
  }
  HWY_INLINE void fetch(int x) const {
    for (int i = 0; i < count_; ++i)
      __builtin_prefetch(static_cast<const float*>(planes_[static_cast<std::size_t>(i)]) + x + kAhead);
  }

 private:
  std::array<const void*, 13> planes_;
  int count_ = 0;
};

template <Fetch kFetch>
void reproject_each(const Images& in, const Settings& s, std::span<const Moved> history, int y, const FloatOutput& valid,
                    const FloatOutput& rejected) {
  const Ahead ahead(in, y);
  for (int x = 0; x < valid.width; x += lanes()) {
    ahead.fetch(x);
    reproject_pixels<kFetch>(in, s, {x, y, valid.width - x}, history, valid, rejected);
  }
}

void ReprojectRow(const Images& in, const Settings& s, std::span<const Moved> history, int y, const FloatOutput& valid,
                  const FloatOutput& rejected) {
  switch (s.fetch) {
    case Fetch::bilinear:
      return reproject_each<Fetch::bilinear>(in, s, history, y, valid, rejected);
    case Fetch::nearest:
      return reproject_each<Fetch::nearest>(in, s, history, y, valid, rejected);
    case Fetch::truncate:
      return reproject_each<Fetch::truncate>(in, s, history, y, valid, rejected);
    case Fetch::catmull_rom:
      return reproject_each<Fetch::catmull_rom>(in, s, history, y, valid, rejected);
  }
}

}  // namespace quell::reproject::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace quell::reproject {

HWY_EXPORT(ReprojectRow);

void reproject_row(const Images& in, const Settings& settings, std::span<const Moved> history, int y, const FloatOutput& valid,
                   const FloatOutput& rejected) {
  HWY_DYNAMIC_DISPATCH(ReprojectRow)(in, settings, history, y, valid, rejected);
}

void reproject_nothing(std::span<const Moved> history, int y, const FloatOutput& valid, const FloatOutput& rejected) {
  std::fill_n(valid.row(y), valid.width, 0.0F);
  std::fill_n(rejected.row(y), rejected.width, 1.0F);
  for (const Moved& image : history)
    for (int c = 0; image.to && c < image.to.channels; ++c) std::fill_n(image.to.row(y, c), image.to.width, 0.0F);
}

}  // namespace quell::reproject
#endif
