// A pass that keeps every rule, to try the harness with: gain * color + history, and the number of the frame.
#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct Params {
  float gain = 1.0F;
  bool negate = false;
  void describe(auto&& field) {
    field("gain", gain, Range<float>{0, 10}, "", "Factor of color.");
    field("negate", negate, "Turns the sign of color.");
  }
};

const PassInfo kInfo{.id = "running_sum",
                     .summary = "gain * color + history",
                     .source = "made up",
                     .inputs = {{.name = "color", .types = kColor | kAlbedo, .doc = "what is added"},
                                {.name = "history", .types = kColor | kAlbedo, .doc = "the sum so far", .optional = true},
                                {.name = "extra", .types = kAnyFloatImage, .doc = "copied", .optional = true, .array = true}},
                     .outputs = {{.name = "color", .doc = "the sum", .same_as = "color"},
                                 {.name = "frame", .types = kValue, .doc = "number of the frame"},
                                 {.name = "copies", .doc = "what came in by extra", .array = true, .same_as = "extra"}}};

class RunningSum final : public Pass {
 public:
  explicit RunningSum(const Params& params) : gain_(params.negate ? -params.gain : params.gain) {}
  void infer(Inference& about) const override { about.set_in_place("color", "color"), about.set_in_place("copies", "extra"); }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color"), history = frame.image("history");
    const FloatOutput out = frame.output("color");
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int c = 0; c < out.channels; ++c)
        for (int y = y0; y < y1; ++y)
          for (int x = 0; x < out.width; ++x)
            out.at(x, y, c) = gain_ * color.at(x, y, c) + (history ? history.at(x, y, c) : 0.0F);
    });
    frame.output_values("frame")[0] = static_cast<double>(frame.number());
    for (std::size_t i = 0; i < frame.count("extra"); ++i) copy(frame.image("extra", i), frame.output("copies", i));
  }

 private:
  static void copy(const FloatImage& from, const FloatOutput& to) {
    for (int c = 0; c < to.channels; ++c)
      for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x) to.at(x, y, c) = from.at(x, y, c);  // std::copy_n must not be given one place twice
  }
  float gain_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, RunningSum, Params)
