// A plan as a drawing.
#pragma once

#include <string>

#include "quell/graph/plan.h"

namespace quell {

/// The plan's graph in the language of Graphviz' `dot`, left to right: nodes with their ports, edges in the color of their type,
/// with a legend below. Edges with a delay are dashed and say it; ports that need no source are hollow; subgraphs are frames
/// around their nodes; what does not run is gray. The same plan always gives the same text.
std::string to_dot(const Plan& plan);

}  // namespace quell
