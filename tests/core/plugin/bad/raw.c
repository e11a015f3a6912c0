/* A plugin in plain C, without the C++ layer. Nothing is wrong with it. */
#include "plain_pass.h"

#ifndef CLAIMED_ABI
#define CLAIMED_ABI QUELL_ABI_VERSION
#endif

static const quell_pass_desc pass = PLAIN_PASS("raw");
static const quell_pass_desc* const passes[] = {&pass};

EXPORT uint32_t quell_plugin_abi(void) { return CLAIMED_ABI; }
EXPORT const quell_pass_desc* const* quell_plugin_passes(uint32_t* count) {
  *count = 1;
  return passes;
}
