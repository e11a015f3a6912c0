// For tests of values: an image times a number.
#include "tests/core/runtime/passes/ring.h"

namespace {
using namespace quell;

struct Params {
  int salt = 0;
  void describe(auto&& field) { field("salt", salt, Range<int>{0, 1000}, "", "Added."); }
};

const PassInfo kInfo{.id = "apply",
                     .summary = "color * by[0] + by[1]",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "multiplied"},
                                {.name = "by", .types = kValue, .doc = "factor and addend", .optional = true}},
                     .outputs = {{.name = "color", .doc = "the product", .same_as = "color"}}};

class Apply final : public Pass {
 public:
  explicit Apply(const Params& params) : params_(params) {}
  void infer(Inference& about) const override { about.set_by_rows(); }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    const std::int64_t factor = frame.has("by") ? ring::number(frame.values("by")[0]) : 1;
    const std::int64_t addend = frame.has("by") ? ring::number(frame.values("by")[1]) : 0;
    ring::fill(frame, frame.output("color"),
               [&](int x, int y, int c) { return params_.salt + factor * ring::at(color, x, y, c) + addend; });
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Apply, Params)
