/* An array of passes that is null (COUNT passes claimed). */
#include "plain_pass.h"

EXPORT uint32_t quell_plugin_abi(void) { return QUELL_ABI_VERSION; }
EXPORT const quell_pass_desc* const* quell_plugin_passes(uint32_t* count) {
  *count = COUNT;
  return 0;
}
