// Optional inputs of subgraphs that are not connected: what only serves them is left out. Private to this box.
#pragma once

#include <vector>

#include "quell/graph/connect.h"
#include "quell/graph/scope.h"

namespace quell::detail {

/// Which leaves cannot run, because a required input comes from nothing. A required list lacks its input when one
/// element does.
/// An output of the whole graph that would need one of them is an error. Edges that come from nothing are removed, but in a list,
/// where they come from Endpoint::nothing.
std::vector<bool> leave_out_absent(Unfolded& graph, const Connections& connections, Diagnostics& errors);

}  // namespace quell::detail
