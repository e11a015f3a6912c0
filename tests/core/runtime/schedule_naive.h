// What a test graph yields, computed from its definition alone: no session, no plan, no schedule.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "tests/core/runtime/schedule_run.h"

namespace quell::test {

/// The outcome of an error-free session; reports have frame, ok, node and the counts of replaced values. `order` has the names of
/// the nodes in the order in which failures count.
Outcome compute_naively(const TestGraph& graph, const Scene& scene, const std::vector<std::string>& order);

/// The same without what the naive way does not know: the words of errors, and times.
Outcome without_words(Outcome outcome);

}  // namespace quell::test
