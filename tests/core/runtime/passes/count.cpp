// For tests of values: one more than before.
#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct Params {};

const PassInfo kInfo{.id = "count",
                     .summary = "previous + 1",
                     .source = "test",
                     .inputs = {{.name = "color", .types = kColor, .doc = "unread"},
                                {.name = "previous", .types = kValue, .doc = "the count before", .optional = true}},
                     .outputs = {{.name = "count", .types = kValue, .doc = "the count"}}};

class Count final : public Pass {
 public:
  explicit Count(const Params&) {}
  void run(const Frame& frame) const override {
    frame.output_values("count")[0] = frame.has("previous") ? frame.values("previous")[0] + 1 : 1;
  }
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Count, Params)
