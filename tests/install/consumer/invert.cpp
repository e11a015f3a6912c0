// Inverts colors, wholly or in part.
// Source: arithmetic.
#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct Params {
  double amount = 1;
  void describe(auto&& field) {
    field("amount", amount, Range<double>{0, 1}, "", "0 leaves the colors as they are, 1 inverts them.");
  }
};

const PassInfo kInfo{.id = "invert",
                     .summary = "Inverts colors",
                     .doc = "color = (1 - amount) color + amount (1 - color), for each channel by itself.",
                     .source = "arithmetic",
                     .inputs = {{.name = "color", .types = kColor, .doc = "what to invert"}},
                     .outputs = {{.name = "color", .types = kColor, .doc = "the inverted colors"}}};

class Invert final : public Pass {
 public:
  explicit Invert(const Params& params) : amount_(static_cast<float>(params.amount)) {}

  // A pixel depends on itself alone, so the result may be written over the input.
  void infer(Inference& inference) const override { inference.set_in_place("color", "color"); }

  void run(const Frame& frame) const override {
    const FloatImage from = frame.image("color");
    const FloatOutput to = frame.output("color");
    frame.parallel_rows(to.height, [&](int y0, int y1) {
      for (int c = 0; c < to.channels; ++c)
        for (int y = y0; y < y1; ++y)
          for (int x = 0; x < to.width; ++x) {
            const float color = from.at(x, y, c);
            to.at(x, y, c) = color + amount_ * (1 - 2 * color);
          }
    });
  }

 private:
  float amount_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Invert, Params)
