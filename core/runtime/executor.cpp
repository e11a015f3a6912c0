#include "quell/runtime/executor.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace quell {
namespace {

// The innermost body that this thread is in, so that nested loops run inline. Slots of one executor mean nothing to another.
struct Place {
  const Executor* executor = nullptr;
  std::uint32_t slot = 0;
};
thread_local Place place;

void run_chunk(const Executor& executor, const Executor::Chunk& body, std::int64_t chunk, std::uint32_t slot) {
  const Place outer = std::exchange(place, {&executor, slot});
  body(chunk, slot);
  place = outer;
}

bool run_inline_if_nested(const Executor& executor, std::int64_t chunks, const Executor::Chunk& body) {
  if (place.executor != &executor) return false;
  for (std::int64_t chunk = 0; chunk < chunks; ++chunk) body(chunk, place.slot);
  return true;
}

class TbbExecutor final : public Executor {
 public:
  explicit TbbExecutor(int threads) : arena_(threads) {
    if (threads > available_threads())
      limit_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }

  void run(std::int64_t chunks, const Chunk& body) override {
    if (run_inline_if_nested(*this, chunks, body)) return;
    arena_.execute([&] {
      // Without isolation a thread that waits here could start an unrelated body within this one.
      tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::int64_t>(0, chunks, 1),
            [&](const tbb::blocked_range<std::int64_t>& range) {
              const auto slot = static_cast<std::uint32_t>(tbb::this_task_arena::current_thread_index());
              for (std::int64_t chunk = range.begin(); chunk < range.end(); ++chunk) run_chunk(*this, body, chunk, slot);
            },
            tbb::simple_partitioner());
      });
    });
  }
  std::uint32_t slots() const override { return static_cast<std::uint32_t>(arena_.max_concurrency()); }

 private:
  // Only where more threads are wanted than the machine has: a limit holds for the whole process, other executors included.
  std::optional<tbb::global_control> limit_;
  tbb::task_arena arena_;
};

// Stripes of chunks on the caller's thread and others of their own: slow to start, but plain enough for a race detector.
class ThreadExecutor final : public Executor {
 public:
  explicit ThreadExecutor(int threads) : threads_(static_cast<std::uint32_t>(threads)) {}

  void run(std::int64_t chunks, const Chunk& body) override {
    if (run_inline_if_nested(*this, chunks, body)) return;
    const std::scoped_lock lock(one_loop_at_a_time_);
    const auto stripe = [&](std::uint32_t slot) {
      for (std::int64_t chunk = slot; chunk < chunks; chunk += threads_) run_chunk(*this, body, chunk, slot);
    };
    std::vector<std::jthread> others;
    for (std::uint32_t slot = 1; slot < threads_; ++slot) others.emplace_back(stripe, slot);
    stripe(0);
  }
  std::uint32_t slots() const override { return threads_; }

 private:
  std::uint32_t threads_;
  std::mutex one_loop_at_a_time_;
};

}  // namespace

int available_threads() { return tbb::info::default_concurrency(); }

std::unique_ptr<Executor> make_executor(int threads, ThreadSource source) {
  if (threads <= 0) threads = available_threads();
  // oneTBB lets a second thread into an arena of one when several callers wait for it, and there is no slot for that one.
  if (source == ThreadSource::threads || threads == 1) return std::make_unique<ThreadExecutor>(threads);
  return std::make_unique<TbbExecutor>(threads);
}

}  // namespace quell
