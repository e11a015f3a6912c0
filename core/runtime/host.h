// The host table that a pass is given: parallel loops, messages, cancellation.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

#include "quell/runtime/executor.h"
#include "quell/runtime/trace.h"
#include "quell/sdk/abi.h"

namespace quell {

/// What the passes of a session may call upon, from any thread.
struct HostServices {
  Executor* executor = nullptr;
  std::function<void(int level, const std::string& message)> log;  ///< may be empty
  std::function<bool()> cancelled;                                 ///< may be empty
  std::int64_t force_grain = 0;  ///< not 0: overrides what passes ask for, to show that results do not depend on it
  Trace* trace = nullptr;        ///< told which threads help in a loop; may be null
};

/// The table for one caller of passes.
class Host {
 public:
  /// `name` stands in the trace.
  explicit Host(const HostServices& services, std::string name = {});
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  const quell_host& raw() const { return raw_; }
  /// Before each call of a pass: forgets what the one before it said and was told.
  void begin(std::int64_t frame);
  /// set_error's latest message.
  std::string take_error();
  /// Whether the pass was told so, or a loop of its was cut short by it: what it has computed then is no result.
  bool was_cancelled() const { return cancelled_.load(std::memory_order_relaxed); }
  /// Whether the run is cancelled; from then on, was_cancelled().
  bool ask_cancelled();
  /// Executor::run, told to the trace.
  void run_chunks(std::int64_t chunks, Executor::Chunk body);

 private:
  static Host& self(const quell_host* host) { return *static_cast<Host*>(host->context); }
  static quell_status parallel_for(const quell_host* host, std::int64_t begin, std::int64_t end, std::int64_t grain,
                                   quell_chunk_fn fn, void* context);

  const HostServices& services_;
  std::string name_;
  std::int64_t frame_ = 0;
  std::atomic<bool> cancelled_{false};
  std::mutex mutex_;
  std::string error_;
  quell_host raw_;
};

}  // namespace quell
