// What of a graph is as it was before. Private to this box.
#pragma once

#include <vector>

#include "quell/graph/graph.h"

namespace quell {

/// Whether `a` and `b` run the same pass with the same parameters, bit for bit.
bool same_work(const Node& a, const Node& b);

/// Of each node of `now`: whether what it yields is what the node of that name in `before` yields, given the same inputs. Then it
/// runs the same pass with the same parameters on the same sources, with the same delays and initial values, and so does each
/// node that these depend on, in this frame or an earlier one. `touched` are nodes of `now` that count as changed in any case.
std::vector<bool> find_unchanged(const Graph& before, const Graph& now, const std::vector<bool>& touched);

}  // namespace quell
