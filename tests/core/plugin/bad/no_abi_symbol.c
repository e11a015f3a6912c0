/* Some shared object, but no plugin. */
#include "plain_pass.h"

EXPORT int nothing_of_quell(void) { return 1; }
