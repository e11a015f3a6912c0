// Counts how many frames are between their first read and their last write.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>

namespace quell::test {

/// Thread-safe.
class FrameGauge {
 public:
  explicit FrameGauge(int writes_per_frame) : writes_per_frame_(writes_per_frame) {}
  void read_begins(std::int64_t frame) {
    const std::scoped_lock lock(mutex_);
    open_.insert(frame);
    most_ = std::max(most_, static_cast<int>(open_.size()));
  }
  void write_ends(std::int64_t frame) {
    const std::scoped_lock lock(mutex_);
    if (++writes_[frame] == writes_per_frame_) open_.erase(frame);
  }
  int most() const { return most_; }
  bool all_are_closed() const { return open_.empty(); }

 private:
  const int writes_per_frame_;
  std::mutex mutex_;
  std::set<std::int64_t> open_;
  std::map<std::int64_t, int> writes_;
  int most_ = 0;
};

}  // namespace quell::test
