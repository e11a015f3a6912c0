// How bright a color is.
//
// Source:  ITU-R BT.709-6, item 3.2: Y = 0.2126 R + 0.7152 G + 0.0722 B of linear components.
//
// Cost:    three multiplications a pixel; bound by memory.
#include "quell/sdk/pass.h"

namespace quell {
namespace {

struct Params {};

const PassInfo kInfo{.id = "luminance",
                     .summary = "Luminance of linear color",
                     .doc = "luminance = 0.2126 R + 0.7152 G + 0.0722 B, in the unit of the color.",
                     .source = "ITU-R BT.709-6, item 3.2.",
                     .inputs = {{.name = "color", .types = kColor, .doc = "linear color with BT.709 primaries"}},
                     .outputs = {{.name = "luminance", .types = kScalar, .doc = "its luminance"}}};

class Luminance final : public Pass {
 public:
  explicit Luminance(const Params&) {}

  void infer(Inference& inference) const override { inference.set_by_rows(); }

  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    const FloatOutput out = frame.output("luminance");
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) {
        const float *red = color.row(y, 0), *green = color.row(y, 1), *blue = color.row(y, 2);
        float* __restrict to = out.row(y);
        for (int x = 0; x < out.width; ++x) to[x] = 0.2126F * red[x] + 0.7152F * green[x] + 0.0722F * blue[x];
      }
    });
  }
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Luminance, quell::Params)
