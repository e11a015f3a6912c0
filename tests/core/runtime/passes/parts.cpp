// For tests of port arrays: a list in, a list out.
#include "tests/core/runtime/passes/ring.h"

namespace {
using namespace quell;

struct Params {
  int salt = 0;
  bool in_place = false;
  void describe(auto&& field) {
    field("salt", salt, Range<int>{0, 1000}, "", "Added.");
    field("in_place", in_place, "Writes over the items.");
  }
};

const PassInfo kInfo{.id = "parts",
                     .summary = "each item + color",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "added to each"},
                                {.name = "items", .types = kAnyFloatImage, .doc = "the list", .optional = true, .array = true}},
                     .outputs = {{.name = "items", .doc = "the sums", .array = true, .same_as = "items"}}};

class Parts final : public Pass {
 public:
  explicit Parts(const Params& params) : params_(params) {}
  void infer(Inference& about) const override {
    if (params_.in_place) about.set_in_place("items", "items");
    about.set_by_rows();
  }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    for (std::size_t i = 0; i < frame.count("items"); ++i) {
      const FloatImage item = frame.image("items", i);
      const FloatOutput out = frame.output("items", i);
      if (!out) continue;
      ring::fill(frame, out, [&](int x, int y, int c) {
        const std::int64_t own = item ? 2 * ring::at(item, x, y, c) : 29;
        return params_.salt + static_cast<std::int64_t>(i) + own + 3 * ring::at(color, x, y, c);
      });
    }
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Parts, Params)
