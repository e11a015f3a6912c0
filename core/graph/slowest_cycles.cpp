#include "quell/graph/slowest_cycles.h"

#include <algorithm>
#include <cmath>

#include "quell/graph/cycle_ratio.h"
#include "quell/graph/plan_presence.h"

namespace quell {
namespace {

using namespace planning;  // NOLINT: this file is the box's own

std::size_t at(int index) { return static_cast<std::size_t>(index); }

std::int64_t to_nanoseconds(double seconds) {
  constexpr double kMost = 1LL << 50;  // as far as find_largest_ratio() goes
  return std::llround(std::clamp(seconds * 1e9, 0.0, kMost));
}

// Takes each loop as a graph of its own, whose nodes are counted in the loop's order.
class Loops {
 public:
  Loops(const Plan& plan, const std::vector<double>& node_seconds)
      : graph_(*plan.graph),
        presence_(graph_, plan.inputs),
        seconds_(graph_.nodes.size(), 0.0),
        places_(graph_.nodes.size(), kElsewhere) {
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) seconds_[at(plan.nodes[i].node)] = node_seconds[i];
  }

  Cycle find_slowest(const PlannedLoop& loop) {
    std::vector<std::int64_t> weights;
    for (const int node : loop.nodes) weights.push_back(to_nanoseconds(seconds_[at(node)]));
    const std::vector<DelayedArc> arcs = find_arcs(loop);
    Cycle cycle;
    for (const int arc : find_largest_ratio(weights, arcs)) {
      cycle.nodes.push_back(loop.nodes[at(arcs[at(arc)].from)]);
      cycle.seconds += seconds_[at(cycle.nodes.back())];
      cycle.delay += arcs[at(arc)].delay;
    }
    return cycle;
  }

 private:
  static constexpr int kElsewhere = -1;

  std::vector<DelayedArc> find_arcs(const PlannedLoop& loop) {
    for (std::size_t i = 0; i < loop.nodes.size(); ++i) places_[at(loop.nodes[i])] = static_cast<int>(i);
    std::vector<DelayedArc> arcs;
    for (const int reader : loop.nodes)
      for (const Read& read : reads(graph_.nodes[at(reader)], presence_))
        if (read.from.node >= 0 && places_[at(read.from.node)] != kElsewhere)
          arcs.push_back({places_[at(read.from.node)], places_[at(reader)], read.delay});
    for (const int node : loop.nodes) places_[at(node)] = kElsewhere;
    return arcs;
  }

  const Graph& graph_;
  Presence presence_;
  std::vector<double> seconds_;  // of each node of the graph
  std::vector<int> places_;      // of each node of the graph in the loop at hand
};

}  // namespace

std::vector<Cycle> find_slowest_cycles(const Plan& plan, const std::vector<double>& node_seconds) {
  Loops loops(plan, node_seconds);
  std::vector<Cycle> cycles;
  for (const PlannedLoop& loop : plan.loops) cycles.push_back(loops.find_slowest(loop));
  return cycles;
}

}  // namespace quell
