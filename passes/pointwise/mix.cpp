// Linear interpolation between two images, by a number or by an image.
// Source:  arithmetic.
// Cost:    two multiply-adds a channel; bound by memory.
#include <algorithm>
#include <stdexcept>

#include "quell/sdk/pass.h"

namespace quell {
namespace {

struct Params {
  double amount = 0.5;
  void describe(auto&& field) {
    field("amount", amount, Range<double>{0, 1}, "1", "How much of b there is: 0 gives a, 1 gives b. With t, a factor of it.");
  }
};

const PassInfo kInfo{
    .id = "mix",
    .summary = "Interpolates between two images, by a number or by an image",
    .doc =
        "image = a + (b - a) s, in each plane, with s = amount, times min(max(t, 0), 1) where t is given: a mask chooses, a "
        "confidence or a coverage blends. Where s is 0 or 1 it is a or b, bit for bit, whatever the other is. a and b are of "
        "one type. Without b, or while it is absent, it is a.",
    .source = "arithmetic",
    .inputs = {{"a", kAnyFloatImage, "where s is 0"},
               {"b", kAnyFloatImage, "where s is 1; of the type of a", true},
               {"t", kScalar | kMask | kAlpha, "how much of b, 0 to 1", true}},
    .outputs = {{.name = "image", .doc = "the mixture", .same_as = "a"}},
};

class Mix final : public Pass {
 public:
  explicit Mix(const Params& params) : amount_(static_cast<float>(params.amount)) {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    inference.set_in_place("image", "a");
    if (inference.present("b") && inference.type("a") != inference.type("b"))
      throw std::runtime_error("a and b must be of one type");
  }

  void run(const Frame& frame) const override {
    const FloatImage a = frame.image("a"), b = frame.image("b"), t = frame.image("t");
    const FloatOutput out = frame.output("image");
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int c = 0; c < out.channels; ++c)
        for (int y = y0; y < y1; ++y) {
          if (b)
            mix_row(a.row(y, c), b.row(y, c), t ? t.row(y) : nullptr, out.width, out.row(y, c));
          else if (out.row(y, c) != a.row(y, c))
            std::copy_n(a.row(y, c), out.width, out.row(y, c));
        }
    });
  }

 private:
  // From the nearer end, so that what is far away does not round it off.
  static float mix(float a, float b, float s) {
    const float near_a = a + (b - a) * s, near_b = b + (a - b) * (1 - s);
    const float between = s < 0.5F ? near_a : near_b;
    return s <= 0 ? a : (s >= 1 ? b : between);
  }

  // The output may lie on a, pixel for pixel: __restrict would deny that, ivdep promises only that no pixel depends on another.
  void mix_row(const float* a, const float* b, const float* t, int width, float* out) const {
    const float amount = amount_;
    if (t) {
#pragma GCC ivdep
      for (int x = 0; x < width; ++x) out[x] = mix(a[x], b[x], amount * std::min(std::max(t[x], 0.0F), 1.0F));
    } else {
#pragma GCC ivdep
      for (int x = 0; x < width; ++x) out[x] = mix(a[x], b[x], amount);
    }
  }

  float amount_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Mix, quell::Params)
