// For the test of the race detector: a pass that remembers something from frame to frame, which no pass may.
#include "quell/sdk/pass.h"
#include "tests/core/runtime/passes/meeting.h"

namespace {
using namespace quell;

struct Params {};

const PassInfo kInfo{.id = "races_between_frames",
                     .summary = "color + what was there before",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kColor, .doc = "added"}},
                     .outputs = {{.name = "color", .types = kColor, .doc = "the sum"}}};

class RacesBetweenFrames final : public Pass {
 public:
  explicit RacesBetweenFrames(const Params&) {}
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    const FloatOutput out = frame.output("color");
    meeting_.wait();
    last_ += color.at(0, 0);
    for (int c = 0; c < out.channels; ++c)
      for (int y = 0; y < out.height; ++y) std::fill_n(out.row(y, c), out.width, last_);
  }

 private:
  mutable Meeting meeting_;
  mutable float last_ = 0;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, RacesBetweenFrames, Params)
