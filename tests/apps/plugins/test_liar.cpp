// A pass whose answer to infer breaks the plugin interface.
#include "quell/sdk/pass.h"

namespace {

using namespace quell;

struct Params {};

const PassInfo kInfo{
    .id = "test_liar",
    .summary = "Breaks the plugin interface",
    .inputs = {{"color", kColor, ""}},
    .outputs = {{"color", kColor, ""}},
};

class TestLiar final : public Pass {
 public:
  explicit TestLiar(const Params&) {}
  void infer(Inference& inference) const override { inference.set_size("color", {-1, 7}); }
  void run(const Frame&) const override {}
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, TestLiar, Params)
