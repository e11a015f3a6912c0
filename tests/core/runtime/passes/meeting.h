// A place where two threads meet without telling the race detector: what they do next overlaps, and nothing orders it.
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

namespace quell {

class Meeting {
 public:
  /// Waits until somebody else came, too; not for long, as there may be nobody.
  void wait() {
    came_.fetch_add(1, std::memory_order_relaxed);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (came_.load(std::memory_order_relaxed) < 2 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  }

 private:
  std::atomic<int> came_ = 0;
};

}  // namespace quell
