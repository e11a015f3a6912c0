// For tests of schedules: one plane of several.
#include "tests/core/runtime/passes/ring.h"

namespace {
using namespace quell;

struct Params {
  int salt = 0;
  void describe(auto&& field) { field("salt", salt, Range<int>{0, 1000}, "", "Added."); }
};

const PassInfo kInfo{.id = "reduce",
                     .summary = "a weighted sum of the planes",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "summed"}},
                     .outputs = {{.name = "weight", .types = kScalar, .doc = "the sum"}}};

class Reduce final : public Pass {
 public:
  explicit Reduce(const Params& params) : params_(params) {}
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    ring::fill(frame, frame.output("weight"), [&](int x, int y, int) {
      std::int64_t sum = params_.salt;
      for (int c = 0; c < color.channels; ++c) sum += (c + 1) * ring::at(color, x, y, c);
      return sum;
    });
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Reduce, Params)
