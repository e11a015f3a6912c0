// When each value is needed, what may be written in place, and how much memory that makes. Private to this box.
#pragma once

#include <cstddef>
#include <vector>

#include "quell/graph/plan.h"
#include "quell/graph/plan_presence.h"

namespace quell::planning {

/// Fills Plan::histories, by endpoint.
void plan_histories(Plan& plan, const Presence& presence);

/// Fills in_place_of (what remains of what the passes allow), last_uses, and the sums of bytes. Needs shapes and histories.
void plan_buffers(Plan& plan, const Presence& presence);

/// Memory of one item; cameras need none to speak of.
std::size_t bytes_of(const Shape& shape);
/// Memory of all frames that are kept.
std::size_t bytes_of(const PlannedHistory& history);

}  // namespace quell::planning
