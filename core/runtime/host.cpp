#include "quell/runtime/host.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace quell {

Host::Host(const HostServices& services) : services_(services), raw_{} {
  raw_.struct_size = sizeof(raw_);
  raw_.abi = QUELL_ABI_VERSION;
  raw_.context = this;
  raw_.parallel_for = parallel_for;
  raw_.log = [](const quell_host* host, int level, const char* message) {
    if (self(host).services_.log) self(host).services_.log(level, message ? message : "");
  };
  raw_.cancelled = [](const quell_host* host) -> int {
    const auto& cancelled = self(host).services_.cancelled;
    return cancelled && cancelled() ? 1 : 0;
  };
  raw_.set_error = [](const quell_host* host, const char* message) {
    const std::scoped_lock lock(self(host).mutex_);
    self(host).error_ = message ? message : "";
  };
}

std::string Host::take_error() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(error_, {});
}

quell_status Host::parallel_for(const quell_host* host, std::int64_t begin, std::int64_t end, std::int64_t grain,
                                quell_chunk_fn fn, void* context) {
  if (end <= begin) return QUELL_OK;
  if (self(host).services_.force_grain > 0) grain = self(host).services_.force_grain;
  grain = std::clamp<std::int64_t>(grain, 1, end - begin);  // so that no sum below goes far past the end
  const std::int64_t chunks = (end - begin - 1) / grain + 1;
  std::mutex mutex;
  std::int64_t failed_chunk = std::numeric_limits<std::int64_t>::max();
  quell_status status = QUELL_OK;
  self(host).services_.executor->run(chunks, [&](std::int64_t chunk, std::uint32_t slot) {
    const std::int64_t from = begin + chunk * grain;
    quell_status result = QUELL_FAILED;
    try {
      result = fn(context, chunk, from, std::min(from + grain, end), slot);
    } catch (...) {  // a plugin that breaks the rule must not take the workers down
      host->set_error(host, "an exception left a chunk of a parallel loop");
    }
    if (result == QUELL_OK) return;
    const std::scoped_lock lock(mutex);
    if (chunk < failed_chunk) failed_chunk = chunk, status = result;
  });
  return status;
}

}  // namespace quell
