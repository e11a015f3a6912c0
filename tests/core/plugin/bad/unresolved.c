/* Calls a function that no library has; built without --no-undefined. */
#include "plain_pass.h"

uint32_t missing_helper(void);

EXPORT uint32_t quell_plugin_abi(void) { return missing_helper(); }
