// Throws out of the two exported functions: out of the probe, or out of the list when ONLY_IN_LIST is defined.
#include <stdexcept>

#include "plain_pass.h"

extern "C" EXPORT uint32_t quell_plugin_abi(void) {
#ifdef ONLY_IN_LIST
  return QUELL_ABI_VERSION;
#else
  throw std::runtime_error("no probe today");
#endif
}
extern "C" EXPORT const quell_pass_desc* const* quell_plugin_passes(uint32_t*) { throw 42; }
