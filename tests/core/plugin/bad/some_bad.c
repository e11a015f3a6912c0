/* One good pass between bad ones. */
#include "plain_pass.h"

static const quell_pass_desc small = {sizeof(quell_pass_desc) - 8, 1, 1, "small", 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
static const quell_pass_desc garbage = {0xdeadbeefu, 0xdeadbeefu, 0, (const char*)0x1234, 0, 0, 0, 0, 0, 0,
                                        0,           0,           0, 0,                   0, 0, 0, 0, 0};
static const quell_pass_desc good = PLAIN_PASS("good");
static const quell_pass_desc no_process = PASS("no_process", plain_create, plain_infer, 0);
static const quell_pass_desc* const passes[] = {&small, &garbage, &good, 0, &no_process};

EXPORT uint32_t quell_plugin_abi(void) { return QUELL_ABI_VERSION; }
EXPORT const quell_pass_desc* const* quell_plugin_passes(uint32_t* count) {
  *count = 5;
  return passes;
}
