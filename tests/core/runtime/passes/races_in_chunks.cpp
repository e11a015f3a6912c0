// For the test of the race detector: sums over a whole image without telling the others.
#include "quell/sdk/pass.h"
#include "tests/core/runtime/passes/meeting.h"

namespace {
using namespace quell;

struct Params {};

const PassInfo kInfo{.id = "races_in_chunks",
                     .summary = "color, and a sum that no lock guards",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kColor, .doc = "summed"}},
                     .outputs = {{.name = "color", .types = kColor, .doc = "the sum, everywhere"}}};

class RacesInChunks final : public Pass {
 public:
  explicit RacesInChunks(const Params&) {}
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    const FloatOutput out = frame.output("color");
    float sum = 0;
    Meeting meeting;
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      meeting.wait();
      for (int y = y0; y < y1; ++y)
        for (int x = 0; x < out.width; ++x) sum += color.at(x, y);
    });
    for (int c = 0; c < out.channels; ++c)
      for (int y = 0; y < out.height; ++y) std::fill_n(out.row(y, c), out.width, sum);
  }
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, RacesInChunks, Params)
