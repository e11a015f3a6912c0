#include "quell/graph/types.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "quell/graph/follow_type.h"

namespace quell::detail {
namespace {

class LeafView final : public FollowedGraph {
 public:
  explicit LeafView(const Unfolded& graph) : graph_(graph) {}
  PortType input_type(int input) const override { return graph_.root.document->inputs[static_cast<std::size_t>(input)].type; }
  const quell_pass_desc* pass(int node) const override { return graph_.leaves[static_cast<std::size_t>(node)].pass; }
  FollowedSource source(int node, int input, int item) const override {
    const std::vector<Arrival>& arrivals = graph_.leaves[static_cast<std::size_t>(node)].inputs[static_cast<std::size_t>(input)];
    if (static_cast<std::size_t>(item) >= arrivals.size()) return {};
    const Arrival& arrival = arrivals[static_cast<std::size_t>(item)];
    if (arrival.state == Arrival::State::absent) return {nullptr, arrival.type, false};
    return {&arrival.edge, arrival.type, arrival.state == Arrival::State::broken};
  }

 private:
  const Unfolded& graph_;
};

class Checker {
 public:
  Checker(const Unfolded& graph, Diagnostics& errors) : graph_(graph), errors_(errors) {}

  void check(const Arrival& arrival, Types accepted, const std::string& label, const Scope& scope) {
    const std::optional<PortType> type = type_of(arrival);
    if (!type) return;
    if (!accepts(accepted, *type)) {
      errors_.error(arrival.edge.where, label + "takes " + quell::describe(accepted) + "; this is " + std::string(name(*type)),
                    scope.included_from());
      return;
    }
    if (arrival.edge.delay == 0) return;
    const Initial& initial = arrival.edge.initial;
    if (initial.kind == Initial::Kind::constant) check_constant(arrival, *type, scope);
    if (initial.kind != Initial::Kind::endpoint) return;
    const std::optional<PortType> first = follow_type(graph_, initial.endpoint);
    if (first && first != type)
      errors_.error(arrival.initial_where,
                    "the initial value is " + std::string(name(*first)) + ", but what follows is " + std::string(name(*type)) +
                        "; expected the same type",
                    scope.included_from());
  }

 private:
  std::optional<PortType> type_of(const Arrival& arrival) const {
    if (arrival.type || arrival.state != Arrival::State::connected) return arrival.type;
    return follow_type(graph_, arrival.edge.from);
  }

  void check_constant(const Arrival& arrival, PortType type, const Scope& scope) {
    const std::vector<double>& constant = arrival.edge.initial.constant;
    const auto tell = [&](const std::string& message) { errors_.error(arrival.initial_where, message, scope.included_from()); };
    const int channels = info(type).channels;
    const auto is_id = [](double value) { return value >= 0 && value <= double{QUELL_NO_ID} && std::trunc(value) == value; };
    const auto is_float = [](double value) { return std::abs(value) <= double{std::numeric_limits<float>::max()}; };
    if (type == QUELL_TYPE_CAMERA) {
      tell("there are no constants of type camera; expected \"none\" or {\"from\": \"node.port\"}");
    } else if (constant.empty() ||
               (channels > 0 && constant.size() != 1 && constant.size() != static_cast<std::size_t>(channels))) {
      const std::string count = channels > 1    ? "1 or " + std::to_string(channels) + " numbers"
                                : channels == 1 ? "1 number"
                                                : "at least 1 number";
      tell("a constant of type " + std::string(name(type)) + " takes " + count + ", got " + std::to_string(constant.size()));
    } else if (is_image(type) && type != QUELL_TYPE_ID && !std::all_of(constant.begin(), constant.end(), is_float)) {
      tell("a constant of type " + std::string(name(type)) + " takes numbers that fit a float, up to about 3.4e38");
    } else if (type == QUELL_TYPE_ID && !std::all_of(constant.begin(), constant.end(), is_id)) {
      tell("a constant of type id takes an integer from 0 to 4294967295");
    }
  }

  LeafView graph_;
  Diagnostics& errors_;
};

}  // namespace

std::optional<PortType> type_of(const Unfolded& graph, const Arrival& arrival) {
  if (arrival.type || arrival.state != Arrival::State::connected) return arrival.type;
  return type_of(graph, arrival.edge.from);
}

std::optional<PortType> type_of(const Unfolded& graph, const Endpoint& endpoint) {
  return follow_type(LeafView(graph), endpoint);
}

void check_types(const Unfolded& graph, const Connections& connections, Diagnostics& errors) {
  Checker checker(graph, errors);
  // What goes wrong where an edge enters a subgraph need not be told again inside of it, so these come first.
  for (const Crossing& crossing : connections.crossings)
    checker.check(crossing.arrival, QUELL_TYPE_BIT(crossing.input->type), crossing.label, *crossing.scope);
  for (const auto& [scope, reset] : connections.resets)
    checker.check(reset, QUELL_TYPE_BIT(QUELL_TYPE_VALUE), "\"reset\" ", *scope);
  for (const Leaf& leaf : graph.leaves)
    for (std::size_t i = 0; i < leaf.inputs.size(); ++i)
      for (const Arrival& arrival : leaf.inputs[i])
        checker.check(arrival, leaf.input(i).types,
                      "the input '" + std::string(leaf.input(i).name) + "' of the pass '" + leaf.pass->id + "' ", *leaf.scope);
}

}  // namespace quell::detail
