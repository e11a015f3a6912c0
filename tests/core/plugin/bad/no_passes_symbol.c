/* Answers the probe, and then has no passes to show. */
#include "plain_pass.h"

EXPORT uint32_t quell_plugin_abi(void) { return QUELL_ABI_VERSION; }
