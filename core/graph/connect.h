// Sources looked up, through subgraphs, until every edge comes from a node that runs a pass or from an input of the whole graph.
// Private to this box.
#pragma once

#include "quell/graph/scope.h"

namespace quell::detail {

/// An edge into an input of a subgraph, whose type is checked when all types are known.
struct Crossing {
  Arrival arrival;
  const GraphInput* input = nullptr;
  const Scope* scope = nullptr;  ///< where the edge stands
  std::string label;             ///< of the input, in messages
};

struct Connections {
  std::vector<Crossing> crossings;
  std::vector<Arrival> outputs;               ///< of the whole graph, as in its document
  std::vector<GraphOutput> subgraph_outputs;  ///< "svgf.color"
  std::map<const Scope*, Arrival> resets;     ///< of the scopes that have one
};

/// Fills in Leaf::inputs of every leaf.
Connections connect(Unfolded& graph, Diagnostics& errors);

}  // namespace quell::detail
