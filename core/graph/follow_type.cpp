#include "quell/graph/follow_type.h"

#include <bit>
#include <set>
#include <vector>

namespace quell::detail {
namespace {

PortType first_of(Types types) { return static_cast<PortType>(std::countr_zero(types)); }

class Follower {
 public:
  explicit Follower(const FollowedGraph& graph) : graph_(graph) {}

  std::optional<PortType> follow(Endpoint endpoint) {
    std::vector<Step> steps;
    while (seen_.insert(endpoint).second) {
      if (endpoint.node < 0) return graph_.input_type(endpoint.port);
      const quell_pass_desc* pass = graph_.pass(endpoint.node);
      if (!pass) return std::nullopt;
      const quell_port_desc& output = *QUELL_AT(quell_port_desc, pass->outputs, endpoint.port);
      if (output.same_as < 0) return first_of(output.types);
      const Types accepted = QUELL_AT(quell_port_desc, pass->inputs, output.same_as)->types;
      const FollowedSource source = graph_.source(endpoint.node, output.same_as, endpoint.item);
      if (source.is_broken || source.type) return source.type;
      if (!source.edge) return first_of(accepted);
      steps.push_back({endpoint, source.edge, accepted});
      endpoint = source.edge->from;
    }
    return settle_loop(steps, endpoint);
  }

 private:
  struct Step {
    Endpoint endpoint;
    const Edge* edge;
    Types accepted;
  };

  // `steps` leads into a loop that `again` is part of; or, from an initial value, back to where the walk has been before.
  std::optional<PortType> settle_loop(const std::vector<Step>& steps, const Endpoint& again) {
    std::size_t first = steps.size();
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (steps[i].endpoint == again) first = i;
    if (first == steps.size()) return std::nullopt;
    Types accepted = ~Types{0};
    for (std::size_t i = first; i < steps.size(); ++i) {
      const Edge& edge = *steps[i].edge;
      if (edge.delay != 0 && edge.initial.kind == Initial::Kind::endpoint)
        if (const std::optional<PortType> type = follow(edge.initial.endpoint)) return type;
      accepted &= steps[i].accepted;
    }
    return first_of(accepted ? accepted : steps[first].accepted);
  }

  const FollowedGraph& graph_;
  std::set<Endpoint> seen_;
};

}  // namespace

std::optional<PortType> follow_type(const FollowedGraph& graph, const Endpoint& endpoint) {
  return Follower(graph).follow(endpoint);
}

}  // namespace quell::detail
