// Asks one pass what it would do with given inputs. Private to this box.
#pragma once

#include <vector>

#include "quell/graph/plan.h"

namespace quell::planning {

/// One shape for each item of each port.
using PortShapes = std::vector<std::vector<Shape>>;

/// Calls the pass's infer. `inputs` are the shapes of the node's edges, `outputs` what its outputs are unless it says otherwise.
/// `in_place_of` of the answer is what the pass allows. Throws Error(usage) in the pass's words when it refuses the inputs,
/// Error(plugin) when its answer cannot be.
PlannedNode ask_pass(const Graph& graph, int node, const PortShapes& inputs, const PortShapes& outputs);

}  // namespace quell::planning
