#include "quell/graph/plan_loops.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <queue>
#include <utility>

namespace quell::planning {
namespace {

struct Arc {
  int to;
  int delay;
};
// For each node that runs, in the plan's order.
using Arcs = std::vector<std::vector<Arc>>;

std::size_t at(int position) { return static_cast<std::size_t>(position); }

// Arcs from producers to consumers, or backwards.
Arcs find_arcs(const Plan& plan, const Presence& presence, bool backwards) {
  std::vector<int> positions(plan.graph->nodes.size(), -1);
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) positions[at(plan.nodes[i].node)] = static_cast<int>(i);
  Arcs arcs(plan.nodes.size());
  for (int consumer = 0; consumer < static_cast<int>(plan.nodes.size()); ++consumer)
    for (const Read& read : reads(plan.graph->nodes[at(plan.nodes[at(consumer)].node)], presence)) {
      if (read.from.node < 0) continue;
      const int producer = positions[at(read.from.node)];
      if (backwards)
        arcs[at(consumer)].push_back({producer, read.delay});
      else
        arcs[at(producer)].push_back({consumer, read.delay});
    }
  return arcs;
}

// Appends what can be reached from `start` to `order`, each node after all that it leads to. No recursion: graphs may be deep.
void visit(int start, const Arcs& arcs, std::vector<bool>& seen, std::vector<int>& order) {
  std::vector<std::pair<int, std::size_t>> path{{start, 0}};
  seen[at(start)] = true;
  while (!path.empty()) {
    auto& [node, next] = path.back();
    if (next == arcs[at(node)].size()) {
      order.push_back(node);
      path.pop_back();
      continue;
    }
    const int to = arcs[at(node)][next++].to;
    if (seen[at(to)]) continue;
    seen[at(to)] = true;
    path.emplace_back(to, 0);
  }
}

// Strongly connected components (Kosaraju: visit all, then visit the reversed graph from the last finished on).
std::vector<std::vector<int>> find_components(const Arcs& arcs, const Arcs& backwards) {
  std::vector<bool> seen(arcs.size(), false);
  std::vector<int> order;
  for (int node = 0; node < static_cast<int>(arcs.size()); ++node)
    if (!seen[at(node)]) visit(node, arcs, seen, order);
  std::reverse(order.begin(), order.end());
  seen.assign(arcs.size(), false);
  std::vector<std::vector<int>> components;
  for (const int node : order)
    if (!seen[at(node)]) visit(node, backwards, seen, components.emplace_back());
  for (std::vector<int>& component : components) std::sort(component.begin(), component.end());
  std::sort(components.begin(), components.end());
  return components;
}

constexpr std::int64_t kUnreached = std::numeric_limits<std::int64_t>::max();

// Smallest delay from `from` to `to` without leaving the component (Dijkstra).
std::int64_t smallest_delay(int from, int to, const Arcs& arcs, const std::vector<int>& component) {
  std::vector<std::int64_t> delays(arcs.size(), kUnreached);
  std::priority_queue<std::pair<std::int64_t, int>, std::vector<std::pair<std::int64_t, int>>, std::greater<>> open;
  delays[at(from)] = 0;
  open.emplace(0, from);
  while (!open.empty()) {
    const auto [delay, node] = open.top();
    open.pop();
    if (node == to) return delay;
    if (delay > delays[at(node)]) continue;
    for (const Arc& arc : arcs[at(node)]) {
      if (!std::binary_search(component.begin(), component.end(), arc.to) || delay + arc.delay >= delays[at(arc.to)]) continue;
      delays[at(arc.to)] = delay + arc.delay;
      open.emplace(delays[at(arc.to)], arc.to);
    }
  }
  return kUnreached;
}

// Every cycle holds a delayed arc, since the undelayed ones have none: the cheapest way back to the start of each is enough.
std::int64_t smallest_cycle(const Arcs& arcs, const std::vector<int>& component) {
  std::int64_t smallest = kUnreached;
  for (const int node : component)
    for (const Arc& arc : arcs[at(node)]) {
      if (arc.delay == 0 || arc.delay >= smallest || !std::binary_search(component.begin(), component.end(), arc.to)) continue;
      const std::int64_t back = smallest_delay(arc.to, node, arcs, component);
      if (back != kUnreached) smallest = std::min(smallest, arc.delay + back);
    }
  return smallest;
}

}  // namespace

std::vector<PlannedLoop> find_loops(const Plan& plan, const Presence& presence) {
  const Arcs arcs = find_arcs(plan, presence, false);
  const Arcs backwards = find_arcs(plan, presence, true);
  std::vector<PlannedLoop> loops;
  for (const std::vector<int>& component : find_components(arcs, backwards)) {
    const std::int64_t delay = smallest_cycle(arcs, component);
    if (delay == kUnreached) continue;
    PlannedLoop& loop = loops.emplace_back();
    loop.delay = static_cast<int>(std::min<std::int64_t>(delay, std::numeric_limits<int>::max()));
    for (const int position : component) loop.nodes.push_back(plan.nodes[at(position)].node);
  }
  return loops;
}

}  // namespace quell::planning
