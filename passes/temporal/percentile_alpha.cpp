// Trusts a history less where percentiles of luminance in blocks of the frame jump, and bounds fireflies by them.
// Source:  percentile-adaptive SVGF, of which it is known that percentiles of luminance in blocks of 8 x 8 pixels set alpha
//          and the bound of fireflies, without the extra rays of A-SVGF's gradients.
// Departs: how they do is quell's: the relative change of one percentile from frame to frame, beyond a tolerance; a multiple of
//          another as the bound; both interpolated between the centers of the blocks.
// Cost:    32 comparisons a pixel for each percentile, two or, with a bound, three; a bilinear interpolation a pixel.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "quell/sdk/pass.h"
#include "quell/sdk/plain_loop.h"

namespace quell {
namespace {

struct Params {
  int block = 8;
  double percentile = 75, tolerance = 0.5, sensitivity = 1;
  double bright_percentile = 90, bound = 0;
  void describe(auto&& field) {
    field("block", block, Range<int>{2, 64}, "px", "Side of the blocks.");
    field("percentile", percentile, Range<double>{0, 100}, "%",
          "Which luminance is compared: high enough not to be 0 where few samples hit a light, and below fireflies.");
    field("tolerance", tolerance, Range<double>{0, 1e6}, "1", "Relative change of it that noise explains.");
    field("sensitivity", sensitivity, Range<double>{0, 1e6}, "1",
          "How much confidence a change by the whole brightness, beyond the tolerance, takes away; 0 trusts every history.");
    field("bright_percentile", bright_percentile, Range<double>{0, 100}, "%", "Which luminance the bound is a multiple of.");
    field("bound", bound, Range<double>{0, 1e6}, "1",
          "Pixels brighter than this many times the bright percentile are darkened to it; 0 is no bound.");
  }
};

const PassInfo kInfo{
    .id = "percentile_alpha",
    .summary = "Trusts a history less where percentiles of luminance jump, and bounds fireflies by them",
    .doc =
        "The image is cut into blocks, the last ones of a row or column smaller. Of each, P and P' are the percentile of "
        "luminance in the new frame and in the previous one, over those pixels where that is valid: of n luminances in "
        "order, the one of index round((n - 1) percentile / 100), half away from zero, what is not finite counting as 0. The "
        "block's confidence is 1 - min(1, sensitivity max(0, |P - P'| - tolerance m) / m) with m = max(P, P', 1e-6); 1 "
        "without pixels to compare. `confidence` is that, and the bound of `color` bound times the bright percentile of the "
        "new frame, bilinearly between the centers of the blocks. Colors above the bound are scaled down to it.\n\n"
        "Compare like with like: `previous` is the noisy frame before, not an average, at this frame's pixels, fetched by "
        "nearest; an average has other percentiles than noise around it. The confidence is what temporal_blend asks for: its "
        "alpha becomes 1 - confidence (1 - alpha).",
    .source =
        "Percentile-adaptive SVGF, entry to the SVGF competition at High-Performance Graphics 2025: percentiles of luminance "
        "in blocks of 8 x 8 pixels set alpha and the bound of fireflies. Departs: the formulas, the interpolation and all "
        "numbers but the 8 are quell's, since the entry's are not at hand.",
    .inputs = {{"color", kColor, "the new frame, noisy"},
               {"previous", kColor, "the noisy frame before, at this frame's pixels", true},
               {"valid", kMask, "where that can be used; without it, everywhere", true}},
    .outputs = {{"confidence", kScalar, "0 to 1: how far the history is to be trusted"},
                {"color", kColor, "the new frame, bounded"}},
};

constexpr float kDarkest = 1e-6F;

float luminance(const FloatImage& color, int x, int y) {
  const float l = 0.2126F * color.at(x, y, 0) + 0.7152F * color.at(x, y, 1) + 0.0722F * color.at(x, y, 2);
  return std::isfinite(l) ? l : 0.0F;
}

// A float as a whole number that is ordered as floats are.
std::int32_t key_of(float value) {
  const auto bits = std::bit_cast<std::int32_t>(value);
  return bits ^ ((bits >> 31) & 0x7fffffff);
}
float value_of(std::int32_t key) { return std::bit_cast<float>(key ^ ((key >> 31) & 0x7fffffff)); }

// The key of that index in order, without sorting: bit by bit the largest that not more than `index` keys are smaller than.
QUELL_PLAIN_LOOP std::int32_t select(const std::int32_t* __restrict keys, std::int32_t count, std::int32_t index) {
  constexpr std::uint32_t kSign = 0x80000000U;  // keys begin at -2^31
  std::uint32_t found = 0;
  for (std::uint32_t bit = kSign; bit != 0; bit >>= 1) {
    const auto trial = static_cast<std::int32_t>((found | bit) ^ kSign);
    std::int32_t smaller = 0;
    for (std::int32_t i = 0; i < count; ++i) smaller += keys[i] < trial ? 1 : 0;
    if (smaller <= index) found |= bit;
  }
  return static_cast<std::int32_t>(found ^ kSign);
}

float percentile(const std::int32_t* keys, std::size_t count, double percent) {
  const auto index = static_cast<std::int32_t>(std::lround(static_cast<double>(count - 1) * percent / 100));
  return value_of(select(keys, static_cast<std::int32_t>(count), index));
}

// Where a pixel lies among the centers of blocks: between `first` and `second`, `way` of the way.
struct Between {
  int first, second;
  float way;
};
Between between(int pixel, int block, int blocks) {
  const float at = (static_cast<float>(pixel) + 0.5F) / static_cast<float>(block) - 0.5F;
  const float floor = std::floor(at);
  const int first = static_cast<int>(floor);
  return {std::clamp(first, 0, blocks - 1), std::clamp(first + 1, 0, blocks - 1), at - floor};
}

// What is found of each block, in scratch memory.
struct Blocks {
  int columns, rows;
  float *confidence, *bound;

