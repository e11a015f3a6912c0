// For tests of values: two numbers, from those before, a pixel and the frame's number.
#include "tests/core/runtime/passes/ring.h"

namespace {
using namespace quell;

struct Params {
  int salt = 0;
  void describe(auto&& field) { field("salt", salt, Range<int>{0, 1000}, "", "Added."); }
};

const PassInfo kInfo{.id = "tally",
                     .summary = "a running number",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "its first pixel counts"},
                                {.name = "previous", .types = kValue, .doc = "the numbers before", .optional = true}},
                     .outputs = {{.name = "count", .types = kValue, .doc = "the number, and that of the frame"}}};

class Tally final : public Pass {
 public:
  explicit Tally(const Params& params) : params_(params) {}
  void infer(Inference& about) const override { about.set_value_count("count", 2); }
  void run(const Frame& frame) const override {
    const std::int64_t before = frame.has("previous") ? 3 * ring::number(frame.values("previous")[0]) : 31;
    const std::int64_t sum = params_.salt + before + ring::at(frame.image("color"), 0, 0, 0);
    frame.output_values("count")[0] = double{ring::wrap(sum)};
    frame.output_values("count")[1] = double{ring::wrap(frame.number() + ring::kModulus)};
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Tally, Params)
