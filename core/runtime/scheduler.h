// Nodes of several frames at a time: whatever is ready runs, the earliest frame first. Frames are admitted in order, as many as
// the window and the memory limit allow; file threads read them ahead and write them behind. They begin and are reported in
// order; all else happens in any order, and the results do not depend on it, because a node sees nothing but what it reads.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "quell/runtime/flight.h"
#include "quell/runtime/input_reader.h"
#include "quell/runtime/session_state.h"

namespace quell {

/// Three kinds of threads share one lock, which nobody holds while a node runs or a source or sink is at work: drivers, tasks on
/// the executor's workers, compute; file threads read and write; the caller of run() waits, and tells of frames that have ended.
class Scheduler {
 public:
  /// For frames that ascend, when a first plan has been made.
  Scheduler(SessionState& session, const RunFrames& frames, FrameSource& source, FrameSink& sink);
  /// As Session::run. Once.
  std::vector<FrameReport> run();

 private:
  using Lock = std::unique_lock<std::mutex>;
  enum class Phase { reading, computing, computed, writing, ended };
  struct Frame {
    Phase phase = Phase::reading;
    FrameReport report;
    Trace::Clock::time_point start;
  };

  // The caller.
  void wait_until_finished(Lock& lock);
  void tell_reports(Lock& lock);
  void shut_down();
  void collect_rest();

  // Drivers.
  void drive();
  void compute_nodes(Lock& lock);
  void compute(const FrameStep& node, Lock& lock);
  void start_drivers(std::size_t nodes);

  // File threads.
  void serve_files();
  void serve_one(Lock& lock);
  void read_one(Lock& lock);
  void write_one(std::size_t index, Lock& lock);
  bool can_read();
  std::optional<std::size_t> next_write();

  // What an event makes possible. All of these want the lock.
  void advance();
  bool admit_next();
  bool begin_next();
  bool retire_next();
  bool plan_anew(const InputShapes& shapes);
  void end_computation(std::size_t index);
  void end_frame(std::size_t index);
  void fail(Lock& lock);
  bool is_finished() const;
  bool is_wanted(const FrameStep& node) {
    return !frame(node.index).report.history_only || session_.running->wiring.feeds_history[static_cast<std::size_t>(node.step)];
  }
  Frame& frame(std::size_t index) { return in_flight_[flight_.place(index)]; }
  Lane& lane(std::size_t index) { return session_.lane(flight_.place(index)); }

  SessionState& session_;
  const RunFrames run_;
  const std::vector<std::int64_t>& frames_;
  FrameSource& source_;
  FrameSink& sink_;
  const bool reading_counts_, writing_counts_;  // as threads at work
  Executor alone_{1, ThreadSource::threads};    // for file threads: loops inline
  const std::function<void()> drive_ = [this] { drive(); };

  std::mutex mutex_;  // guards what follows, the lanes' tables and the history
  std::condition_variable files_wake_, caller_wakes_;
  InputReader reader_;
  Flight flight_;
  std::vector<Frame> in_flight_;                // by place
  std::size_t end_;                             // frames from here on are not wanted: there are none, or one before them failed
  std::size_t idle_drivers_ = 0, drivers_ = 0;  // those that have not begun; all
  int busy_file_threads_ = 0;
  bool stopped_ = false;        // nothing new is begun
  std::exception_ptr failure_;  // of the scheduler itself; ends the run
  bool closing_ = false;        // file threads end
  std::vector<FrameReport> reports_;
  std::size_t told_ = 0;
  std::vector<std::jthread> file_threads_;  // last, so that they end before what they use
};

}  // namespace quell
