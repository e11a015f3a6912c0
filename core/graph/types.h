// Whether what every edge carries may arrive where it does. Private to this box.
#pragma once

#include "quell/graph/connect.h"
#include "quell/graph/scope.h"

namespace quell::detail {

/// Checks every edge against the port where it arrives, and constants against the type.
void check_types(const Unfolded& graph, const Connections& connections, Diagnostics& errors);

}  // namespace quell::detail
