#include "quell/graph/resolve.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "quell/graph/fields.h"

namespace quell::detail {
namespace {

constexpr std::size_t kLongestChain = 200;  // of subgraphs that hand on what they are given; the resolver recurses along it

std::vector<std::string> output_names(const Leaf& leaf) {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < leaf.pass->output_count; ++i) names.emplace_back(leaf.output(i).name);
  return names;
}

// How many items an output has that is an array: as many as the sources of the input that it follows.
std::size_t item_count(const Leaf& leaf, const quell_port_desc& output) {
  const std::string_view input = leaf.input(static_cast<std::size_t>(output.same_as)).name;
  for (const WrittenPort& port : leaf.written->in)
    if (port.name.text == input) return port.edges.size();
  return 0;
}

}  // namespace

Arrival Resolver::tell(const Scope& scope, const Position& where, std::string message) {
  errors_.error(where, std::move(message), scope.included_from());
  return {};
}

Arrival Resolver::resolve(const Scope& scope, const Text& source) {
  const std::size_t dot = source.text.find('.');
  const std::string_view name = std::string_view(source.text).substr(0, dot);
  if (dot != std::string::npos) return from_node(scope, source, name, std::string_view(source.text).substr(dot + 1));
  const int input = scope.find_input(name);
  if (input >= 0) return from_input(scope, input);
  if (const WrittenNode* node = scope.find_node(name)) {
    const Child& child = scope.children.at(node->name.text);
    std::vector<std::string> ports;
    if (child.leaf >= 0 && graph_.leaves[static_cast<std::size_t>(child.leaf)].pass)
      ports = output_names(graph_.leaves[static_cast<std::size_t>(child.leaf)]);
    if (child.scope)
      for (const WrittenOutput& output : child.scope->document->outputs) ports.push_back(output.name.text);
    for (std::string& port : ports) port = source.text + "." + port;
    return tell(scope, source.where,
                "'" + source.text + "' is a node; expected one of its outputs" + (ports.empty() ? "" : ", " + list_names(ports)));
  }
  std::vector<std::string> inputs, names = scope.node_names();
  for (const GraphInput& other : scope.document->inputs) inputs.push_back(other.name);
  names.insert(names.end(), inputs.begin(), inputs.end());
  const std::string close = did_you_mean(name, names);
  inputs.emplace_back("node.port");
  return tell(scope, source.where,
              "the graph has no input '" + source.text + "'" + (close.empty() ? "; expected " + list_names(inputs) : close));
}

Arrival Resolver::from_input(const Scope& scope, int input) {
  Arrival arrival;
  if (scope.document->broken_inputs[static_cast<std::size_t>(input)]) return arrival;
  if (!scope.parent) {
    arrival.state = Arrival::State::connected;
    arrival.edge.from = {-1, input, 0};
    return arrival;
  }
  const GraphInput& declared = scope.document->inputs[static_cast<std::size_t>(input)];
  const auto port = std::find_if(scope.node->in.begin(), scope.node->in.end(),
                                 [&](const WrittenPort& other) { return other.name.text == declared.name; });
  if (port == scope.node->in.end()) {
    arrival.type = declared.type;
    if (declared.optional) arrival.state = Arrival::State::absent, arrival.initial_where = declared.where;
    return arrival;
  }
  if (port->is_broken || port->is_list || port->edges.size() != 1) return arrival;
  arrival = resolve(*scope.parent, port->edges[0]);
  arrival.type = declared.type;
  arrival.none_was_told = arrival.none_was_told || !declared.optional;
  return arrival;
}

Arrival Resolver::from_node(const Scope& scope, const Text& source, std::string_view name, std::string_view port) {
  const auto child = scope.children.find(name);
  if (child == scope.children.end()) {
    if (scope.find_input(name) >= 0)
      return tell(
          scope, source.where,
          "'" + std::string(name) + "' is an input of the graph, which has no ports; expected '" + std::string(name) + "'");
    return tell(scope, source.where, "there is no node '" + std::string(name) + "'" + suggest(name, scope.node_names()));
  }
  if (child->second.scope) return from_subgraph(scope, source, *child->second.scope, port);
  return child->second.leaf < 0 ? Arrival() : from_leaf(scope, source, child->second.leaf, port);
}

Arrival Resolver::from_leaf(const Scope& scope, const Text& source, int index, std::string_view port) {
  const Leaf& leaf = graph_.leaves[static_cast<std::size_t>(index)];
  if (!leaf.pass) return {};
  const std::size_t bracket = port.find('[');
  const std::string_view name = port.substr(0, bracket);
  for (std::uint32_t i = 0; i < leaf.pass->output_count; ++i) {
    if (name != leaf.output(i).name) continue;
    Arrival arrival;
    arrival.edge.from = {index, static_cast<int>(i), 0};
    const std::string_view item = bracket == std::string_view::npos ? std::string_view() : port.substr(bracket);
    if (pick_item(scope, source, leaf, item, arrival.edge.from)) arrival.state = Arrival::State::connected;
    return arrival;
  }
  const std::vector<std::string> names = output_names(leaf);
  return tell(scope, source.where,
              "the pass '" + std::string(leaf.pass->id) + "' has no output '" + std::string(name) + "'" + suggest(name, names));
}

