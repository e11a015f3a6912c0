// How long the loops of a plan make frames wait for each other.
#pragma once

#include <cstdint>
#include <vector>

#include "quell/graph/plan.h"

namespace quell {

/// A way around a loop. A turn takes the time of its nodes and leads on by `delay` frames.
struct Cycle {
  std::vector<int> nodes;  ///< indices into Graph::nodes; each is read by the next, the last by the first
  double seconds = 0;      ///< of its nodes, one after the other
  std::int64_t delay = 0;  ///< frames around, at least 1

  double seconds_per_frame() const { return seconds / static_cast<double>(delay); }
};

/// For each of Plan::loops the cycle with the most seconds per frame: no schedule yields frames faster. `node_seconds` are those
/// of one frame, in the order of Plan::nodes. Cycles are compared in whole nanoseconds, and nodes of more than 13 days count as
/// that.
std::vector<Cycle> find_slowest_cycles(const Plan& plan, const std::vector<double>& node_seconds);

}  // namespace quell
