#include "quell/graph/build.h"

#include <algorithm>

#include "quell/graph/order.h"

namespace quell::detail {
namespace {

// The leaf whose result of the same frame an edge needs; -1 when none.
int needed_leaf(const Arrival& arrival) {
  if (arrival.state != Arrival::State::connected) return -1;
  if (arrival.edge.delay == 0) return arrival.edge.from.node;
  return arrival.edge.initial.kind == Initial::Kind::endpoint ? arrival.edge.initial.endpoint.node : -1;
}

bool reads_history(const Leaf& leaf) {
  for (const std::vector<Arrival>& port : leaf.inputs)
    for (const Arrival& arrival : port)
      if (arrival.state == Arrival::State::connected && arrival.edge.delay > 0) return true;
  return false;
}

// What resets the history that a leaf reads: of the scopes around it, the outermost first.
std::vector<const Arrival*> resets_of(const Leaf& leaf, const Connections& connections) {
  std::vector<const Arrival*> resets;
  if (!reads_history(leaf)) return resets;
  for (const Scope* scope = leaf.scope; scope; scope = scope->parent)
    if (const auto reset = connections.resets.find(scope);
        reset != connections.resets.end() && reset->second.state == Arrival::State::connected)
      resets.insert(resets.begin(), &reset->second);
  return resets;
}

Dependencies dependencies(const Unfolded& graph, const Connections& connections) {
  Dependencies needs(graph.leaves.size());
  for (std::size_t i = 0; i < graph.leaves.size(); ++i) {
    for (const std::vector<Arrival>& port : graph.leaves[i].inputs)
      for (const Arrival& arrival : port)
        if (const int leaf = needed_leaf(arrival); leaf >= 0) needs[i].push_back(leaf);
    for (const Arrival* reset : resets_of(graph.leaves[i], connections))
      if (reset->edge.from.node >= 0) needs[i].push_back(reset->edge.from.node);
  }
  return needs;
}

bool needs_directly(const Leaf& leaf, int source) {
  for (const std::vector<Arrival>& port : leaf.inputs)
    for (const Arrival& arrival : port)
      if (needed_leaf(arrival) == source) return true;
  return false;
}

// A cycle that a reset closes: one of its nodes reads history, and so needs the reset, which needs the node.
bool tell_reset_in_cycle(const Unfolded& graph, const Connections& connections, const std::vector<int>& cycle,
                         Diagnostics& errors) {
  for (std::size_t i = 0; i < cycle.size(); ++i) {
    const Leaf& reader = graph.leaves[static_cast<std::size_t>(cycle[i])];
    const int source = cycle[(i + 1) % cycle.size()];
    if (needs_directly(reader, source)) continue;
    for (const auto& [scope, reset] : connections.resets) {
      if (reset.state != Arrival::State::connected || reset.edge.from.node != source) continue;
      errors.error(reset.edge.where,
                   "a reset must be computed before what reads history, but '" + scope->document->reset->text + "' " +
                       (cycle.size() > 1 ? "depends on '" + reader.name + "', which reads" : "reads") +
                       " an earlier frame; expected a source that depends on no delayed edge of this graph",
                   scope->included_from());
      return true;
    }
  }
  return false;
}

void tell_cycle(const Unfolded& graph, const Connections& connections, const std::vector<int>& cycle, Diagnostics& errors) {
  if (tell_reset_in_cycle(graph, connections, cycle, errors)) return;
  const auto leaf = [&](int index) -> const Leaf& { return graph.leaves[static_cast<std::size_t>(index)]; };
  std::string path = leaf(cycle[0]).name;
  for (auto node = cycle.rbegin(); node != cycle.rend(); ++node) path += " -> " + leaf(*node).name;
  const int source = cycle[cycle.size() > 1 ? 1 : 0];
  for (const std::vector<Arrival>& port : leaf(cycle[0]).inputs)
    for (const Arrival& arrival : port) {
      if (needed_leaf(arrival) != source) continue;
      const bool is_initial = arrival.edge.delay != 0;
      errors.error(is_initial ? arrival.initial_where : arrival.edge.where,
                   (is_initial ? "this initial value, which is of the same frame, closes a cycle: " + path +
                                     "; expected one that does not depend on '" + leaf(cycle[0]).name + "'"
                               : "this closes a cycle: " + path + "; expected a \"delay\" on one of these edges"),
                   leaf(cycle[0]).scope->included_from());
      return;
    }
}

class Builder {
 public:
  Builder(const Unfolded& graph, Diagnostics& errors) : graph_(graph), errors_(errors), node_of_(graph.leaves.size(), -1) {}

