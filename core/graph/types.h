// Whether what every edge carries may arrive where it does. Private to this box.
#pragma once

#include "quell/graph/connect.h"
#include "quell/graph/scope.h"

namespace quell::detail {

/// Checks every edge against the port where it arrives, and constants against the type.
void check_types(const Unfolded& graph, const Connections& connections, Diagnostics& errors);

/// The type that arrives; nothing when that cannot be known, because something is broken. After connect().
std::optional<PortType> type_of(const Unfolded& graph, const Arrival& arrival);
/// The same for an output of a leaf.
std::optional<PortType> type_of(const Unfolded& graph, const Endpoint& endpoint);

}  // namespace quell::detail
