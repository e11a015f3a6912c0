// For benchmarks of scheduling: takes a known time of one thread, or of all.
#include <cstdint>

#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct Params {
  int rounds = 0;
  bool parallel = false;
  void describe(auto&& field) {
    field("rounds", rounds, Range<int>{0, 1'000'000'000}, "",
          "Steps of a random generator, each of which waits for the one before.");
    field("parallel", parallel, "Whether the rounds are shared among the bands of the image.");
  }
};

const PassInfo kInfo{.id = "burn",
                     .summary = "color + other, with work to do",
                     .source = "benchmark",
                     .inputs = {{.name = "color", .types = kColor, .doc = "added"},
                                {.name = "other", .types = kColor, .doc = "added", .optional = true}},
                     .outputs = {{.name = "color", .types = kColor, .doc = "the sum"}}};

// Knuth's linear congruential generator (The Art of Computer Programming 2, 3.3.4): 64-bit multiplications in a chain.
std::uint64_t burn(std::uint64_t seed, int rounds) {
  for (int i = 0; i < rounds; ++i) seed = seed * 6364136223846793005U + 1442695040888963407U;
  return seed;
}

class Burn final : public Pass {
 public:
  explicit Burn(const Params& params) : params_(params) {}
  void infer(Inference& about) const override { about.set_in_place("color", "color"); }
  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color"), other = frame.image("other");
    const FloatOutput out = frame.output("color");
    const int bands = params_.parallel ? (out.height + Frame::kRowsPerChunk - 1) / Frame::kRowsPerChunk : 1;
    const auto add = [&](int y0, int y1) {
      // Never 1, which no compiler knows.
      const float nothing = burn(static_cast<std::uint64_t>(y0), params_.rounds / bands) == 1 ? 1.0F : 0.0F;
      for (int c = 0; c < out.channels; ++c)
        for (int y = y0; y < y1; ++y)
          for (int x = 0; x < out.width; ++x) out.at(x, y, c) = color.at(x, y, c) + (other ? other.at(x, y, c) : 0.0F) + nothing;
    };
    if (params_.parallel)
      frame.parallel_rows(out.height, add);
    else
      add(0, out.height);
  }

 private:
  Params params_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Burn, Params)
