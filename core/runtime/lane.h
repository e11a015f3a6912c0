// One frame in computation: the values that its nodes have yielded and still need.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "quell/runtime/fused_runner.h"
#include "quell/runtime/node_runner.h"
#include "quell/runtime/plan_state.h"

namespace quell {

/// What a frame begins with.
struct FrameInputs {
  std::vector<Item> items;  ///< of each graph input; nothing where it is absent
  std::vector<Item> ahead;  ///< of Wiring::ahead; nothing where there is no such frame
};

/// Keeps its tables from frame to frame. The steps of a frame, positions in Plan::turns, are fetched, run and published, each
/// once, after those they need; who does that in what order is the caller's affair. Only run() takes long, and needs no lock.
class Lane {
 public:
  Lane(PlanState& state, const HostServices& services, BufferPool& pool, Trace* trace);

  /// Forgets the frame before.
  void begin(std::int64_t frame, FrameInputs inputs);
  std::int64_t frame() const { return frame_; }

  /// Whether each node of the step needs one that has failed: then it is skipped instead.
  bool is_lost(int step);
  void skip(int step);

  /// Takes the step's inputs out of the frame's values and the history.
  void fetch(int step);
  /// Computes. Throws Cancelled; every other exception is kept and makes its nodes failed ones.
  void run(int step);
  /// Makes its results known to the frame and the history.
  void publish(int step);

  /// The first failed node in the plan's order, a position in Plan::nodes; -1 when none failed.
  int failed_node() const;
  const std::string& error() const { return tables_.errors[static_cast<std::size_t>(failed_node())]; }
  const std::string& name(int node) const;
  const std::vector<double>& node_seconds() const { return tables_.seconds; }  ///< by position in Plan::nodes
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
  void take_all(int node);
  void compute(int step);
  void fail(int step, const std::string& error);
  void drop_inputs(int node);
  void drop_outputs(int node);
  Outcome& outcome(int node) { return tables_.outcomes[static_cast<std::size_t>(node)]; }
  const std::vector<int>& nodes_of(int step) const { return state_.plan.turns[static_cast<std::size_t>(step)].nodes; }

  PlanState& state_;
  BufferPool& pool_;
  Trace* trace_;
  std::vector<std::variant<NodeRunner, FusedRunner>> runners_;
  std::vector<std::string> labels_;  // of each step: names of its nodes
  std::int64_t frame_ = 0;
  std::vector<Item> values_;  // by Wiring's index
  std::vector<int> readers_;  // that have not fetched the value yet
  std::vector<Item> ahead_;
  FusedRunner::Tables tables_;
};

}  // namespace quell
