#include "quell/runtime/host.h"

#include <algorithm>
#include <limits>
#include <thread>
#include <utility>

#include "quell/runtime/flush_to_zero.h"

namespace quell {

Host::Host(const HostServices& services, std::string name) : services_(services), name_(std::move(name)), raw_{} {
  raw_.struct_size = sizeof(raw_);
  raw_.abi = QUELL_ABI_VERSION;
  raw_.context = this;
  raw_.parallel_for = parallel_for;
  raw_.log = [](const quell_host* host, int level, const char* message) {
    if (self(host).services_.log) self(host).services_.log(level, message ? message : "");
  };
  raw_.cancelled = [](const quell_host* host) -> int { return self(host).ask_cancelled() ? 1 : 0; };
  raw_.set_error = [](const quell_host* host, const char* message) {
    const std::scoped_lock lock(self(host).mutex_);
    self(host).error_ = message ? message : "";
  };
}

void Host::begin(std::int64_t frame) {
  frame_ = frame;
  cancelled_.store(false, std::memory_order_relaxed);
  take_error();
}

// Once is enough: who was told yes is never told no within the same call.
bool Host::ask_cancelled() {
  if (was_cancelled()) return true;
  if (!services_.cancelled || !services_.cancelled()) return false;
  cancelled_.store(true, std::memory_order_relaxed);
  return true;
}

std::string Host::take_error() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(error_, {});
}

quell_status Host::parallel_for(const quell_host* host, std::int64_t begin, std::int64_t end, std::int64_t grain,
                                quell_chunk_fn fn, void* context) {
  if (end <= begin) return QUELL_OK;
  Host& own = self(host);
  if (own.services_.force_grain > 0) grain = own.services_.force_grain;
  grain = std::clamp<std::int64_t>(grain, 1, end - begin);  // so that no sum below goes far past the end
  std::mutex mutex;
  std::int64_t failed_chunk = std::numeric_limits<std::int64_t>::max();
  quell_status status = QUELL_OK;
  own.run_chunks((end - begin - 1) / grain + 1, [&](std::int64_t chunk, std::uint32_t slot) {
    const std::int64_t from = begin + chunk * grain;
    quell_status result = QUELL_FAILED;
    try {
      if (own.ask_cancelled()) return;
      const FlushToZero flush;
      result = fn(context, chunk, from, std::min(from + grain, end), slot);
    } catch (...) {  // a plugin that breaks the rule must not take the workers down
      host->set_error(host, "an exception left a chunk of a parallel loop");
    }
    if (result == QUELL_OK) return;
    const std::scoped_lock lock(mutex);
    if (chunk < failed_chunk) failed_chunk = chunk, status = result;
  });
  return own.was_cancelled() ? QUELL_CANCELLED : status;
}

// With a trace, each call of the body takes chunks until there are none, so that a helper has one slice for all of them. It stops
// where its thread is wanted elsewhere, as it would between bodies: there is a call for each chunk, so none is left over.
void Host::run_chunks(std::int64_t chunks, Executor::Chunk body) {
  Executor& executor = *services_.executor;
  if (!services_.trace) return executor.run(chunks, body);
  std::atomic<std::int64_t> next{0};
  const std::thread::id caller = std::this_thread::get_id();
  executor.run(chunks, [&](std::int64_t, std::uint32_t slot) {
    std::int64_t chunk = next.fetch_add(1, std::memory_order_relaxed);
    if (chunk >= chunks) return;
    const bool helps = std::this_thread::get_id() != caller;
    const auto start = Trace::Clock::now();
    do {
      body(chunk, slot);
      if (helps && executor.budget().is_wanted()) break;
      chunk = next.fetch_add(1, std::memory_order_relaxed);
    } while (chunk < chunks);
    if (helps) services_.trace->slice(Trace::Kind::help, name_, frame_, start, Trace::Clock::now());
  });
}

}  // namespace quell
