/* Passes that report failures, with words and without. */
#include "plain_pass.h"

static quell_status create_with_words(const quell_host* host, const quell_param_value* params, void** instance) {
  (void)params, (void)instance;
  host->set_error(host, "the weights do not fit");
  return QUELL_FAILED;
}
static quell_status create_without_words(const quell_host* host, const quell_param_value* params, void** instance) {
  (void)host, (void)params, (void)instance;
  return QUELL_FAILED;
}
static quell_status create_nothing(const quell_host* host, const quell_param_value* params, void** instance) {
  (void)host, (void)params, (void)instance;
  return QUELL_OK;
}
static quell_status infer_with_words(const void* instance, const quell_host* host, quell_inference* inference) {
  (void)instance, (void)inference;
  host->set_error(host, "needs an even width");
  return QUELL_FAILED;
}
static quell_status infer_without_words(const void* instance, const quell_host* host, quell_inference* inference) {
  (void)instance, (void)host, (void)inference;
  return QUELL_FAILED;
}
static quell_status process_with_words(const void* instance, const quell_host* host, const quell_exec* exec) {
  (void)instance, (void)exec;
  host->set_error(host, "the frame is too dark");
  return QUELL_FAILED;
}

static const quell_pass_desc a = PASS("create_with_words", create_with_words, plain_infer, plain_process);
static const quell_pass_desc b = PASS("create_without_words", create_without_words, plain_infer, plain_process);
static const quell_pass_desc c = PASS("create_nothing", create_nothing, plain_infer, plain_process);
static const quell_pass_desc d = PASS("infer_with_words", plain_create, infer_with_words, plain_process);
static const quell_pass_desc e = PASS("infer_without_words", plain_create, infer_without_words, plain_process);
static const quell_pass_desc f = PASS("process_with_words", plain_create, plain_infer, process_with_words);
static const quell_pass_desc* const passes[] = {&a, &b, &c, &d, &e, &f};

EXPORT uint32_t quell_plugin_abi(void) { return QUELL_ABI_VERSION; }
EXPORT const quell_pass_desc* const* quell_plugin_passes(uint32_t* count) {
  *count = 6;
  return passes;
}
