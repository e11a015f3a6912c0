// The one seam through which everything runs in parallel: oneTBB, or plain threads where a race detector must see them
// (Debian's TBB is not instrumented, and suppressing its reports hides real races too).
#pragma once

#include <cstdint>
#include <memory>

#include "quell/runtime/function_ref.h"
#include "quell/runtime/thread_budget.h"

namespace quell {

enum class ThreadSource { tbb, threads };
#ifdef __SANITIZE_THREAD__
inline constexpr ThreadSource kDefaultThreadSource = ThreadSource::threads;
#else
inline constexpr ThreadSource kDefaultThreadSource = ThreadSource::tbb;
#endif

/// The number of processors that this process may use.
int available_threads();

class Workers;

/// Runs parallel loops and tasks on a number of threads. Thread-safe; loops from several threads share the same workers.
class Executor {
 public:
  using Chunk = FunctionRef<void(std::int64_t chunk, std::uint32_t slot)>;

  /// `threads` 0: available_threads().
  explicit Executor(int threads = 0, ThreadSource source = kDefaultThreadSource);
  ~Executor();

  /// Calls body(chunk, slot) once for every chunk in [0, chunks), and returns when all are done. The caller takes part, helped by
  /// workers for which the budget has room. A call from within a body of this executor runs inline, with the caller's slot.
  /// `body` must not throw.
  void run(std::int64_t chunks, Chunk body);
  /// Runs the task once, on a worker, some time; it must live until then. It may run loops. The budget is the caller's affair.
  void spawn(FunctionRef<void()> task);
  /// Slots are below this number; no two bodies of one loop have the same one at a time.
  std::uint32_t slots() const { return slots_; }
  /// The threads that may work at a time; every helper of a loop counts.
  ThreadBudget& budget() { return budget_; }

 private:
  std::uint32_t slots_;
  ThreadBudget budget_;
  std::unique_ptr<Workers> workers_;
};

inline std::unique_ptr<Executor> make_executor(int threads = 0, ThreadSource source = kDefaultThreadSource) {
  return std::make_unique<Executor>(threads, source);
}

}  // namespace quell
