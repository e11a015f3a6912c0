// The one seam through which everything runs in parallel: oneTBB, or plain threads where a race detector must see them
// (Debian's TBB is not instrumented).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "quell/sdk/abi.h"

namespace quell {

/// Runs parallel loops. Thread-safe; loops from several threads share the same workers.
class Executor {
 public:
  virtual ~Executor() = default;
  using Chunk = std::function<void(std::int64_t chunk, std::uint32_t slot)>;
  /// Calls body(chunk, slot) once for every chunk in [0, chunks), and returns when all are done. A call from within a body runs
  /// inline, with the caller's slot. `body` must not throw.
  virtual void run(std::int64_t chunks, const Chunk& body) = 0;
  /// Slots are below this number; no two bodies at a time have the same one.
  virtual std::uint32_t slots() const = 0;
};

/// `threads` 0: as many as this process may use.
std::unique_ptr<Executor> make_executor(int threads = 0);

}  // namespace quell
