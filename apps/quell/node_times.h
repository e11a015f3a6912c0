// Where the time of a run went.
#pragma once

#include <string>
#include <vector>

#include "quell/runtime/session.h"

namespace quell::app {

/// A table of nodes, the costliest first, and of reading and writing files, added up over the frames; "" when nothing ran. Where
/// nodes and frames overlapped, the sum is larger than `seconds`, the time that the run took, and the heading says so.
std::string time_table(const Plan& plan, const std::vector<FrameReport>& reports, double seconds);

}  // namespace quell::app
