// Settings from outside of the graph file: `--set node.param=value` and `--params FILE`. Private to this box.
#pragma once

#include <vector>

#include "quell/graph/settings.h"

namespace quell::detail {

/// Reads both kinds, in the order in which they are to be applied: files first.
std::vector<Setting> read_outside(const GraphOptions& options, Diagnostics& errors);

}  // namespace quell::detail
