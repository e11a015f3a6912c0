// Which nodes depend on their own earlier results. Private to this box.
#pragma once

#include <vector>

#include "quell/graph/plan.h"
#include "quell/graph/plan_presence.h"

namespace quell::planning {

/// The loops among the nodes that run, by their first nodes. Cycles that share a node make one loop.
std::vector<PlannedLoop> find_loops(const Plan& plan, const Presence& presence);

}  // namespace quell::planning
