// Who may keep a processor busy: the threads that compute, decode and encode share one number.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <utility>

namespace quell {

/// A counter of threads that work at a time. Thread-safe.
class ThreadBudget {
 public:
  explicit ThreadBudget(int threads) : free_(threads) {}

  /// Takes one for computing when one is free that nobody waits for in take(). With `or_tell`, a failure is remembered, and
  /// on_free is called when one comes back.
  bool try_take(bool or_tell = false) {
    const std::scoped_lock lock(mutex_);
    if (free_ > 0 && waiting_ == 0) return --free_, true;
    starving_ = starving_ || or_tell;
    return false;
  }
  /// Waits for one. Goes before try_take: what is read and written is bounded by the frames in flight, and they wait for it.
  void take() {
    bool tell = false;
    {
      std::unique_lock lock(mutex_);
      ++waiting_;
      came_back_.wait(lock, [&] { return free_ > 0; });
      --waiting_, --free_;
      if (waiting_ == 0 && free_ > 0) tell = std::exchange(starving_, false);  // for those who were refused meanwhile
    }
    if (tell && on_free_) on_free_();
  }
  void give_back() {
    bool tell = false;
    {
      const std::scoped_lock lock(mutex_);
      ++free_;
      if (waiting_ == 0) tell = std::exchange(starving_, false);
    }
    came_back_.notify_one();
    if (tell && on_free_) on_free_();
  }
  /// Somebody waits in take(): who can stop here gives back.
  bool is_wanted() const { return waiting_.load(std::memory_order_relaxed) > 0; }
  /// Only while nobody else uses the budget.
  void on_free(std::function<void()> tell) { on_free_ = std::move(tell); }

 private:
  std::mutex mutex_;
  std::condition_variable came_back_;
  int free_;
  std::atomic<int> waiting_{0};  // changed under the mutex
  bool starving_ = false;
  std::function<void()> on_free_;
};

}  // namespace quell
