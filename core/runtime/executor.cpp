#include "quell/runtime/executor.h"

#include <tbb/info.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "quell/runtime/workers.h"

namespace quell {
namespace {

// The innermost body that this thread is in, so that nested loops run inline. Slots of one executor mean nothing to another.
struct Place {
  const Executor* executor = nullptr;
  std::uint32_t slot = 0;
};
thread_local Place place;

std::uint32_t resolve(int threads) { return static_cast<std::uint32_t>(threads > 0 ? threads : available_threads()); }

}  // namespace

int available_threads() { return tbb::info::default_concurrency(); }

Executor::Executor(int threads, ThreadSource source)
    : slots_(resolve(threads)),
      budget_(static_cast<int>(slots_)),
      workers_(source == ThreadSource::tbb ? make_tbb_workers(static_cast<int>(slots_))
                                           : make_plain_workers(static_cast<int>(slots_))) {}
Executor::~Executor() = default;

void Executor::spawn(FunctionRef<void()> task) { workers_->spawn(task); }

void Executor::run(std::int64_t chunks, Chunk body) {
  if (chunks <= 0) return;
  if (place.executor == this) {
    for (std::int64_t chunk = 0; chunk < chunks; ++chunk) body(chunk, place.slot);
    return;
  }
  std::atomic<std::int64_t> next{0};
  const auto share = [&](std::uint32_t slot) {
    const bool helps = slot > 0;
    if (helps && (next.load(std::memory_order_relaxed) >= chunks || !budget_.try_take())) return;
    const Place outer = std::exchange(place, {this, slot});
    while (!(helps && budget_.is_wanted())) {
      // Relaxed: chunks owe each other nothing, and a race detector would take more for an order between them.
      const std::int64_t chunk = next.fetch_add(1, std::memory_order_relaxed);
      if (chunk >= chunks) break;
      body(chunk, slot);
    }
    place = outer;
    if (helps) budget_.give_back();
  };
  const auto helpers = static_cast<std::uint32_t>(std::min<std::int64_t>(chunks, slots_) - 1);
  if (helpers == 0)
    share(0);
  else
    workers_->fork(helpers, share);
}

}  // namespace quell
