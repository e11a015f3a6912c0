// A pass that does as it is told, well or badly, so that the runner can be watched.
#include <chrono>
#include <thread>

#include "quell/sdk/pass.h"

namespace {

using namespace quell;

enum class Wrong { nothing, fail, warn };

struct Params {
  double gain = 1;
  std::vector<int> at = {};
  Wrong wrong = Wrong::fail;
  int wait_from = 1'000'000;
  bool stubborn = false;
  std::filesystem::path table = "";

  void describe(auto&& field) {
    field("gain", gain, Range<double>{0, 1e9}, "1", "Factor of every value.");
    field("at", at, Range<int>{-1000, 1000}, Length{0, 10}, "frame", "Frames in which something goes wrong.");
    field(
        "wrong", wrong,
        Choices{{"nothing", "all is well"}, {"fail", "the pass fails"}, {"warn", "the pass logs a warning and a debug message"}},
        "What goes wrong.");
    field("wait_from", wait_from, Range<int>{-1'000'000, 1'000'000}, "frame",
          "From this frame on the pass waits to be cancelled.");
    field("stubborn", stubborn, "The pass does not hear that it is cancelled.");
    field("table", table, "Not used.");
  }
};

const PassInfo kInfo{
    .id = "test_scale",
    .version = 3,
    .oldest_version = 1,
    .summary = "Multiplies by a number",
    .doc =
        "Every channel is multiplied by the same number. This line is long enough that a terminal of 100 columns has to break "
        "it at least once.\n\nAnd there is a second paragraph.",
    .source = "Nobody, \"On Multiplication\", 1900, equation 1.",
    .inputs = {{"color", kColor | kAlbedo | kNormal, "what is multiplied"}, {"more", kColor, "not used", true, true}},
    .outputs = {{.name = "color", .doc = "the product", .same_as = "color"}},
    .changes = {{2, "factor", "gain"}, {3, "wrong", nullptr, std::string("nothing")}},
};

class TestScale final : public Pass {
 public:
  explicit TestScale(const Params& params) : params_(params) {
    if (params.gain > 2e5) throw std::invalid_argument("a gain above 200000 is too much");
  }

  void run(const Frame& frame) const override {
    const bool now = std::count(params_.at.begin(), params_.at.end(), frame.number()) > 0;
    if (now && params_.wrong == Wrong::fail) throw std::runtime_error("told to fail in frame " + std::to_string(frame.number()));
    if (now && params_.wrong == Wrong::warn) {
      frame.log(QUELL_LOG_WARNING, "a warning of the pass");
      frame.log(QUELL_LOG_DEBUG, "a detail of the pass");
    }
    if (frame.number() >= params_.wait_from) wait(frame, params_.stubborn);
    const FloatImage in = frame.image("color");
    const FloatOutput out = frame.output("color");
    frame.parallel_rows(in.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y)
        for (int c = 0; c < in.channels; ++c)
          for (int x = 0; x < in.width; ++x) out.row(y, c)[x] = in.row(y, c)[x] * static_cast<float>(params_.gain);
    });
  }

 private:
  // The limit is for a host that never cancels: the test then fails instead of hanging.
  static void wait(const Frame& frame, bool stubborn) {
    frame.log(QUELL_LOG_INFO, "waiting");
    for (int i = 0; i < 3000 && (stubborn || !frame.cancelled()); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, TestScale, Params)
