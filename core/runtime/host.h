// The host table that a pass is given: parallel loops, messages, cancellation.
#pragma once

#include <functional>
#include <mutex>
#include <string>

#include "quell/runtime/executor.h"
#include "quell/sdk/abi.h"

namespace quell {

/// What the passes of a session may call upon, from any thread.
struct HostServices {
  Executor* executor = nullptr;
  std::function<void(int level, const std::string& message)> log;  ///< may be empty
  std::function<bool()> cancelled;                                 ///< may be empty
  std::int64_t force_grain = 0;  ///< not 0: overrides what passes ask for, to show that results do not depend on it
};

/// The table for one caller of passes. set_error's message is kept until it is taken.
class Host {
 public:
  explicit Host(const HostServices& services);
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  const quell_host& raw() const { return raw_; }
  std::string take_error();

 private:
  static Host& self(const quell_host* host) { return *static_cast<Host*>(host->context); }
  static quell_status parallel_for(const quell_host* host, std::int64_t begin, std::int64_t end, std::int64_t grain,
                                   quell_chunk_fn fn, void* context);
  const HostServices& services_;
  std::mutex mutex_;
  std::string error_;
  quell_host raw_;
};

}  // namespace quell
