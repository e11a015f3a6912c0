// For tests of shapes: every other pixel.
#include "tests/core/runtime/passes/ring.h"

namespace {
using namespace quell;

struct Params {
  int salt = 0;
  void describe(auto&& field) { field("salt", salt, Range<int>{0, 1000}, "", "Added."); }
};

const PassInfo kInfo{.id = "shrink",
                     .summary = "every other pixel",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "halved"}},
                     .outputs = {{.name = "color", .doc = "half the size, rounded up", .same_as = "color"}}};

class Shrink final : public Pass {
 public:
  explicit Shrink(const Params& params) : params_(params) {}
  void infer(Inference& about) const override {
    const Size size = about.size("color");
    about.set_size("color", {(size.width + 1) / 2, (size.height + 1) / 2});
    about.set_radius("color", QUELL_RADIUS_UNBOUNDED);
  }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    ring::fill(frame, frame.output("color"),
               [&](int x, int y, int c) { return params_.salt + ring::at(color, 2 * x, 2 * y, c); });
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Shrink, Params)
