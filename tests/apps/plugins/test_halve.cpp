// A pass whose result is half as wide and high.
#include "quell/sdk/pass.h"

namespace {

using namespace quell;

struct Params {};

const PassInfo kInfo{
    .id = "test_halve",
    .summary = "Every second pixel of every second row",
    .inputs = {{"color", kColor, ""}},
    .outputs = {{"color", kColor, ""}},
};

class TestHalve final : public Pass {
 public:
  explicit TestHalve(const Params&) {}
  void infer(Inference& inference) const override {
    const Size size = inference.size("color");
    inference.set_unbounded("color");
    inference.set_size("color", {std::max(size.width / 2, 1), std::max(size.height / 2, 1)});
  }
  void run(const Frame& frame) const override {
    const FloatImage in = frame.image("color");
    const FloatOutput out = frame.output("color");
    for (int c = 0; c < out.channels; ++c)
      for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
          out.row(y, c)[x] = in.row(std::min(2 * y, in.height - 1), c)[std::min(2 * x, in.width - 1)];
  }
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, TestHalve, Params)
