// A pass whose class and parameters have names of their own in no unnamed namespace, as two authors might choose them alike. Built
// twice, with another ID.
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
