/* Calls a function that no library has; built without --no-undefined. */
#include "plain_pass.h"

uint32_t quell_test_function_that_does_not_exist(void);

EXPORT uint32_t quell_plugin_abi(void) { return quell_test_function_that_does_not_exist(); }
