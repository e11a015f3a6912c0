#include "quell/graph/plan_presence.h"

#include <algorithm>
#include <cassert>

#include "quell/graph/plan_ports.h"

namespace quell::planning {

Presence::Presence(const Graph& graph, const std::vector<Shape>& inputs) : graph_(graph) {
  for (const Shape& input : inputs) inputs_.push_back(input.present);
  // Same-frame edges lead forwards, so that one round settles almost everything; array items may follow delayed edges.
  for (bool changed = true; changed;) {
    changed = false;
    for (int node = 0; node < static_cast<int>(graph.nodes.size()); ++node) {
      if (!has_node(node)) continue;
      if (find_absent(node) || find_absent_items(node)) changed = true;
    }
  }
}

bool Presence::has(const Endpoint& endpoint) const {
  if (endpoint.is_nothing()) return false;
  if (endpoint.node < 0) return inputs_[static_cast<std::size_t>(endpoint.port)];
  return has_node(endpoint.node) && !items_.contains(endpoint);
}

bool Presence::has(const Edge& edge) const { return has(edge.from) || (edge.delay != 0 && always_has(edge)); }

// Whether the edge carries something in every frame, the first included.
bool Presence::always_has(const Edge& edge) const {
  if (edge.delay == 0) return has(edge.from);
  if (edge.initial.kind == Initial::Kind::endpoint) return has(edge.initial.endpoint);
  return edge.initial.kind == Initial::Kind::constant;
}

bool Presence::find_absent(int index) {
  const Node& node = graph_.nodes[static_cast<std::size_t>(index)];
  for (std::size_t port = 0; port < node.inputs.size(); ++port) {
    if (is_optional(input_port(node, port))) continue;
    for (std::size_t item = 0; item < node.inputs[port].size(); ++item) {
      const Edge& edge = node.inputs[port][item];
      if (always_has(edge)) continue;
      const bool initial = edge.delay != 0 && edge.initial.kind == Initial::Kind::endpoint;
      nodes_[index] = {item_name(input_port(node, port), item), initial ? edge.initial.endpoint : edge.from};
      return true;
    }
  }
  return false;
}

bool Presence::find_absent_items(int index) {
  const Node& node = graph_.nodes[static_cast<std::size_t>(index)];
  bool found = false;
  for (std::size_t port = 0; port < node.pass->output_count; ++port) {
    const quell_port_desc& output = output_port(node, port);
    if (!is_array(output) || output.same_as < 0) continue;
    const auto mirrored = static_cast<std::size_t>(output.same_as);
    for (std::size_t item = 0; item < node.inputs[mirrored].size(); ++item) {
      const Edge& edge = node.inputs[mirrored][item];
      if (has(edge)) continue;
      const Endpoint endpoint{index, static_cast<int>(port), static_cast<int>(item)};
      found |= items_.emplace(endpoint, Cause{item_name(input_port(node, mirrored), item), edge.from}).second;
    }
  }
  return found;
}

std::string Presence::why_absent(Endpoint endpoint) const {
  std::string chain;
  // A cause was absent before its effect was found to be, so the chain ends.
  while (endpoint.node >= 0) {
    const auto node = nodes_.find(endpoint.node);
    assert(node != nodes_.end() || items_.contains(endpoint));
    const Cause& cause = node != nodes_.end() ? node->second : items_.at(endpoint);
    const std::string& name = graph_.nodes[static_cast<std::size_t>(endpoint.node)].name;
    chain += "'" + name + "' needs '" + graph_.describe(cause.from) + "' as '" + cause.input + "', ";
    endpoint = cause.from;
  }
  if (endpoint.is_nothing()) return chain + "and that optional input of a subgraph is not connected";
  return chain + (chain.empty() ? "" : "and ") + "the source does not have '" + graph_.describe(endpoint) + "'";
}

std::string Presence::why_node_absent(int node) const {
  const Cause& cause = nodes_.at(node);
  return "needs '" + graph_.describe(cause.from) + "' as '" + cause.input + "', " + (cause.from.node < 0 ? "and " : "") +
         why_absent(cause.from);
}

std::vector<Read> reads(const Edge& edge, const Presence& presence) {
  std::vector<Read> found;
  if (presence.has(edge.from)) found.push_back({edge.from, edge.delay});
  if (edge.delay != 0 && edge.initial.kind == Initial::Kind::endpoint && presence.has(edge.initial.endpoint))
    found.push_back({edge.initial.endpoint, 0});
  return found;
}

std::vector<Read> reads(const Node& node, const Presence& presence) {
  std::vector<Read> found;
  for (const std::vector<Edge>& port : node.inputs)
    for (const Edge& edge : port)
      for (const Read& read : reads(edge, presence)) found.push_back(read);
  if (std::ranges::any_of(found, [](const Read& read) { return read.delay > 0; }))
    for (const Endpoint& reset : node.resets)
      if (presence.has(reset)) found.push_back({reset, 0});
  return found;
}

std::vector<bool> find_needed(const Graph& graph, const Presence& presence, const std::vector<Endpoint>& roots) {
  std::vector<bool> needed(graph.nodes.size(), false);
  std::vector<int> open;
  const auto need = [&](const Endpoint& endpoint) {
    if (endpoint.node < 0 || needed[static_cast<std::size_t>(endpoint.node)]) return;
    needed[static_cast<std::size_t>(endpoint.node)] = true;
    open.push_back(endpoint.node);
  };
  for (const Endpoint& root : roots) need(root);
  while (!open.empty()) {
    const Node& node = graph.nodes[static_cast<std::size_t>(open.back())];
    open.pop_back();
    for (const Read& read : reads(node, presence)) need(read.from);
  }
  return needed;
}

}  // namespace quell::planning
