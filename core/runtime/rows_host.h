// The host as a pass sees it that is run on some rows: its loops leave out the others.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "quell/runtime/flush_to_zero.h"
#include "quell/sdk/abi.h"

namespace quell {

/// For one thread. A loop runs on it, in the chunks that it would have for all rows, and stops at the first that fails.
class RowsHost {
 public:
  RowsHost() : raw_{sizeof(raw_), QUELL_ABI_VERSION, this, parallel_for, log, cancelled, set_error} {}
  RowsHost(const RowsHost&) = delete;
  RowsHost& operator=(const RowsHost&) = delete;

  void begin(const quell_host& host, std::uint32_t slot) { host_ = &host, slot_ = slot; }
  void set_rows(int begin, int end, int height) {
    begin_ = begin, end_ = end, height_ = height;
    error_.clear();
    is_own_error_ = false;
  }
  const quell_host& raw() const { return raw_; }
  /// Whether a loop could not be run, so that rows are missing even where the pass does not mind.
  bool has_own_error() const { return is_own_error_; }
  std::string take_error() { return std::exchange(error_, {}); }

 private:
  static RowsHost& self(const quell_host* host) { return *static_cast<RowsHost*>(host->context); }
  static quell_status parallel_for(const quell_host* host, std::int64_t begin, std::int64_t end, std::int64_t grain,
                                   quell_chunk_fn fn, void* context) {
    RowsHost& own = self(host);
    if (begin != 0 || end != own.height_) {
      return own.fail("it said that it works row by row, but its loop does not go over the " + std::to_string(own.height_) +
                      " rows of its outputs");
    }
    grain = std::clamp<std::int64_t>(grain, 1, end);
    const FlushToZero flush;
    for (std::int64_t from = own.begin_, to = 0; from < own.end_; from = to) {
      to = std::min<std::int64_t>((from / grain + 1) * grain, own.end_);
      quell_status status = QUELL_FAILED;
      try {
        status = fn(context, from / grain, from, to, own.slot_);
      } catch (...) {  // a plugin that breaks the rule must not take the workers down
        own.fail("an exception left a chunk of a parallel loop");
      }
      if (status != QUELL_OK) return status;
    }
    return QUELL_OK;
  }
  static void log(const quell_host* host, int level, const char* message) {
    self(host).host_->log(self(host).host_, level, message);
  }
  static int cancelled(const quell_host* host) { return self(host).host_->cancelled(self(host).host_); }
  static void set_error(const quell_host* host, const char* message) {
    if (!self(host).is_own_error_) self(host).error_ = message ? message : "";
  }
  // The pass will only say that its loop could not be run.
  quell_status fail(std::string reason) {
    error_ = std::move(reason);
    is_own_error_ = true;
    return QUELL_FAILED;
  }

  const quell_host* host_ = nullptr;
  std::uint32_t slot_ = 0;
  int begin_ = 0, end_ = 0, height_ = 0;
  std::string error_;
  bool is_own_error_ = false;
  quell_host raw_;
};

}  // namespace quell
