// A pass whose class lies in no unnamed namespace, so that two authors may choose the same names. Built twice, with another ID.
#include "quell/sdk/pass.h"

namespace somebody {
using namespace quell;

struct Params {};

class Copy final : public Pass {
 public:
  explicit Copy(const Params&) {}
  void run(const Frame&) const override {}
};

const PassInfo kInfo{.id = ID, .outputs = {{.name = "color", .types = kColor}}};

}  // namespace somebody

QUELL_REGISTER_PASS(somebody::kInfo, somebody::Copy, somebody::Params)
