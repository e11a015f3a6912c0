#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <optional>

#include "quell/runtime/workers.h"

namespace quell {
namespace {

class TbbWorkers final : public Workers {
 public:
  // No place is reserved for callers: spawned tasks need every worker, while the one who waits for them only sleeps.
  explicit TbbWorkers(int threads) : arena_(threads, 0) {
    // oneTBB has one worker less than processors, and counts the main thread. A limit holds for the whole process, other arenas
    // included, so it is set only to allow more.
    if (threads >= tbb::info::default_concurrency())
      limit_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads) + 1);
  }

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
  std::optional<tbb::global_control> limit_;
  tbb::task_arena arena_;
};

}  // namespace

std::unique_ptr<Workers> make_tbb_workers(int threads) { return std::make_unique<TbbWorkers>(threads); }

}  // namespace quell
