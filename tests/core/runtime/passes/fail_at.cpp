// For tests of failures: copies color, and throws on one frame.
#include <chrono>
#include <thread>

#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct Params {
  int frame = -1;
  bool wait = false;
  void describe(auto&& field) {
    field("frame", frame, Range<int>{}, "frame", "The frame that fails.");
    field("wait", wait, "Waits on that frame until cancelled, instead of throwing.");
  }
};

const PassInfo kInfo{.id = "fail_at",
                     .summary = "fails on one frame",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kColor, .doc = "copied"}},
                     .outputs = {{.name = "color", .types = kColor, .doc = "the copy"}}};

class FailAt final : public Pass {
 public:
  explicit FailAt(const Params& params) : params_(params) {}
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    const FloatOutput out = frame.output("color");
    while (params_.wait && frame.number() == params_.frame && !frame.cancelled())
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int c = 0; c < out.channels; ++c)
        for (int y = y0; y < y1; ++y)
          for (int x = 0; x < out.width; ++x) out.at(x, y, c) = color.at(x, y, c);
      if (frame.number() == params_.frame && y1 == out.height) throw std::runtime_error("this frame was told to fail");
    });
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, FailAt, Params)
