// Which nodes run together, row by row, and in what order all of them run. Private to this box.
#pragma once

#include "quell/graph/plan.h"
#include "quell/graph/plan_presence.h"

namespace quell::planning {

/// Fills Plan::turns and Plan::inner. Needs shapes and histories. Fused are nodes that work row by row on images of one height,
/// and read each other's results no farther off than a few rows, unless a node between them forbids it, or
/// they would have to run far ahead of each other.
void plan_turns(Plan& plan, const Presence& presence, bool fuse);

}  // namespace quell::planning
