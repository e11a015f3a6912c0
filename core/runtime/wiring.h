// What a plan means for running it: every value by index, who reads it, who waits for whom, what lasts beyond a frame.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "quell/graph/plan.h"

namespace quell {

/// Where a node's input item comes from. Indices are -1 for what does not apply.
struct Fetch {
  int value = -1;     ///< of the same frame
  int line = -1;      ///< of the history
  int delay = 0;      ///< for `line`: frames back
  int ahead = -1;     ///< index into Wiring::ahead
  Shape planned;      ///< what the pass was asked about; an item of another shape counts as absent
  int initial = -1;   ///< value of the same frame that stands in for what is absent
  int constant = -1;  ///< index into Wiring::constants, for the same
};

struct WiredNode {
  std::vector<std::vector<Fetch>> fetches;  ///< for each item of each input port; nothing of what a fused node yields
  int first_output = 0;                     ///< value of the first item of the first output; the others follow
  std::vector<int> needs;                   ///< nodes of the same frame
  std::vector<int> resets;                  ///< indices into Wiring::resets: what its history ends with
};

/// A step waits for another's result of an earlier frame.
struct DelayedWait {
  int step = 0;
  int delay = 0;
};

struct WiredStep {
  std::vector<int> needs;                ///< steps of the same frame
  std::vector<int> feeds;                ///< the other way round
  std::vector<DelayedWait> waits;        ///< steps of earlier frames
  std::vector<DelayedWait> awaited_by;   ///< the other way round
  std::vector<DelayedWait> reset_waits;  ///< steps that reset it: of all frames less than `delay` back
  std::vector<DelayedWait> resets_for;   ///< the other way round
};

/// An input that is looked at before its turn.
struct AheadRead {
  int input = 0;
  int frames = 0;  ///< how far ahead
};

/// A value whose first number, where it is not 0, ends history.
struct WiredReset {
  int value = 0;
  int step = -1;  ///< that yields it; -1 for a graph input
};

struct InitialConstant {
  Shape shape;
  std::vector<double> values;  ///< one, or one for each plane
};

struct Wiring {
  /// By position in Plan::nodes. Values are the graph's inputs, then the outputs of the nodes, item by item.
  std::vector<WiredNode> nodes;
  std::vector<WiredStep> steps;         ///< a step is a position in Plan::turns
  std::vector<int> readers;             ///< of each value: how often it is fetched in its frame, and 1 if it is a result
  std::vector<std::vector<int>> lines;  ///< of each value: the lines of the history that keep it
  std::vector<std::pair<std::string, int>> results;  ///< name and value, as Plan::results()
  std::vector<AheadRead> ahead;
  std::vector<InitialConstant> constants;
  std::vector<WiredReset> resets;
  std::vector<bool> feeds_history;  ///< of each step: whether a history needs it, in this frame

  explicit Wiring(const Plan& plan);
};

}  // namespace quell
