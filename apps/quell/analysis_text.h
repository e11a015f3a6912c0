// The analysis of a graph's throughput, for people.
#pragma once

#include <string>

#include "quell/graph/plan.h"
#include "quell/runtime/analysis.h"
#include "quell/runtime/window.h"

namespace quell::app {

/// Tables: what each node takes, the slowest cycle of each loop, the bound and its terms; then what binds, and how many frames a
/// run has in flight.
std::string describe(const Plan& plan, const FrameTimes& times, const Analysis& analysis, const Window& window);

/// "The loop a -> b -> a binds: ...": which term is the largest, and what would help. One line.
std::string explain_limit(const Plan& plan, const FrameTimes& times, const Analysis& analysis);

}  // namespace quell::app
