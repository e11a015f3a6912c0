// The maximum cycle ratio of a graph. Private to this box.
#pragma once

#include <cstdint>
#include <vector>

namespace quell::planning {

/// `to` reads what `from` made some frames ago. Nodes are counted from 0.
struct DelayedArc {
  int from = 0;
  int to = 0;
  int delay = 0;
};

/// The cycle with the largest (sum of its nodes' weights) / (sum of its delays), as indices into `arcs`, each leading to the
/// next; the first leaves the lowest node. Empty when there is no cycle. Exact. Weights are 0 to 2^50, delays at least 0, and
/// every cycle has one above 0. Quickest when arcs without delay are in the order of what they lead to.
std::vector<int> find_largest_ratio(const std::vector<std::int64_t>& weights, const std::vector<DelayedArc>& arcs);

}  // namespace quell::planning