  std::shared_ptr<Graph> run(const Connections& connections, const std::vector<bool>& left_out) {
    const Dependencies needs = dependencies(graph_, connections);
    const std::vector<int> order = sort_topologically(needs);
    if (order.size() < needs.size())
      for (const std::vector<int>& cycle : find_cycles(needs)) tell_cycle(graph_, connections, cycle, errors_);
    // Passes are created even when there are other errors, so that what they refuse is told in the same go.
    std::vector<std::shared_ptr<const PassInstance>> instances;
    for (const Leaf& leaf : graph_.leaves) instances.push_back(create(leaf));
    if (!errors_.empty()) return nullptr;

    const Document& document = *graph_.root.document;
    result_->name = document.name, result_->doc = document.doc, result_->file = document.source->name;
    result_->inputs = document.inputs;
    for (const int index : order) {
      const auto i = static_cast<std::size_t>(index);
      if (left_out[i]) continue;
      node_of_[i] = static_cast<int>(result_->nodes.size());
      add_node(graph_.leaves[i], std::move(instances[i]));
      for (const Arrival* reset : resets_of(graph_.leaves[i], connections)) add_reset(reset->edge.from);
    }
    for (Node& node : result_->nodes) {
      for (std::vector<Edge>& port : node.inputs)
        for (Edge& edge : port) renumber(edge.from), renumber(edge.initial.endpoint);
      for (Endpoint& reset : node.resets) renumber(reset);
    }
    for (std::size_t i = 0; i < document.outputs.size(); ++i)
      add_output({document.outputs[i].name.text, connections.outputs[i].edge.from, document.outputs[i].name.where},
                 result_->outputs);
    for (const GraphOutput& output : connections.subgraph_outputs) add_output(output, result_->subgraph_outputs);
    return std::move(result_);
  }

 private:
  std::shared_ptr<const PassInstance> create(const Leaf& leaf) {
    if (!leaf.pass || leaf.params_are_broken) return nullptr;
    std::vector<ParamValue> values;
    for (std::uint32_t i = 0; i < leaf.pass->param_count; ++i)
      values.push_back(leaf.params[i].value ? *leaf.params[i].value : default_value(leaf.param(i)));
    try {
      return std::make_shared<const PassInstance>(*leaf.pass, std::move(values));
    } catch (const Error& error) {
      const std::string prefix = error.where() + ": ", what = error.what();
      const std::string words = what.rfind(prefix, 0) == 0 ? what.substr(prefix.size()) : what;
      errors_.error(leaf.written->params_where, "the pass '" + std::string(leaf.pass->id) + "' refuses its parameters: " + words,
                    leaf.scope->included_from());
      return nullptr;
    }
  }

  void add_node(const Leaf& leaf, std::shared_ptr<const PassInstance> instance) {
    Node& node = result_->nodes.emplace_back();
    node.name = leaf.name, node.pass = leaf.pass, node.instance = std::move(instance);
    node.where = leaf.written->name.where, node.doc = leaf.written->doc;
    node.inputs.resize(leaf.inputs.size());
    for (std::size_t i = 0; i < leaf.inputs.size(); ++i)
      for (const Arrival& arrival : leaf.inputs[i]) node.inputs[i].push_back(arrival.edge);
  }

  // To the node that was added last, unless what yields it was left out, or it is there already.
  void add_reset(const Endpoint& from) {
    std::vector<Endpoint>& resets = result_->nodes.back().resets;
    const bool is_left_out = from.node >= 0 && node_of_[static_cast<std::size_t>(from.node)] < 0;
    if (!is_left_out && std::ranges::find(resets, from) == resets.end()) resets.push_back(from);
  }

  // From an index into the leaves to one into the nodes. What was left out is not referred to any more.
  void renumber(Endpoint& endpoint) const {
    if (endpoint.node >= 0) endpoint.node = node_of_[static_cast<std::size_t>(endpoint.node)];
  }
  void add_output(GraphOutput output, std::vector<GraphOutput>& outputs) const {
    const bool is_input = output.from.node < 0;
    renumber(output.from);
    if (is_input || output.from.node >= 0) outputs.push_back(std::move(output));
  }

  const Unfolded& graph_;
  Diagnostics& errors_;
  std::vector<int> node_of_;  // for each leaf; -1 when it was left out
  std::shared_ptr<Graph> result_ = std::make_shared<Graph>();
};

}  // namespace

std::shared_ptr<Graph> build(const Unfolded& graph, const Connections& connections, const std::vector<bool>& left_out,
                             Diagnostics& errors) {
  return Builder(graph, errors).run(connections, left_out);
}

}  // namespace quell::detail
