// For tests of schedules: reads a window around each pixel, each of its taps with another weight.
#include "tests/core/runtime/passes/ring.h"

namespace {
using namespace quell;

struct Params {
  int salt = 0;
  int radius = 1;
  void describe(auto&& field) {
    field("salt", salt, Range<int>{0, 1000}, "", "Added.");
    field("radius", radius, Range<int>{0, 3}, "px", "Of the window.");
  }
};

const PassInfo kInfo{.id = "soften",
                     .summary = "a weighted sum over a window",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "summed"}},
                     .outputs = {{.name = "color", .doc = "the sum", .same_as = "color"}}};

class Soften final : public Pass {
 public:
  explicit Soften(const Params& params) : params_(params) {}
  void infer(Inference& about) const override {
    about.set_radius("color", params_.radius);
    about.set_by_rows();
  }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    const int r = params_.radius;
    ring::fill(frame, frame.output("color"), [&](int x, int y, int c) {
      std::int64_t sum = params_.salt;
      for (int dy = -r; dy <= r; ++dy)
        for (int dx = -r; dx <= r; ++dx)
          if (color.contains(x + dx, y + dy)) sum += (3 + dx + r + 5 * (dy + r)) * ring::at(color, x + dx, y + dy, c);
      return sum;
    });
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Soften, Params)
