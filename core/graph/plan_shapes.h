// The shapes of everything that is computed. Private to this box.
#pragma once

#include "quell/graph/plan.h"
#include "quell/graph/plan_presence.h"

namespace quell::planning {

/// Asks the pass of every node of the plan (whose `node`s are set) until all shapes are known, and completes the nodes.
/// A pass in a loop is asked again when the shape of what it reads from an earlier frame becomes known. Throws Error with
/// everything that does not fit, Error(plugin) when any of it is a pass's own fault.
void infer_shapes(Plan& plan, const Presence& presence);

}  // namespace quell::planning
