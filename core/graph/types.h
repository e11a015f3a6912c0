// The type that every edge carries, and whether it may arrive where it does. Private to this box.
#pragma once

#include "quell/graph/connect.h"
#include "quell/graph/scope.h"

namespace quell::detail {

/// Fills in Leaf::output_types. An output that follows an input takes its type from undelayed sources first, then from delayed
/// ones; when it comes from nothing but itself, it is the first type that the input accepts.
void resolve_types(Unfolded& graph, bool has_errors);

/// The type that an edge carries; nothing when it is broken.
std::optional<PortType> type_of(const Unfolded& graph, const Arrival& arrival);

/// Checks every edge against the port where it arrives, and constants against the type.
void check_types(const Unfolded& graph, const Connections& connections, Diagnostics& errors);

}  // namespace quell::detail
