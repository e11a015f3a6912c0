// For tests of overlap: adds, and takes its time.
#include <chrono>
#include <thread>

#include "tests/core/runtime/passes/ring.h"

namespace {
using namespace quell;

struct Params {
  int salt = 0;
  int milliseconds = 1;
  int every = 1;
  void describe(auto&& field) {
    field("salt", salt, Range<int>{0, 1000}, "", "Added.");
    field("milliseconds", milliseconds, Range<int>{0, 1000}, "ms", "Slept.");
    field("every", every, Range<int>{1, 1000}, "frame", "Sleeps when the frame's number is a multiple.");
  }
};

const PassInfo kInfo{.id = "linger",
                     .summary = "color + salt, slowly",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kAnyFloatImage, .doc = "added"}},
                     .outputs = {{.name = "color", .doc = "the sum", .same_as = "color"}}};

class Linger final : public Pass {
 public:
  explicit Linger(const Params& params) : params_(params) {}
  void infer(Inference& about) const override { about.set_in_place("color", "color"); }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    if (frame.number() % params_.every == 0) std::this_thread::sleep_for(std::chrono::milliseconds(params_.milliseconds));
    ring::fill(frame, frame.output("color"), [&](int x, int y, int c) { return params_.salt + ring::at(color, x, y, c); });
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Linger, Params)
