// For tests of resets: 1 in the frames named, else 0; and a second number, as other values of these tests have.
#include <algorithm>
#include <vector>

#include "tests/core/runtime/passes/ring.h"

namespace {
using namespace quell;

struct Params {
  std::vector<int> frames;
  void describe(auto&& field) { field("frames", frames, Range<int>{}, Length{}, "frame", "Those with a 1."); }
};

const PassInfo kInfo{.id = "pulse",
                     .summary = "1 in some frames",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "not looked at"}},
                     .outputs = {{.name = "count", .types = kValue, .doc = "1 or 0, and 17"}}};

class Pulse final : public Pass {
 public:
  explicit Pulse(const Params& params) : params_(params) {}
  void infer(Inference& about) const override { about.set_value_count("count", 2); }
  void run(const Frame& frame) const override {
    const bool is_named = std::ranges::find(params_.frames, frame.number()) != params_.frames.end();
    frame.output_values("count")[0] = is_named ? 1 : 0;
    frame.output_values("count")[1] = 17;
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Pulse, Params)
