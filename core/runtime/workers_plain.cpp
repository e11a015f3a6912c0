#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "quell/runtime/workers.h"

namespace quell {
namespace {

class PlainWorkers final : public Workers {
 public:
  explicit PlainWorkers(int threads) : wanted_(static_cast<std::size_t>(threads)) {}
  ~PlainWorkers() override {
    {
      const std::scoped_lock lock(mutex_);
      stop_ = true;
    }
    work_.notify_all();
  }

  void spawn(FunctionRef<void()> task) override {
    {
      const std::scoped_lock lock(mutex_);
      tasks_.push_back(task);
      start_threads();
    }
    work_.notify_one();
  }

  void fork(std::uint32_t helpers, FunctionRef<void(std::uint32_t)> share) override {
    Fork fork{share, helpers};
    {
      const std::scoped_lock lock(mutex_);
      forks_.push_back(&fork);
      start_threads();
    }
    work_.notify_all();
    share(0);
    std::unique_lock lock(mutex_);
    std::erase(forks_, &fork);
    left_.wait(lock, [&] { return fork.inside == 0; });
  }

 private:
  struct Fork {
    FunctionRef<void(std::uint32_t)> share;
    std::uint32_t helpers;
    std::uint32_t begun = 0;
    std::uint32_t inside = 0;
  };

  void start_threads() {
    while (threads_.size() < wanted_) threads_.emplace_back([this] { work(); });
  }

  Fork* open_fork() {
    const auto open = std::ranges::find_if(forks_, [](const Fork* fork) { return fork->begun < fork->helpers; });
    return open == forks_.end() ? nullptr : *open;
  }

  void work() {
    std::unique_lock lock(mutex_);
    while (true) {
      work_.wait(lock, [&] { return stop_ || open_fork() || !tasks_.empty(); });
      if (Fork* fork = open_fork()) {  // before other tasks: somebody is in the middle of it
        const std::uint32_t share = ++fork->begun;
        ++fork->inside;
        lock.unlock();
        fork->share(share);
        lock.lock();
        if (--fork->inside == 0) left_.notify_all();
      } else if (!tasks_.empty()) {
        const FunctionRef<void()> task = tasks_.front();
        tasks_.pop_front();
        lock.unlock();
        task();
        lock.lock();
      } else {
        return;
      }
    }
  }

  std::size_t wanted_;
  std::mutex mutex_;
  std::condition_variable work_, left_;
  std::deque<FunctionRef<void()>> tasks_;
  std::vector<Fork*> forks_;
  bool stop_ = false;
  std::vector<std::jthread> threads_;  // last, so that they end before what they use
};

}  // namespace

std::unique_ptr<Workers> make_plain_workers(int threads) { return std::make_unique<PlainWorkers>(threads); }

}  // namespace quell
