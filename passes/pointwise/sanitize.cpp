// Replaces pixels that no filter may see: what is not finite, and what is brighter than can be true.
//
// Source:  arithmetic.
//
// Cost:    two comparisons a channel; bound by memory. Pixels that are replaced by their neighbors cost nine more.
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "quell/sdk/pass.h"
#include "quell/sdk/plain_loop.h"

namespace quell {
namespace {

enum class Replace { black, neighbors };
enum class Negative { keep, zero };

struct Params {
  Replace replace = Replace::black;
  double max = 0;
  Negative negative = Negative::keep;
  void describe(auto&& field) {
    field("replace", replace,
          Choices{{"black", "0"},
                  {"neighbors", "the mean of those pixels of the 3 x 3 window that are not replaced themselves; 0 without any"}},
          "What stands in place of a pixel that is replaced.");
    field("max", max, Range<double>{0, 3e38}, "unit of the image",
          "A pixel with a plane above it, such as a firefly's, is replaced. 0 is no bound.");
    field("negative", negative, Choices{{"keep", "as they are"}, {"zero", "0, each plane by itself"}},
          "What becomes of numbers below 0 in pixels that are not replaced.");
  }
};

const PassInfo kInfo{
    .id = "sanitize",
    .summary = "Replaces pixels that are not finite or above a bound, and counts them",
    .doc =
        "A pixel is replaced, in all its planes, when one of them is NaN, infinite, or above max. `count` is how many pixels of "
        "the frame were replaced; those where only a negative number became 0 do not count. As a graph's \"reset\" it ends the "
        "history at frames that are not to be trusted.\n\n"
        "What is NaN or infinite in the files of a sequence has been replaced by 0, and reported, when it was read, and does not "
        "count here: there the bound is what matters.",
    .source = "arithmetic",
    .inputs = {{"color", kAnyFloatImage, "what to look through"}},
    .outputs = {{.name = "color", .doc = "the same, finite and within the bound", .same_as = "color"},
                {"count", kValue, "how many pixels were replaced"}},
};

constexpr float kLargest = std::numeric_limits<float>::max();

class Sanitize final : public Pass {
 public:
  explicit Sanitize(const Params& params)
      : replace_(params.replace),
        max_(params.max > 0 ? static_cast<float>(params.max) : kLargest),
        floor_(params.negative == Negative::zero ? 0.0F : -kLargest) {}

  void infer(Inference& inference) const override {
    if (replace_ == Replace::neighbors)
      inference.set_radius("color", 1);
    else
      inference.set_in_place("color", "color");
    inference.set_slot_scratch(static_cast<std::size_t>(inference.size("color").width) * sizeof(std::int32_t));
  }

  void run(const Frame& frame) const override {
    const FloatImage in = frame.image("color");
    const FloatOutput out = frame.output("color");
    std::atomic<std::int64_t> count = 0;  // of whole numbers: the sum does not depend on the order
    frame.parallel_rows(out.height, [&](int y0, int y1, std::uint32_t slot) {
      auto* bad = static_cast<std::int32_t*>(frame.slot_scratch(slot));
      for (int y = y0; y < y1; ++y) {
        const std::int64_t found = find_bad(in, y, bad);
        for (int c = 0; c < out.channels; ++c) clean_row(in.row(y, c), bad, out.width, out.row(y, c));
        if (found > 0 && replace_ == Replace::neighbors) mend_row(in, y, bad, out);
        count += found;
      }
    });
    frame.output_values("count")[0] = static_cast<double>(count);
  }

 private:
  bool fits(float value) const { return value <= max_ && value >= -kLargest; }  // false for NaN

  // 1 for each pixel of the row that is to be replaced, else 0; and how many there are.
  QUELL_PLAIN_LOOP std::int64_t find_bad(const FloatImage& in, int y, std::int32_t* __restrict bad) const {
    for (int x = 0; x < in.width; ++x) bad[x] = 0;
    for (int c = 0; c < in.channels; ++c) {
      const float* row = in.row(y, c);
      for (int x = 0; x < in.width; ++x) bad[x] |= fits(row[x]) ? 0 : 1;
    }
    std::int32_t found = 0;
    for (int x = 0; x < in.width; ++x) found += bad[x];
    return found;
  }

  // Output and input may be the same row: __restrict would deny that, ivdep promises only that no pixel depends on another.
  QUELL_PLAIN_LOOP void clean_row(const float* in, const std::int32_t* bad, int width, float* out) const {
    const float floor = floor_;
#pragma GCC ivdep
    for (int x = 0; x < width; ++x) out[x] = bad[x] ? 0.0F : (in[x] < floor ? floor : in[x]);
  }

  bool is_good(const FloatImage& in, int x, int y) const {
    for (int c = 0; c < in.channels; ++c)
      if (!fits(in.at(x, y, c))) return false;
    return true;
  }

  void mend_row(const FloatImage& in, int y, const std::int32_t* bad, const FloatOutput& out) const {
    for (int x = 0; x < out.width; ++x)
      if (bad[x])
        for (int c = 0; c < out.channels; ++c) out.at(x, y, c) = mean_of_neighbors(in, x, y, c);
  }

  float mean_of_neighbors(const FloatImage& in, int x, int y, int c) const {
    double sum = 0;
    int count = 0;
    for (int ty = y - 1; ty <= y + 1; ++ty)
      for (int tx = x - 1; tx <= x + 1; ++tx)
        if (in.contains(tx, ty) && is_good(in, tx, ty)) sum += std::fmax(in.at(tx, ty, c), floor_), ++count;
    return count > 0 ? static_cast<float>(sum / count) : 0.0F;
  }

  Replace replace_;
  float max_, floor_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Sanitize, quell::Params)
