// The one seam through which everything runs in parallel: oneTBB, or plain threads where a race detector must see them
// (Debian's TBB is not instrumented, and suppressing its reports hides real races too).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace quell {

/// Runs parallel loops. Thread-safe; loops from several threads share the same workers.
class Executor {
 public:
  using Chunk = std::function<void(std::int64_t chunk, std::uint32_t slot)>;

  virtual ~Executor() = default;
  /// Calls body(chunk, slot) once for every chunk in [0, chunks), and returns when all are done. A call from within a body of
  /// this executor runs inline, with the caller's slot. `body` must not throw.
  virtual void run(std::int64_t chunks, const Chunk& body) = 0;
  /// Slots are below this number; no two bodies at a time have the same one.
  virtual std::uint32_t slots() const = 0;
};

enum class ThreadSource { tbb, threads };
#ifdef __SANITIZE_THREAD__
inline constexpr ThreadSource kDefaultThreadSource = ThreadSource::threads;
#else
inline constexpr ThreadSource kDefaultThreadSource = ThreadSource::tbb;
#endif

/// The number of processors that this process may use.
int available_threads();

/// `threads` 0: available_threads().
std::unique_ptr<Executor> make_executor(int threads = 0, ThreadSource source = kDefaultThreadSource);

}  // namespace quell
