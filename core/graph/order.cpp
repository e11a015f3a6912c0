#include "quell/graph/order.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <queue>

namespace quell::detail {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// The shortest cycle through `start`; empty when none has fewer than `limit` nodes.
std::vector<int> shortest_cycle_through(const Dependencies& needs, int start, std::size_t limit) {
  std::vector<int> reached_from(needs.size(), -1);
  std::vector<std::size_t> length(needs.size(), 0);
  std::deque<int> queue{start};
  while (!queue.empty()) {
    const int node = queue.front();
    queue.pop_front();
    if (length[at(node)] + 1 >= limit) return {};
    for (const int next : needs[at(node)]) {
      if (next == start) {
        std::vector<int> cycle;
        for (int step = node; step != start; step = reached_from[at(step)]) cycle.push_back(step);
        cycle.push_back(start);
        std::reverse(cycle.begin(), cycle.end());
        return cycle;
      }
      if (reached_from[at(next)] >= 0) continue;
      reached_from[at(next)] = node;
      length[at(next)] = length[at(node)] + 1;
      queue.push_back(next);
    }
  }
  return {};
}

// Groups of nodes that reach each other (Kosaraju: the order of leaving a depth-first walk, then a walk against the edges).
// Walks on from `start`, and adds every node that was not seen before when leaving it. Without recursion: graphs may be long
// chains.
void walk(const Dependencies& edges, int start, std::vector<bool>& seen, std::vector<int>& left) {
  if (seen[at(start)]) return;
  std::vector<std::pair<int, std::size_t>> stack{{start, 0}};
  seen[at(start)] = true;
  while (!stack.empty()) {
    auto& [node, edge] = stack.back();
    if (edge == edges[at(node)].size()) {
      left.push_back(node);
      stack.pop_back();
      continue;
    }
    const int next = edges[at(node)][edge++];
    if (seen[at(next)]) continue;
    seen[at(next)] = true;
    stack.emplace_back(next, 0);
  }
}

Dependencies reverse(const Dependencies& edges) {
  Dependencies reversed(edges.size());
  for (std::size_t node = 0; node < edges.size(); ++node)
    for (const int other : edges[node]) reversed[at(other)].push_back(static_cast<int>(node));
  return reversed;
}

// Groups of nodes that reach each other (Kosaraju: the order of leaving a depth-first walk, then a walk against the edges).
std::vector<std::vector<int>> find_groups(const Dependencies& needs) {
  std::vector<int> left;
  std::vector<bool> seen(needs.size(), false);
  for (std::size_t node = 0; node < needs.size(); ++node) walk(needs, static_cast<int>(node), seen, left);
  const Dependencies needed_by = reverse(needs);
  std::vector<std::vector<int>> groups;
  seen.assign(needs.size(), false);
  for (auto node = left.rbegin(); node != left.rend(); ++node) {
    std::vector<int> members;
    walk(needed_by, *node, seen, members);
    std::sort(members.begin(), members.end());
    if (!members.empty()) groups.push_back(std::move(members));
  }
  std::sort(groups.begin(), groups.end());
  return groups;
}

}  // namespace

std::vector<int> sort_topologically(const Dependencies& needs) {
  const Dependencies needed_by = reverse(needs);
  std::vector<std::size_t> missing(needs.size());
  std::priority_queue<int, std::vector<int>, std::greater<>> ready;
  for (std::size_t node = 0; node < needs.size(); ++node) {
    missing[node] = needs[node].size();
    if (missing[node] == 0) ready.push(static_cast<int>(node));
  }
  std::vector<int> order;
  while (!ready.empty()) {
    order.push_back(ready.top());
    ready.pop();
    for (const int next : needed_by[at(order.back())])
      if (--missing[at(next)] == 0) ready.push(next);
  }
  return order;
}

std::vector<std::vector<int>> find_cycles(const Dependencies& needs) {
  std::vector<std::vector<int>> cycles;
  for (const std::vector<int>& group : find_groups(needs)) {
    std::vector<int> shortest;
    std::size_t limit = group.size() + 1;
    for (const int start : group) {
      const std::vector<int> cycle = shortest_cycle_through(needs, start, limit);
      if (cycle.empty()) continue;
      shortest = cycle;
      limit = cycle.size();
    }
    if (!shortest.empty()) cycles.push_back(std::move(shortest));
  }
  return cycles;
}

}  // namespace quell::detail
