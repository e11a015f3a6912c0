// One frame in computation: the values that its nodes have yielded and still need.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quell/runtime/node_runner.h"
#include "quell/runtime/plan_state.h"

namespace quell {

/// What a frame begins with.
struct FrameInputs {
  std::vector<Item> items;  ///< of each graph input; nothing where it is absent
  std::vector<Item> ahead;  ///< of Wiring::ahead; nothing where there is no such frame
};

/// Keeps its tables from frame to frame. The steps of a frame are fetched, run and published, each once, after those they need;
/// who does that in what order is the caller's affair. Only run() takes long, and needs no lock.
class Lane {
 public:
  enum class Outcome : std::uint8_t { pending, done, failed, lost };  ///< lost: a step that it needs failed, or was lost

  Lane(PlanState& state, const HostServices& services, BufferPool& pool, Trace* trace);

  /// Forgets the frame before.
  void begin(std::int64_t frame, FrameInputs inputs);
  std::int64_t frame() const { return frame_; }

  /// Whether a step that this one needs has failed: then it is skipped instead.
  bool is_lost(int step) const;
  void skip(int step);

  /// Takes the step's inputs out of the frame's values and the history.
  void fetch(int step);
  /// Computes. Throws Cancelled; every other exception is kept and makes the step a failed one.
  void run(int step);
  /// Makes its results known to the frame and the history.
  void publish(int step);

  /// The first failed step in the plan's order; -1 when none failed.
  int failed_step() const;
  const std::string& error() const { return errors_[static_cast<std::size_t>(failed_step())]; }
  const std::string& name(int step) const;
  const std::vector<double>& node_seconds() const { return seconds_; }
  /// Of Wiring::results, when all steps are through.
  const Item& result(std::size_t index) const { return values_[static_cast<std::size_t>(state_.wiring.results[index].second)]; }
  /// Lets go of what lies ahead, when all steps are through.
  void drop_ahead();
  /// Lets go of all values.
  void clear();

 private:
  Item take(int value);
  Item fetch_item(const Fetch& fetch, const std::vector<int>& resets);
  void note_reset(int value, const Item& item);
  void drop_inputs(int step);

  PlanState& state_;
  BufferPool& pool_;
  Trace* trace_;
  std::vector<NodeRunner> runners_;
  std::int64_t frame_ = 0;
  std::vector<Item> values_;  // by Wiring's index
  std::vector<int> readers_;  // that have not fetched the value yet
  std::vector<Item> ahead_;
  std::vector<PortItems> inputs_, outputs_;  // of each step
  std::vector<Outcome> outcomes_;
  std::vector<std::string> errors_;
  std::vector<double> seconds_;
};

}  // namespace quell