  // In a form that leaves equal values as they are.
  static float mix(float a, float b, float t) { return a + t * (b - a); }
  float interpolate(const float* values, const Between& x, const Between& y) const {
    const float* upper = values + static_cast<std::ptrdiff_t>(y.first) * columns;
    const float* lower = values + static_cast<std::ptrdiff_t>(y.second) * columns;
    return mix(mix(upper[x.first], upper[x.second], x.way), mix(lower[x.first], lower[x.second], x.way), y.way);
  }
};

class PercentileAlpha final : public Pass {
 public:
  explicit PercentileAlpha(const Params& params) : p_(params) {}

  void infer(Inference& inference) const override {
    // From a pixel to the far end of the farther of two blocks.
    for (const char* input : {"color", "previous", "valid"}) inference.set_radius(input, 2 * p_.block - 1);
    const Size size = inference.size("color");
    inference.set_scratch(2 * static_cast<std::size_t>(count(size.width)) * static_cast<std::size_t>(count(size.height)) *
                          sizeof(float));
    inference.set_slot_scratch(static_cast<std::size_t>(p_.block) * static_cast<std::size_t>(p_.block) * sizeof(std::int32_t));
  }

  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color"), previous = frame.image("previous"), valid = frame.image("valid");
    const FloatOutput confidence = frame.output("confidence"), out = frame.output("color");
    const int columns = count(color.width), rows = count(color.height);
    auto* scratch = static_cast<float*>(frame.scratch());
    const Blocks blocks{columns, rows, scratch, scratch + static_cast<std::ptrdiff_t>(columns) * rows};
    frame.parallel_rows(
        rows,
        [&](int first, int last, std::uint32_t slot) {
          for (int row = first; row < last; ++row)
            for (int column = 0; column < columns; ++column)
              look_through(color, previous, valid, column, row, static_cast<std::int32_t*>(frame.slot_scratch(slot)), blocks);
        },
        1);
    frame.parallel_rows(color.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) write_row(color, blocks, y, confidence, out);
    });
  }

 private:
  int count(int pixels) const { return (pixels + p_.block - 1) / p_.block; }

  template <class Visit>
  void each_pixel(const FloatImage& image, int column, int row, const Visit& visit) const {
    for (int y = row * p_.block; y < std::min((row + 1) * p_.block, image.height); ++y)
      for (int x = column * p_.block; x < std::min((column + 1) * p_.block, image.width); ++x) visit(x, y);
  }

  void look_through(const FloatImage& color, const FloatImage& previous, const FloatImage& valid, int column, int row,
                    std::int32_t* keys, const Blocks& blocks) const {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row) * blocks.columns + column;
    std::size_t n = 0;
    blocks.bound[at] = 0;
    if (p_.bound > 0) {
      each_pixel(color, column, row, [&](int x, int y) { keys[n++] = key_of(luminance(color, x, y)); });
      blocks.bound[at] = static_cast<float>(p_.bound) * percentile(keys, n, p_.bright_percentile);
    }
    blocks.confidence[at] = 1;
    if (!previous) return;
    const auto of_valid = [&](const FloatImage& image) {
      n = 0;
      each_pixel(image, column, row, [&](int x, int y) {
        if (!valid || valid.at(x, y) > 0.5F) keys[n++] = key_of(luminance(image, x, y));
      });
      return n > 0 ? percentile(keys, n, p_.percentile) : 0.0F;
    };
    const float now = of_valid(color), before = of_valid(previous), largest = std::max({now, before, kDarkest});
    const float excess = std::max(std::abs(now - before) - static_cast<float>(p_.tolerance) * largest, 0.0F);
    blocks.confidence[at] = 1 - std::min(1.0F, static_cast<float>(p_.sensitivity) * excess / largest);
  }

  void write_row(const FloatImage& color, const Blocks& blocks, int y, const FloatOutput& confidence,
                 const FloatOutput& out) const {
    const Between row = between(y, p_.block, blocks.rows);
    for (int c = 0; c < out.channels; ++c) std::copy_n(color.row(y, c), color.width, out.row(y, c));
    for (int x = 0; x < color.width; ++x) {
      const Between column = between(x, p_.block, blocks.columns);
      confidence.at(x, y) = blocks.interpolate(blocks.confidence, column, row);
      if (p_.bound <= 0) continue;
      const float bound = std::max(blocks.interpolate(blocks.bound, column, row), 0.0F), l = luminance(color, x, y);
      if (l <= bound) continue;
      for (int c = 0; c < out.channels; ++c) out.at(x, y, c) *= bound / l;
    }
  }

  Params p_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::PercentileAlpha, quell::Params)
