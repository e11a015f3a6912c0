// The last step: from leaves to the nodes of a Graph. Private to this box.
#pragma once

#include <memory>

#include "quell/graph/connect.h"
#include "quell/graph/scope.h"

namespace quell::detail {

/// Orders the leaves that are not left out, creates their passes, and turns every edge into one between nodes. Cycles, and
/// parameters that a pass refuses, are told.
std::shared_ptr<Graph> build(const Unfolded& graph, const Connections& connections, const std::vector<bool>& left_out,
                             Diagnostics& errors);

}  // namespace quell::detail
