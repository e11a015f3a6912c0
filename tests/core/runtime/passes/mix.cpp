// For tests of edges: color + weight * other, with the mean of a 3x3 window of color, so that bands read each other's rows.
#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct Params {
  float weight = 1.0F;
  void describe(auto&& field) { field("weight", weight, Range<float>{-10, 10}, "", "Factor of other."); }
};

const PassInfo kInfo{.id = "mix",
                     .summary = "mean of color + weight * other",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kColor, .doc = "smoothed"},
                                {.name = "other", .types = kColor, .doc = "added", .optional = true}},
                     .outputs = {{.name = "color", .types = kColor, .doc = "the sum"}}};

class Mix final : public Pass {
 public:
  explicit Mix(const Params& params) : params_(params) {}
  void infer(Inference& about) const override {
    about.set_radius("color", 1);
    about.set_by_rows();
  }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color"), other = frame.image("other");
    const FloatOutput out = frame.output("color");
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int c = 0; c < out.channels; ++c)
        for (int y = y0; y < y1; ++y)
          for (int x = 0; x < out.width; ++x)
            out.at(x, y, c) = mean(color, x, y, c) + (other ? params_.weight * other.at(x, y, c) : 0.0F);
    });
  }

 private:
  static float mean(const FloatImage& image, int x, int y, int c) {
    float sum = 0, count = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (image.contains(x + dx, y + dy)) sum += image.at(x + dx, y + dy, c), count += 1;
    return sum / count;
  }
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Mix, Params)
