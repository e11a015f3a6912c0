// One source looked up. Private to this box.
#pragma once

#include <map>
#include <set>
#include <utility>

#include "quell/graph/scope.h"

namespace quell::detail {

class Resolver {
 public:
  Resolver(const Unfolded& graph, Diagnostics& errors) : graph_(graph), errors_(errors) {}

  /// Where an edge that stands in a scope comes from.
  Arrival resolve(const Scope& scope, const WrittenEdge& edge);
  /// The same for a source without a delay of its own.
  Arrival resolve(const Scope& scope, const Text& source);

 private:
  Arrival follow(const Scope& scope, const WrittenEdge& edge);
  Arrival from_input(const Scope& scope, int input);
  Arrival from_node(const Scope& scope, const Text& source, std::string_view node, std::string_view port);
  Arrival from_leaf(const Scope& scope, const Text& source, int leaf, std::string_view port);
  Arrival from_subgraph(const Scope& scope, const Text& source, const Scope& inner, std::string_view port);
  bool pick_item(const Scope& scope, const Text& source, const Leaf& leaf, std::string_view index, Endpoint& endpoint);
  Arrival delay(const Scope& scope, const WrittenEdge& edge, Arrival arrival);
  bool read_initial(const Scope& scope, const WrittenEdge& edge, Initial& initial);
  Arrival tell(const Scope& scope, const Position& where, std::string message);

  const Unfolded& graph_;
  Diagnostics& errors_;
  // An edge may be come by in many ways, each through a source and an initial value: as many as 2^n through n subgraphs.
  std::map<std::pair<const Scope*, const WrittenEdge*>, Arrival> known_;
  std::set<std::pair<const Scope*, std::string>> under_way_;  // outputs of subgraphs, to notice those that feed themselves
};

}  // namespace quell::detail
