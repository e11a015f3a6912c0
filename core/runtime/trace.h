// Records who did what when, as a Chrome trace: a lane for each thread, a slice for each node and frame, the pool's memory as a
// counter. chrome://tracing and ui.perfetto.dev show it.
#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string_view>

#include "quell/image/buffer_pool.h"

namespace quell {

class Trace {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Kind {
    node,  ///< a node on a frame
    help,  ///< another thread's part in a parallel loop of a node
    read,
    write,
  };

  /// Events are written to `out` as they come, which must outlive the trace.
  explicit Trace(std::ostream& out);
  ~Trace();
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;

  /// Something that the calling thread did from `start` until `end`: a node, an input that it read, an output that it wrote.
  /// Thread-safe.
  void slice(Kind kind, std::string_view name, std::int64_t frame, Clock::time_point start, Clock::time_point end);
  /// What the pool holds now. Thread-safe.
  void memory(const BufferPool::Usage& usage);
  /// Ends the text; nothing may be recorded after it.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace quell
