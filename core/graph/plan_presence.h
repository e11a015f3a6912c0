// What of a graph can be computed from the inputs that the source has, and who reads what. Private to this box.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "quell/graph/plan.h"

namespace quell::planning {

/// Follows absent graph inputs through the graph. A node lacks what it needs when an input that is not optional is absent; an
/// item of an array output is absent when the item of the input that it mirrors is. A delayed edge that has an initial value
/// is never absent: without its source it always carries the initial value.
class Presence {
 public:
  /// `inputs[i].present` says whether graph input i is there.
  Presence(const Graph& graph, const std::vector<Shape>& inputs);

  bool has(const Endpoint& endpoint) const;
  /// Whether the edge carries something in some frame.
  bool has(const Edge& edge) const;
  bool has_node(int node) const { return !nodes_.contains(node); }
  /// From an absent endpoint down to the input that the source lacks: "'blend' needs 'motion.motion' as 'motion', ...".
  std::string why_absent(Endpoint endpoint) const;
  /// The same for a node: "needs 'motion.motion' as 'motion', 'motion' needs ...".
  std::string why_node_absent(int node) const;

 private:
  struct Cause {
    std::string input;  ///< of the node
    Endpoint from;      ///< absent, too
  };
  bool always_has(const Edge& edge) const;
  bool find_absent(int node);
  bool find_absent_items(int node);

  const Graph& graph_;
  std::vector<bool> inputs_;
  std::map<int, Cause> nodes_;       // absent ones
  std::map<Endpoint, Cause> items_;  // absent items of array outputs
};

/// A value that a node reads. An initial value is read in the same frame, whether it is used or not.
struct Read {
  Endpoint from;
  int delay = 0;
};

/// Everything that an edge reads of what is there.
std::vector<Read> reads(const Edge& edge, const Presence& presence);
/// The same over all edges of a node, in the order of its ports; where some of them read history, then what resets it.
std::vector<Read> reads(const Node& node, const Presence& presence);

/// Which nodes the roots need, in this frame or in another.
std::vector<bool> find_needed(const Graph& graph, const Presence& presence, const std::vector<Endpoint>& roots);

}  // namespace quell::planning
