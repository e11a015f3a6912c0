// A part of a graph by itself: what is known already comes in as inputs. Private to this box.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "quell/graph/plan.h"

namespace quell {

struct GraphPart {
  std::shared_ptr<const Graph> graph;  ///< the inputs of the whole graph, and one more for each endpoint that is fed
  std::vector<Endpoint> fed;           ///< endpoints of the whole graph; the inputs have their names: "filter.color"
  std::vector<int> nodes;              ///< of each node of the part: its index in the whole
};

/// The nodes that the results need, where `is_known` says which values of nodes need not be computed. Results keep their names.
GraphPart take_part(const Graph& whole, const std::vector<PlannedResult>& results,
                    const std::function<bool(const Endpoint&)>& is_known);

}  // namespace quell
