// For tests of memory: numbers of one format written over numbers of another.
#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct Params {};

const PassInfo kInfo{.id = "weigh",
                     .summary = "the id as a number",
                     .source = "test",
                     .inputs = {{.name = "id", .types = kId, .doc = "read"}},
                     .outputs = {{.name = "weight", .types = kScalar, .doc = "the number"}}};

class Weigh final : public Pass {
 public:
  explicit Weigh(const Params&) {}
  void infer(Inference& about) const override { about.set_in_place("weight", "id"); }
  void run(const Frame& frame) const override {
    const IdImage id = frame.ids("id");
    const FloatOutput out = frame.output("weight");
    for (int y = 0; y < out.height; ++y)
      for (int x = 0; x < out.width; ++x) out.at(x, y) = static_cast<float>(id.at(x, y));
  }
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Weigh, Params)
