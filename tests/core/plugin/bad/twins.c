/* Brings one id twice. */
#include "plain_pass.h"

static const quell_pass_desc first = PLAIN_PASS("twin");
static const quell_pass_desc second = PLAIN_PASS("twin");
static const quell_pass_desc* const passes[] = {&first, &second};

EXPORT uint32_t quell_plugin_abi(void) { return QUELL_ABI_VERSION; }
EXPORT const quell_pass_desc* const* quell_plugin_passes(uint32_t* count) {
  *count = 2;
  return passes;
}
