#include "quell/graph/connect.h"

#include <algorithm>

#include "quell/graph/fields.h"
#include "quell/graph/resolve.h"

namespace quell::detail {
namespace {

class Connector {
 public:
  Connector(Unfolded& graph, Diagnostics& errors) : graph_(graph), errors_(errors), resolver_(graph, errors) {}

  Connections run() {
    for (Leaf& leaf : graph_.leaves) connect_leaf(leaf);
    connect_reset(graph_.root);
    connect_subgraphs(graph_.root);
    for (const WrittenOutput& output : graph_.root.document->outputs) {
      Arrival arrival = resolver_.resolve(graph_.root, output.from);
      if (arrival.state == Arrival::State::connected && arrival.edge.delay != 0)
        errors_.error(output.from.where,
                      "an output of the graph must be of the same frame; '" + output.from.text + "' is delayed");
      result_.outputs.push_back(std::move(arrival));
    }
    return std::move(result_);
  }

 private:
  void connect_leaf(Leaf& leaf) {
    const Scope& scope = *leaf.scope;
    std::vector<std::string> misspelt;
    for (const WrittenPort& port : leaf.written->in) {
      std::vector<Arrival> arrivals;
      for (const WrittenEdge& edge : port.edges) arrivals.push_back(resolver_.resolve(scope, edge));
      if (!leaf.pass) continue;
      const int index = find_input(leaf, port.name);
      if (index < 0) {
        misspelt.push_back(port.name.text);
        continue;
      }
      const quell_port_desc& desc = leaf.input(static_cast<std::size_t>(index));
      if (!has_right_form(scope, port, desc, leaf) || port.is_broken) arrivals.assign(1, Arrival());
      for (const Arrival& arrival : arrivals) check_none(scope, arrival, desc, leaf);
      leaf.inputs[static_cast<std::size_t>(index)] = std::move(arrivals);
    }
    if (leaf.pass) require_inputs(leaf, misspelt);
  }

  int find_input(const Leaf& leaf, const Text& name) {
    std::vector<std::string> names;
    for (std::uint32_t i = 0; i < leaf.pass->input_count; ++i) {
      names.emplace_back(leaf.input(i).name);
      if (name.text == names.back()) return static_cast<int>(i);
    }
    errors_.error(name.where,
                  "the pass '" + std::string(leaf.pass->id) + "' has no input '" + name.text + "'" +
                      suggest(name.text, names, "; it has none"),
                  leaf.scope->included_from());
    return -1;
  }

  bool has_right_form(const Scope& scope, const WrittenPort& port, const quell_port_desc& desc, const Leaf& leaf) {
    if (desc.flags & QUELL_PORT_ARRAY || !port.is_list) return true;  // a list of one may be written as one source
    errors_.error(port.value_where,
                  "the input '" + port.name.text + "' of the pass '" + leaf.pass->id + "' takes one source, not a list",
                  scope.included_from());
    return false;
  }

  void check_none(const Scope& scope, const Arrival& arrival, const quell_port_desc& desc, const Leaf& leaf) {
    const bool is_none = arrival.edge.delay != 0 && arrival.edge.initial.kind == Initial::Kind::none;
    if (arrival.state != Arrival::State::connected || !is_none || arrival.none_was_told) return;
    if (desc.flags & QUELL_PORT_OPTIONAL) return;
    errors_.error(arrival.initial_where,
                  "the input '" + std::string(desc.name) + "' of the pass '" + leaf.pass->id +
                      "' is not optional, so it cannot start with \"none\"; expected {\"constant\": [...]} or {\"from\": "
                      "\"node.port\"}",
                  scope.included_from());
  }

  void require_inputs(const Leaf& leaf, const std::vector<std::string>& misspelt) {
    std::vector<std::string> missing;
    for (std::uint32_t i = 0; i < leaf.pass->input_count; ++i) {
      const quell_port_desc& desc = leaf.input(i);
      if (!(desc.flags & QUELL_PORT_OPTIONAL) && leaf.inputs[i].empty() && !is_meant(desc.name, misspelt))
        missing.push_back(std::string(desc.name) + "' (" + describe(Types{desc.types}));
    }
    tell_missing(leaf.written->name, *leaf.scope, missing);
  }

