// "Same as input X": the type of an output, found by following sources. Private to this box.
#pragma once

#include <optional>

#include "quell/graph/graph.h"

namespace quell::detail {

/// What arrives at an input of a node.
struct FollowedSource {
  const Edge* edge = nullptr;    ///< null: unconnected
  std::optional<PortType> type;  ///< when it is known without following
  bool is_broken = false;        ///< it leads nowhere, so that its type cannot be known
};

/// The nodes and edges of a graph, whatever they are stored in.
class FollowedGraph {
 public:
  virtual ~FollowedGraph() = default;
  virtual PortType input_type(int input) const = 0;
  /// Null when the node is broken.
  virtual const quell_pass_desc* pass(int node) const = 0;
  virtual FollowedSource source(int node, int input, int item) const = 0;
};

/// The type that an endpoint carries. Where sources go round in a loop, and so settle nothing, an initial value taken from
/// another endpoint does, or else the first type that all of the loop's inputs accept. An output that follows an unconnected
/// input has the first type that this accepts. Nothing when the way leads to something broken.
std::optional<PortType> follow_type(const FollowedGraph& graph, const Endpoint& endpoint);

}  // namespace quell::detail