// "[1]" of "split.parts[1]".
bool Resolver::pick_item(const Scope& scope, const Text& source, const Leaf& leaf, std::string_view index, Endpoint& endpoint) {
  const quell_port_desc& output = leaf.output(static_cast<std::size_t>(endpoint.port));
  const std::string plain = source.text.substr(0, source.text.find('['));
  if (!(output.flags & QUELL_PORT_ARRAY)) {
    if (!index.empty())
      tell(scope, source.where, "'" + plain + "' is a single output; expected '" + plain + "' without an index");
    return index.empty();
  }
  const std::size_t count = item_count(leaf, output);
  if (index.empty() && count == 1) return true;
  const char* end = index.data() + index.size();
  const bool is_index =
      index.size() > 2 && std::from_chars(index.data() + 1, end, endpoint.item).ptr == end - 1 && index.back() == ']';
  if (is_index && endpoint.item >= 0 && static_cast<std::size_t>(endpoint.item) < count) return true;
  std::string expected = "; expected '" + plain + "' or '" + plain + "[0]'";
  if (count > 1) expected = "; expected '" + plain + "[0]' to '" + plain + "[" + std::to_string(count - 1) + "]'";
  if (count == 0)
    expected = ", as its node's input '" + std::string(leaf.input(static_cast<std::size_t>(output.same_as)).name) + "' is";
  tell(scope, source.where, "'" + plain + "' is a list of " + std::to_string(count) + expected);
  return false;
}

Arrival Resolver::from_subgraph(const Scope& scope, const Text& source, const Scope& inner, std::string_view port) {
  std::vector<std::string> names;
  for (const WrittenOutput& output : inner.document->outputs) {
    names.push_back(output.name.text);
    if (port != output.name.text) continue;
    const auto [entry, is_new] = under_way_.emplace(&inner, output.name.text);
    if (!is_new)
      return tell(scope, source.where,
                  "'" + source.text + "' leads through subgraphs back to itself; expected a source that a pass computes");
    if (under_way_.size() > kLongestChain)
      return tell(scope, source.where,
                  "'" + source.text + "' leads through more than " + std::to_string(kLongestChain) + " outputs of subgraphs");
    Arrival arrival = resolve(inner, output.from);
    under_way_.erase({&inner, output.name.text});
    return arrival;
  }
  return tell(scope, source.where,
              "the graph '" + inner.node->graph->text + "' has no output '" + std::string(port) + "'" + suggest(port, names));
}

Arrival Resolver::resolve(const Scope& scope, const WrittenEdge& edge) {
  const std::pair key(&scope, &edge);
  if (const auto known = known_.find(key); known != known_.end()) return known->second;
  return known_.emplace(key, follow(scope, edge)).first->second;
}

Arrival Resolver::follow(const Scope& scope, const WrittenEdge& edge) {
  Arrival arrival = resolve(scope, edge.from);
  if (edge.delay != 0) return delay(scope, edge, std::move(arrival));
  if (arrival.edge.delay == 0) arrival.initial_where = edge.where;
  arrival.edge.where = edge.where;
  return arrival;
}

bool Resolver::read_initial(const Scope& scope, const WrittenEdge& edge, Initial& initial) {
  initial.kind = edge.initial->kind, initial.constant = edge.initial->constant;
  if (initial.kind != Initial::Kind::endpoint) return true;
  const Arrival from = resolve(scope, edge.initial->from);
  if (from.state == Arrival::State::absent) initial.kind = Initial::Kind::none;
  if (from.state == Arrival::State::connected && from.edge.delay != 0) {
    tell(scope, edge.initial->from.where,
         "an initial value must be of the same frame; '" + edge.initial->from.text + "' is delayed where this graph is used");
    return false;
  }
  initial.endpoint = from.edge.from;
  return from.state != Arrival::State::broken;
}

// Adds the delay of an edge to what it carries, which may be delayed already outside of this graph.
Arrival Resolver::delay(const Scope& scope, const WrittenEdge& edge, Arrival arrival) {
  Initial initial;
  if (!read_initial(scope, edge, initial) || arrival.state == Arrival::State::broken) return {};
  if (arrival.state == Arrival::State::connected && edge.delay < 0 && arrival.edge.from.node >= 0)
    return tell(
        scope, edge.delay_where,
        "only inputs of the graph can be read ahead of time, and '" + edge.from.text + "' is computed; expected a delay above 0");
  const int before = arrival.edge.delay;
  const Initial& outer = arrival.edge.initial;
  const bool is_same = outer.kind == initial.kind && outer.kind != Initial::Kind::endpoint && outer.constant == initial.constant;
  if (before != 0 && ((before > 0) != (edge.delay > 0) || !is_same))
    return tell(scope, edge.where,
                "'" + edge.from.text + "' is delayed by " + std::to_string(before) +
                    " frames already where this graph is used; a second delay must have the same sign and the same "
                    "initial value, \"none\" or a constant");
  arrival.edge.delay += edge.delay;
  if (std::abs(arrival.edge.delay) > kLongestDelay)
    return tell(scope, edge.delay_where,
                "'" + edge.from.text + "' is delayed by " + std::to_string(before) + " frames already, which makes " +
                    std::to_string(arrival.edge.delay) + "; the most is " + std::to_string(kLongestDelay));
  arrival.edge.initial = std::move(initial);
  arrival.edge.where = edge.where;
  arrival.initial_where = edge.initial->where;
  arrival.none_was_told = false;
  return arrival;
}

}  // namespace quell::detail
