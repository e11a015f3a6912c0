#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <mutex>

#include "quell/runtime/workers.h"

namespace quell {
namespace {

// oneTBB counts the main thread, and has one worker less than there are processors. What allows more holds for the whole process,
// and of several such controls the smallest: so there is one, which only grows, and is never taken back.
void allow_workers(std::size_t workers) {
  static std::mutex mutex;
  static tbb::global_control* control = nullptr;
  static auto allowed = static_cast<std::size_t>(tbb::info::default_concurrency());
  const std::scoped_lock lock(mutex);
  if (workers + 1 <= allowed) return;
  allowed = workers + 1;
  delete control;
  control = new tbb::global_control(tbb::global_control::max_allowed_parallelism, allowed);
}

class TbbWorkers final : public Workers {
 public:
  // No place is reserved for callers: spawned tasks need every worker, while the one who waits for them only sleeps.
  explicit TbbWorkers(int threads) : arena_(threads, 0) { allow_workers(static_cast<std::size_t>(threads)); }

  void spawn(FunctionRef<void()> task) override { arena_.enqueue(task); }

  void fork(std::uint32_t helpers, FunctionRef<void(std::uint32_t)> share) override {
    arena_.execute([&] {
      // Isolated, so that a thread that waits here begins no unrelated node within this one; a context of its own, so that no
      // other loop's cancellation reaches this one.
      tbb::this_task_arena::isolate([&] {
        tbb::task_group_context context(tbb::task_group_context::isolated);
        tbb::task_group group(context);
        for (std::uint32_t i = 1; i <= helpers; ++i) group.run([share, i] { share(i); });
        share(0);
        group.wait();
      });
    });
  }

 private:
  tbb::task_arena arena_;
};

}  // namespace

std::unique_ptr<Workers> make_tbb_workers(int threads) { return std::make_unique<TbbWorkers>(threads); }

}  // namespace quell
