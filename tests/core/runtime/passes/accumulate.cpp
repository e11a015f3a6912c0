// For tests of history: the sum of all frames so far.
#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct Params {};

const PassInfo kInfo{.id = "accumulate",
                     .summary = "color + history",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "added"},
                                {.name = "history", .types = kAnyFloatImage, .doc = "what was there before", .optional = true}},
                     .outputs = {{.name = "color", .doc = "the sum", .same_as = "color"}}};

class Accumulate final : public Pass {
 public:
  explicit Accumulate(const Params&) {}
  void infer(Inference& about) const override {
    about.set_in_place("color", "color");
    about.set_by_rows();
  }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color"), history = frame.image("history");
    const FloatOutput out = frame.output("color");
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int c = 0; c < out.channels; ++c)
        for (int y = y0; y < y1; ++y)
          for (int x = 0; x < out.width; ++x) out.at(x, y, c) = color.at(x, y, c) + (history ? history.at(x, y, c) : 0.0F);
    });
  }
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Accumulate, Params)
