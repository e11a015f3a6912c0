#include "quell/plugin/pass_instance.h"

#include <algorithm>
#include <cassert>

#include "quell/plugin/check_inference.h"
#include "quell/plugin/loader.h"
#include "quell/plugin/param_value.h"

namespace quell {
namespace {

/// The host that serves create and infer, which come before any frame: loops run inline, messages are kept.
class InlineHost {
 public:
  InlineHost() { host_ = {sizeof(host_), QUELL_ABI_VERSION, this, parallel_for, log, cancelled, set_error}; }
  const quell_host* get() const { return &host_; }
  std::string reason() const { return error_.empty() ? "the pass failed and gave no reason" : error_; }

 private:
  static quell_status parallel_for(const quell_host*, std::int64_t begin, std::int64_t end, std::int64_t grain, quell_chunk_fn fn,
                                   void* context) {
    grain = std::max<std::int64_t>(grain, 1);
    quell_status first_failure = QUELL_OK;
    for (std::int64_t chunk = 0; begin < end; ++chunk) {
      const std::int64_t next = end - begin < grain ? end : begin + grain;
      const quell_status status = fn(context, chunk, begin, next, 0);
      if (first_failure == QUELL_OK) first_failure = status;
      begin = next;
    }
    return first_failure;
  }
  static void log(const quell_host*, int, const char*) {}  // nobody listens before the first frame
  static int cancelled(const quell_host*) { return 0; }
  static void set_error(const quell_host* host, const char* message) {
    static_cast<InlineHost*>(host->context)->error_ = message ? message : "";
  }
  quell_host host_{};
  std::string error_;
};

std::string where(const quell_pass_desc& desc) { return "pass '" + std::string(desc.id) + "'"; }

}  // namespace

PassInstance::PassInstance(const quell_pass_desc& desc, std::vector<ParamValue> values)
    : desc_(desc), values_(std::move(values)) {
  assert(values_.size() == desc.param_count);
  const RawParams params(desc, values_);
  InlineHost host;
  quell_status status = QUELL_FAILED;
  const std::string thrown = thrown_by([&] { status = desc.create(host.get(), params.data(), &instance_); });
  if (!thrown.empty()) throw Error(Fault::plugin, where(desc), "create breaks the plugin interface: " + thrown);
  if (status != QUELL_OK) throw Error(Fault::usage, where(desc), host.reason());
  if (!instance_)
    throw Error(Fault::plugin, where(desc), "create breaks the plugin interface: it reports success without an instance");
}

PassInstance::~PassInstance() {
  thrown_by([&] { desc_.destroy(instance_); });  // nobody is left to hear of it
}

void PassInstance::infer(quell_inference& inference) const {
  const InferenceCheck before(desc_, inference);
  InlineHost host;
  quell_status status = QUELL_FAILED;
  const std::string thrown = thrown_by([&] { status = desc_.infer(instance_, host.get(), &inference); });
  if (!thrown.empty()) throw Error(Fault::plugin, where(desc_), "infer breaks the plugin interface: " + thrown);
  if (status != QUELL_OK) throw Error(Fault::usage, where(desc_), host.reason());
  if (const std::string wrong = before.find_fault(inference); !wrong.empty()) throw Error(Fault::plugin, where(desc_), wrong);
}

quell_status PassInstance::process(const quell_host& host, const quell_exec& exec) const {
  quell_status status = QUELL_FAILED;
  const std::string thrown = thrown_by([&] { status = desc_.process(instance_, &host, &exec); });
  if (!thrown.empty()) {
    host.set_error(&host, ("process breaks the plugin interface: " + thrown).c_str());
    return QUELL_FAILED;
  }
  return status;
}

}  // namespace quell
