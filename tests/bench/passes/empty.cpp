// For benchmarks of what a node costs beside what it computes: nothing.
#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct Params {
  void describe(auto&&) {}
};

const PassInfo kInfo{.id = "empty",
                     .summary = "color, as it is",
                     .source = "benchmark",
                     .inputs = {{.name = "color", .types = kColor, .doc = "handed on"}},
                     .outputs = {{.name = "color", .types = kColor, .doc = "the same memory"}}};

class Empty final : public Pass {
 public:
  explicit Empty(const Params&) {}
  void infer(Inference& about) const override { about.set_in_place("color", "color"); }
  void run(const Frame&) const override {}
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Empty, Params)
