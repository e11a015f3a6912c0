#include "quell/runtime/executor.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <mutex>
#include <thread>
#include <vector>

namespace quell {
namespace {

constexpr std::uint32_t kNoSlot = ~std::uint32_t{0};

// The slot of the body that this thread is in, so that nested loops run inline.
thread_local std::uint32_t current_slot = kNoSlot;

void run_chunk(const Executor::Chunk& body, std::int64_t chunk, std::uint32_t slot) {
  current_slot = slot;
  body(chunk, slot);
  current_slot = kNoSlot;
}

bool run_inline_if_nested(std::int64_t chunks, const Executor::Chunk& body) {
  if (current_slot == kNoSlot) return false;
  for (std::int64_t chunk = 0; chunk < chunks; ++chunk) body(chunk, current_slot);
  return true;
}

class TbbExecutor final : public Executor {
 public:
  explicit TbbExecutor(int threads)
      : limit_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)), arena_(threads) {}

  void run(std::int64_t chunks, const Chunk& body) override {
    if (run_inline_if_nested(chunks, body)) return;
    arena_.execute([&] {
      // Without isolation a thread that waits here could start an unrelated body within this one.
      tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::int64_t>(0, chunks, 1),
            [&](const tbb::blocked_range<std::int64_t>& range) {
              const auto slot = static_cast<std::uint32_t>(tbb::this_task_arena::current_thread_index());
              for (std::int64_t chunk = range.begin(); chunk < range.end(); ++chunk) run_chunk(body, chunk, slot);
            },
            tbb::simple_partitioner());
      });
    });
  }
  std::uint32_t slots() const override { return static_cast<std::uint32_t>(arena_.max_concurrency()); }

 private:
  tbb::global_control limit_;  // lets a test ask for more threads than the machine has
  tbb::task_arena arena_;
};

// Stripes of chunks on threads of their own: slow to start, but plain enough for a race detector.
class ThreadExecutor final : public Executor {
 public:
  explicit ThreadExecutor(int threads) : threads_(static_cast<std::uint32_t>(threads)) {}

  void run(std::int64_t chunks, const Chunk& body) override {
    if (run_inline_if_nested(chunks, body)) return;
    const std::scoped_lock lock(one_loop_at_a_time_);
    const auto stripe = [&](std::uint32_t slot) {
      for (std::int64_t chunk = slot; chunk < chunks; chunk += threads_) run_chunk(body, chunk, slot);
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
  if (source == ThreadSource::threads) return std::make_unique<ThreadExecutor>(threads);
  return std::make_unique<TbbExecutor>(threads);
}

}  // namespace quell
