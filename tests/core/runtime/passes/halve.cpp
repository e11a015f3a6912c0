// For tests of shapes: half the size, what is added having the size of the whole image, and a value as the first output.
#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct Params {};

const PassInfo kInfo{.id = "halve",
                     .summary = "every other pixel of color + other",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kColor, .doc = "halved"},
                                {.name = "other", .types = kColor, .doc = "added", .optional = true}},
                     .outputs = {{.name = "width", .types = kValue, .doc = "of other; 0 without"},
                                 {.name = "color", .types = kColor, .doc = "the sum"}}};

class Halve final : public Pass {
 public:
  explicit Halve(const Params&) {}
  void infer(Inference& about) const override {
    const Size size = about.size("color");
    about.set_size("color", {(size.width + 1) / 2, (size.height + 1) / 2});
    about.set_radius("color", 1);
    about.set_radius("other", 1);
  }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color"), other = frame.image("other");
    const FloatOutput out = frame.output("color");
    frame.output_values("width")[0] = other.width;
    for (int c = 0; c < out.channels; ++c)
      for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
          out.at(x, y, c) = color.at(2 * x, 2 * y, c) + (other ? other.at(2 * x, 2 * y, c) : 0.0F);
  }
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Halve, Params)
