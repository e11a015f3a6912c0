// Lets exceptions through the C interface, which the SDK would catch.
#include <stdexcept>

#include "plain_pass.h"

namespace {

quell_status create_throws(const quell_host*, const quell_param_value*, void**) { throw std::runtime_error("no create today"); }
quell_status infer_throws(const void*, const quell_host*, quell_inference*) { throw std::runtime_error("no infer today"); }
quell_status process_throws(const void*, const quell_host*, const quell_exec*) { throw 42; }
void destroy_throws(void*) { throw std::runtime_error("no destroy today"); }

const quell_pass_desc in_create = PASS("raw_create", create_throws, plain_infer, plain_process);
const quell_pass_desc in_infer = PASS("raw_infer", plain_create, infer_throws, plain_process);
const quell_pass_desc in_process = PASS("raw_process", plain_create, plain_infer, process_throws);
quell_pass_desc in_destroy() {
  quell_pass_desc desc = PLAIN_PASS("raw_destroy");
  desc.destroy = destroy_throws;
  return desc;
}

}  // namespace

extern "C" EXPORT uint32_t quell_plugin_abi(void) { return QUELL_ABI_VERSION; }
extern "C" EXPORT const quell_pass_desc* const* quell_plugin_passes(uint32_t* count) {
  static const quell_pass_desc last = in_destroy();
  static const quell_pass_desc* const passes[] = {&in_create, &in_infer, &in_process, &last};
  *count = 4;
  return passes;
}
