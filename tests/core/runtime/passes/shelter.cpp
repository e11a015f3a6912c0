// For tests of scratch memory: the image upside down, through the scratch of the thread and that of the frame.
#include <algorithm>

#include "tests/core/runtime/passes/ring.h"

namespace {
using namespace quell;

struct Params {
  int salt = 0;
  void describe(auto&& field) { field("salt", salt, Range<int>{0, 1000}, "", "Added."); }
};

const PassInfo kInfo{.id = "shelter",
                     .summary = "twice the image, upside down",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "turned"}},
                     .outputs = {{.name = "color", .doc = "the turned one", .same_as = "color"}}};

class Shelter final : public Pass {
 public:
  explicit Shelter(const Params& params) : params_(params) {}
  void infer(Inference& about) const override {
    const auto width = static_cast<std::size_t>(about.size("color").width);
    const auto height = static_cast<std::size_t>(about.size("color").height);
    about.set_unbounded("color");
    about.set_scratch(3 * width * height * sizeof(float));
    about.set_slot_scratch(width * sizeof(float));
  }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    const FloatOutput out = frame.output("color");
    auto* kept = static_cast<float*>(frame.scratch());
    const auto row = [&](int y, int c) { return kept + (std::ptrdiff_t{c} * color.height + y) * color.width; };
    const auto keep = [&](int y0, int y1, std::uint32_t slot) {
      auto* doubled = static_cast<float*>(frame.slot_scratch(slot));
      for (int c = 0; c < color.channels; ++c)
        for (int y = y0; y < y1; ++y) {
          for (int x = 0; x < color.width; ++x) doubled[x] = 2 * color.at(x, y, c);
          std::copy_n(doubled, color.width, row(y, c));
        }
    };
    frame.parallel_rows(color.height, keep, 2);
    ring::fill(frame, out,
               [&](int x, int y, int c) { return params_.salt + ring::number(double{row(color.height - 1 - y, c)[x]}); });
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Shelter, Params)
