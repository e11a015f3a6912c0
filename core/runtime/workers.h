// Where threads come from: the one thing that differs between oneTBB and the plain threads that a race detector can follow.
#pragma once

#include <cstdint>
#include <memory>

#include "quell/runtime/function_ref.h"

namespace quell {

/// A number of threads. Thread-safe.
class Workers {
 public:
  virtual ~Workers() = default;
  /// Runs the task once, on a worker, some time. It must live until then.
  virtual void spawn(FunctionRef<void()> task) = 0;
  /// Runs share(0) on the calling thread and share(1), ... share(helpers) on workers that have time, and returns when all that
  /// began have ended. Shares that nobody began when share(0) was done may be left out. A share must not throw.
  virtual void fork(std::uint32_t helpers, FunctionRef<void(std::uint32_t share)> share) = 0;
};

std::unique_ptr<Workers> make_tbb_workers(int threads);
/// Starts its threads when they are first needed.
std::unique_ptr<Workers> make_plain_workers(int threads);

}  // namespace quell
