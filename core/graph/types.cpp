#include "quell/graph/types.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace quell::detail {
namespace {

std::optional<PortType> type_of(const Unfolded& graph, const Endpoint& endpoint) {
  const auto port = static_cast<std::size_t>(endpoint.port);
  if (endpoint.node < 0) return graph.root.document->inputs[port].type;
  const auto& items = graph.leaves[static_cast<std::size_t>(endpoint.node)].output_types[port];
  const auto item = static_cast<std::size_t>(endpoint.item);
  return item < items.size() ? items[item] : std::nullopt;
}

enum class Stage { undelayed, delayed, first_accepted };

// The type of one source of the input that an output follows.
std::optional<PortType> followed_type(const Unfolded& graph, const Arrival& arrival, const quell_port_desc& input, Stage stage) {
  const bool is_usable = arrival.edge.delay == 0 || stage != Stage::undelayed;
  std::optional<PortType> type = is_usable ? type_of(graph, arrival) : std::nullopt;
  const Initial& initial = arrival.edge.initial;
  if (!type && arrival.edge.delay != 0 && initial.kind == Initial::Kind::endpoint) type = type_of(graph, initial.endpoint);
  if (!type && stage == Stage::first_accepted && arrival.state != Arrival::State::broken)
    type = static_cast<PortType>(std::countr_zero(input.types));
  return type;
}

// Returns whether anything became known.
bool resolve_leaf(const Unfolded& graph, Leaf& leaf, Stage stage) {
  bool is_new = false;
  for (std::uint32_t i = 0; i < leaf.pass->output_count; ++i) {
    const int followed = leaf.output(i).same_as;
    if (followed < 0) continue;
    const std::vector<Arrival>& arrivals = leaf.inputs[static_cast<std::size_t>(followed)];
    auto& items = leaf.output_types[i];
    for (std::size_t item = 0; item < items.size(); ++item) {
      if (items[item]) continue;
      const Arrival unconnected{Arrival::State::absent, {}, {}, {}, {}};
      const Arrival& arrival = item < arrivals.size() ? arrivals[item] : unconnected;
      items[item] = followed_type(graph, arrival, leaf.input(static_cast<std::size_t>(followed)), stage);
      is_new = is_new || items[item];
    }
  }
  return is_new;
}

void start(Leaf& leaf) {
  for (std::uint32_t i = 0; i < leaf.pass->output_count; ++i) {
    const quell_port_desc& output = leaf.output(i);
    if (output.same_as < 0) {
      leaf.output_types[i].assign(1, static_cast<PortType>(std::countr_zero(output.types)));
      continue;
    }
    const std::size_t sources = leaf.inputs[static_cast<std::size_t>(output.same_as)].size();
    leaf.output_types[i].assign(output.flags & QUELL_PORT_ARRAY ? sources : 1, std::nullopt);
  }
}

bool resolve_all(Unfolded& graph, Stage stage) {
  bool is_new = false;
  for (Leaf& leaf : graph.leaves) {
    is_new = (leaf.pass && resolve_leaf(graph, leaf, stage)) || is_new;
    if (is_new && stage == Stage::first_accepted) return true;  // one guess may settle all others
  }
  return is_new;
}

void resolve_to_the_end(Unfolded& graph, Stage stage) {
  while (resolve_all(graph, stage)) {}
}

class Checker {
 public:
  Checker(const Unfolded& graph, Diagnostics& errors) : graph_(graph), errors_(errors) {}

  void check(const Arrival& arrival, Types accepted, const std::string& label, const Scope& scope) {
    const std::optional<PortType> type = type_of(graph_, arrival);
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
    const std::optional<PortType> first = type_of(graph_, initial.endpoint);
    if (first && first != type)
      errors_.error(arrival.initial_where,
                    "the initial value is " + std::string(name(*first)) + ", but what follows is " + std::string(name(*type)) +
                        "; expected the same type",
                    scope.included_from());
  }

 private:
  void check_constant(const Arrival& arrival, PortType type, const Scope& scope) {
    const std::vector<double>& constant = arrival.edge.initial.constant;
    const auto tell = [&](const std::string& message) { errors_.error(arrival.initial_where, message, scope.included_from()); };
    const int channels = info(type).channels;
    const auto is_id = [](double value) { return value >= 0 && value <= double{QUELL_NO_ID} && std::trunc(value) == value; };
    if (type == QUELL_TYPE_CAMERA) {
      tell("a camera has no constant; expected \"none\" or {\"from\": \"node.port\"}");
    } else if (constant.empty() ||
               (channels > 0 && constant.size() != 1 && constant.size() != static_cast<std::size_t>(channels))) {
      const std::string count = channels > 1    ? "1 or " + std::to_string(channels) + " values"
                                : channels == 1 ? "1 value"
                                                : "values";
      tell("a constant " + std::string(name(type)) + " has " + count + ", got " + std::to_string(constant.size()));
    } else if (type == QUELL_TYPE_ID && !std::all_of(constant.begin(), constant.end(), is_id)) {
      tell("a constant id is an integer from 0 to 4294967295");
    }
  }

  const Unfolded& graph_;
  Diagnostics& errors_;
};

}  // namespace

std::optional<PortType> type_of(const Unfolded& graph, const Arrival& arrival) {
  if (arrival.type) return arrival.type;
  return arrival.state == Arrival::State::connected ? type_of(graph, arrival.edge.from) : std::nullopt;
}

void resolve_types(Unfolded& graph, bool has_errors) {
  for (Leaf& leaf : graph.leaves)
    if (leaf.pass) start(leaf);
  resolve_to_the_end(graph, Stage::undelayed);
  resolve_to_the_end(graph, Stage::delayed);
  if (has_errors) return;  // a type may be unknown because of them
  while (resolve_all(graph, Stage::first_accepted)) resolve_to_the_end(graph, Stage::delayed);
}

void check_types(const Unfolded& graph, const Connections& connections, Diagnostics& errors) {
  Checker checker(graph, errors);
  // What goes wrong where an edge enters a subgraph need not be told again inside of it, so these come first.
  for (const Crossing& crossing : connections.crossings)
    checker.check(crossing.arrival, QUELL_TYPE_BIT(crossing.input->type), crossing.label, *crossing.scope);
  for (const Leaf& leaf : graph.leaves)
    for (std::size_t i = 0; i < leaf.inputs.size(); ++i)
      for (const Arrival& arrival : leaf.inputs[i])
        checker.check(arrival, leaf.input(i).types,
                      "the input '" + std::string(leaf.input(i).name) + "' of the pass '" + leaf.pass->id + "' ", *leaf.scope);
}

}  // namespace quell::detail