  // `missing` holds names with their types: "normal' (normal".
  void tell_missing(const Text& node, const Scope& scope, const std::vector<std::string>& missing) {
    if (missing.empty()) return;
    std::string list;
    for (const std::string& input : missing) list += (list.empty() ? "'" : ", '") + input + ")";
    errors_.error(node.where,
                  "the node '" + node.text + "' lacks its input" + (missing.size() > 1 ? "s " : " ") + list +
                      "; expected a source for " + (missing.size() > 1 ? "each" : "it") + " in \"in\"",
                  scope.included_from());
  }

  void connect_subgraphs(const Scope& scope) {
    for (const WrittenNode& node : scope.document->nodes) {
      const Child& child = scope.children.at(node.name.text);
      if (child.scope)
        connect_subgraph(scope, node, *child.scope);
      else if (child.leaf < 0)
        for (const WrittenPort& port : node.in)
          for (const WrittenEdge& edge : port.edges) resolver_.resolve(scope, edge);
    }
  }

  void connect_subgraph(const Scope& scope, const WrittenNode& node, const Scope& inner) {
    std::vector<std::string> missing, misspelt;
    for (const WrittenPort& port : node.in) {
      cross(scope, port, inner);
      if (inner.find_input(port.name.text) < 0) misspelt.push_back(port.name.text);
    }
    for (const GraphInput& input : inner.document->inputs) {
      const auto is_it = [&](const WrittenPort& port) { return port.name.text == input.name; };
      if (!input.optional && std::none_of(node.in.begin(), node.in.end(), is_it) && !is_meant(input.name, misspelt))
        missing.push_back(input.name + "' (" + std::string(name(input.type)));
    }
    tell_missing(node.name, scope, missing);
    for (const WrittenOutput& output : inner.document->outputs) {
      const Arrival arrival = resolver_.resolve(inner, output.from);
      if (arrival.state == Arrival::State::connected && arrival.edge.delay == 0)
        result_.subgraph_outputs.push_back({inner.prefix + output.name.text, arrival.edge.from, output.name.where});
    }
    connect_reset(inner);
    connect_subgraphs(inner);
  }

  void connect_reset(const Scope& scope) {
    if (!scope.document->reset) return;
    const Text& reset = *scope.document->reset;
    Arrival arrival = resolver_.resolve(scope, reset);
    arrival.edge.where = reset.where;
    if (arrival.state == Arrival::State::connected && arrival.edge.delay != 0) {
      errors_.error(reset.where, "a reset must be of the same frame; '" + reset.text + "' is delayed where this graph is used",
                    scope.included_from());
      arrival = {};
    }
    result_.resets.emplace(&scope, std::move(arrival));
  }

  // An edge into an input of a subgraph.
  void cross(const Scope& scope, const WrittenPort& port, const Scope& inner) {
    const std::string graph = "the graph '" + inner.node->graph->text + "' ";
    const int index = inner.find_input(port.name.text);
    if (index < 0) {
      std::vector<std::string> names;
      for (const GraphInput& input : inner.document->inputs) names.push_back(input.name);
      errors_.error(port.name.where,
                    graph + "has no input '" + port.name.text + "'" + suggest(port.name.text, names, "; it has none"),
                    scope.included_from());
    }
    if (port.is_list)
      errors_.error(port.value_where, graph + "takes one source for its input '" + port.name.text + "', not a list",
                    scope.included_from());
    for (const WrittenEdge& edge : port.edges) {
      const Arrival arrival = resolver_.resolve(scope, edge);
      if (index < 0 || port.is_list) continue;
      const GraphInput& input = inner.document->inputs[static_cast<std::size_t>(index)];
      const bool is_none = arrival.edge.delay != 0 && arrival.edge.initial.kind == Initial::Kind::none;
      if (arrival.state == Arrival::State::connected && is_none && !input.optional && !arrival.none_was_told)
        errors_.error(arrival.initial_where,
                      graph + "needs its input '" + input.name +
                          "' in every frame, so it cannot start with \"none\"; expected "
                          "{\"constant\": [...]} or {\"from\": \"node.port\"}",
                      scope.included_from());
      result_.crossings.push_back({arrival, &input, &scope, "the input '" + input.name + "' of " + graph});
    }
  }

  Unfolded& graph_;
  Diagnostics& errors_;
  Resolver resolver_;
  Connections result_;
};

}  // namespace

Connections connect(Unfolded& graph, Diagnostics& errors) { return Connector(graph, errors).run(); }

}  // namespace quell::detail
