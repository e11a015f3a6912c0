/* Built for the interface CLAIMED_ABI. What it would hand out must not be looked at. */
#include <stdlib.h>

#include "plain_pass.h"

EXPORT uint32_t quell_plugin_abi(void) { return CLAIMED_ABI; }
EXPORT const quell_pass_desc* const* quell_plugin_passes(uint32_t* count) {
  (void)count;
  abort();
}
