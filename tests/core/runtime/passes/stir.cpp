// For tests of schedules: everything that it reads changes what comes out, and so does what is absent.
#include "tests/core/runtime/passes/ring.h"

namespace {
using namespace quell;

struct Params {
  int salt = 0;
  bool in_place = false;
  void describe(auto&& field) {
    field("salt", salt, Range<int>{0, 1000}, "", "Added.");
    field("in_place", in_place, "Writes over color.");
  }
};

const PassInfo kInfo{.id = "stir",
                     .summary = "a sum of all that is there",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "added"},
                                {.name = "other", .types = kAnyFloatImage, .doc = "added", .optional = true},
                                {.name = "more", .types = kAnyFloatImage, .doc = "added", .optional = true, .array = true}},
                     .outputs = {{.name = "color", .doc = "the sum", .same_as = "color"}}};

class Stir final : public Pass {
 public:
  explicit Stir(const Params& params) : params_(params) {}
  void infer(Inference& about) const override {
    if (params_.in_place) about.set_in_place("color", "color");
    about.set_by_rows();
  }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color"), other = frame.image("other");
    std::vector<FloatImage> more;
    for (std::size_t i = 0; i < frame.count("more"); ++i) more.push_back(frame.image("more", i));
    ring::fill(frame, frame.output("color"), [&](int x, int y, int c) {
      std::int64_t sum = params_.salt + 3 * ring::at(color, x, y, c) + (other ? 5 * ring::at(other, x, y, c) : 7);
      for (int i = 0; i < static_cast<int>(more.size()); ++i) {
        const FloatImage& image = more[static_cast<std::size_t>(i)];
        sum += image ? (11 + 2 * i) * ring::at(image, x, y, c) : 13 + i;
      }
      return sum;
    });
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Stir, Params)
