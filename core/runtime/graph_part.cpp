#include "quell/runtime/graph_part.h"

#include <map>

namespace quell {
namespace {

class Taker {
 public:
  Taker(const Graph& whole, const std::function<bool(const Endpoint&)>& is_known)
      : whole_(whole), is_known_(is_known), needed_(whole.nodes.size(), false), node_of_(whole.nodes.size(), -1) {}

  GraphPart run(const std::vector<PlannedResult>& results) {
    for (const PlannedResult& result : results) need(result.from);
    while (!to_visit_.empty()) {
      const Node& node = whole_.nodes[to_visit_.back()];
      to_visit_.pop_back();
      for (const std::vector<Edge>& port : node.inputs)
        for (const Edge& edge : port) {
          need(edge.from);
          if (edge.initial.kind == Initial::Kind::endpoint) need(edge.initial.endpoint);
        }
      for (const Endpoint& reset : node.resets) need(reset);
    }
    return build(results);
  }

 private:
  void need(const Endpoint& endpoint) {
    if (endpoint.node < 0) return;
    const auto node = static_cast<std::size_t>(endpoint.node);
    if (is_known_(endpoint)) {
      inputs_.try_emplace(endpoint, -1);
    } else if (!needed_[node]) {
      needed_[node] = true;
      to_visit_.push_back(node);
    }
  }

  GraphPart build(const std::vector<PlannedResult>& results) {
    GraphPart part;
    const auto graph = std::make_shared<Graph>();
    graph->name = whole_.name, graph->doc = whole_.doc, graph->file = whole_.file;
    graph->inputs = whole_.inputs;
    for (auto& [endpoint, input] : inputs_) {
      input = static_cast<int>(graph->inputs.size());
      graph->inputs.push_back({whole_.describe(endpoint), whole_.type(endpoint), false, "", {}});
      part.fed.push_back(endpoint);
    }
    for (std::size_t i = 0; i < whole_.nodes.size(); ++i) {
      if (!needed_[i]) continue;
      node_of_[i] = static_cast<int>(part.nodes.size());
      part.nodes.push_back(static_cast<int>(i));
      graph->nodes.push_back(whole_.nodes[i]);
    }
    for (Node& node : graph->nodes) {
      for (std::vector<Edge>& port : node.inputs)
        for (Edge& edge : port) {
          edge.from = translate(edge.from);
          if (edge.initial.kind == Initial::Kind::endpoint) edge.initial.endpoint = translate(edge.initial.endpoint);
        }
      for (Endpoint& reset : node.resets) reset = translate(reset);
    }
    for (const PlannedResult& result : results) graph->outputs.push_back({result.name, translate(result.from), {}});
    part.graph = graph;
    return part;
  }

  Endpoint translate(const Endpoint& endpoint) const {
    if (endpoint.node < 0) return endpoint;
    if (const auto input = inputs_.find(endpoint); input != inputs_.end()) return {-1, input->second, 0};
    return {node_of_[static_cast<std::size_t>(endpoint.node)], endpoint.port, endpoint.item};
  }

  const Graph& whole_;
  const std::function<bool(const Endpoint&)>& is_known_;
  std::vector<bool> needed_;
  std::vector<std::size_t> to_visit_;
  std::map<Endpoint, int> inputs_;  // what is fed, and as which input
  std::vector<int> node_of_;
};

}  // namespace

GraphPart take_part(const Graph& whole, const std::vector<PlannedResult>& results,
                    const std::function<bool(const Endpoint&)>& is_known) {
  return Taker(whole, is_known).run(results);
}

}  // namespace quell
