// An output of the same type as an input that does not exist, and a Params that cannot be made: both come to light while the
// plugin is being loaded, when nothing may be thrown.
#include <stdexcept>

#include "quell/sdk/pass.h"

namespace {
using namespace quell;

struct NoParams {};
struct UnmakeableParams {
  UnmakeableParams() { throw std::runtime_error("never"); }
};

template <class Params>
class Copy final : public Pass {
 public:
  explicit Copy(const Params&) {}
  void run(const Frame&) const override {}
};

const PassInfo kDangling{
    .id = "dangling", .inputs = {{.name = "color", .types = kColor}}, .outputs = {{.name = "color", .same_as = "colour"}}};
const PassInfo kUnmakeable{.id = "unmakeable", .outputs = {{.name = "color", .types = kColor}}};
[[maybe_unused]] const bool kRegistered = detail::register_pass<Copy<UnmakeableParams>, UnmakeableParams>(kUnmakeable);

}  // namespace

QUELL_REGISTER_PASS(kDangling, Copy<NoParams>, NoParams)
