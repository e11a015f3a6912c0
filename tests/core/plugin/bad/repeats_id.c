/* Brings a pass that raw.c brings, too, and one of its own. */
#include "plain_pass.h"

static const quell_pass_desc repeated = PLAIN_PASS("raw");
static const quell_pass_desc own = PLAIN_PASS("own");
static const quell_pass_desc* const passes[] = {&repeated, &own};

EXPORT uint32_t quell_plugin_abi(void) { return QUELL_ABI_VERSION; }
EXPORT const quell_pass_desc* const* quell_plugin_passes(uint32_t* count) {
  *count = 2;
  return passes;
}
