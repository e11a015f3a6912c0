#include "quell/graph/cycle_ratio.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace quell::planning {
namespace {

// Sums over a million nodes of weight 2^50, times delays of 2^31 over as many arcs, stay below 2^127.
__extension__ using Wide = __int128;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

struct Ratio {
  Wide weight;
  Wide delay;
};

// Looks for a cycle that beats a ratio: one around which the sum of (weight - ratio * delay) is above 0. All in whole numbers,
// since with rounding a cycle could seem better than itself.
class Search {
 public:
  Search(const std::vector<std::int64_t>& weights, const std::vector<DelayedArc>& arcs) : weights_(weights), arcs_(arcs) {}

  // Bellman and Ford's longest paths from anywhere. Among the arcs that last made a path longer, a cycle is one that gains; there
  // is one as soon as paths grow without end.
  std::vector<int> beat(const Ratio& ratio) {
    lengths_.assign(weights_.size(), 0);
    came_by_.assign(weights_.size(), kNowhere);
    while (lengthen(ratio))
      if (const int node = find_node_on_cycle(); node != kNowhere) return cycle_through(node);
    return {};
  }

 private:
  static constexpr int kNowhere = -1;

  bool lengthen(const Ratio& ratio) {
    bool changed = false;
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      const DelayedArc& arc = arcs_[i];
      const Wide length = lengths_[at(arc.from)] + weights_[at(arc.from)] * ratio.delay - arc.delay * ratio.weight;
      if (length <= lengths_[at(arc.to)]) continue;
      lengths_[at(arc.to)] = length;
      came_by_[at(arc.to)] = static_cast<int>(i);
      changed = true;
    }
    return changed;
  }

  int before(int node) const { return came_by_[at(node)] == kNowhere ? kNowhere : arcs_[at(came_by_[at(node)])].from; }

  // Walks back from every node until a walk meets itself; where it meets an earlier one, there is nothing new.
  int find_node_on_cycle() {
    walks_.assign(weights_.size(), kNowhere);
    for (int start = 0; start < static_cast<int>(weights_.size()); ++start) {
      int node = start;
      for (; node != kNowhere && walks_[at(node)] == kNowhere; node = before(node)) walks_[at(node)] = start;
      if (node != kNowhere && walks_[at(node)] == start) return node;
    }
    return kNowhere;
  }

  std::vector<int> cycle_through(int node) const {
    std::vector<int> cycle;
    int place = node;
    do {
      cycle.push_back(came_by_[at(place)]);
      place = before(place);
    } while (place != node);
    std::reverse(cycle.begin(), cycle.end());
    return cycle;
  }

  const std::vector<std::int64_t>& weights_;
  const std::vector<DelayedArc>& arcs_;
  std::vector<Wide> lengths_;
  std::vector<int> came_by_;  // the last arc of the longest path to each node
  std::vector<int> walks_;    // the start of the walk that met each node first
};

}  // namespace

std::vector<int> find_largest_ratio(const std::vector<std::int64_t>& weights, const std::vector<DelayedArc>& arcs) {
  Search search(weights, arcs);
  Ratio best{-1, 1};  // any cycle has more, even one of weight 0
  std::vector<int> cycle;
  // Each cycle is better than the one before it, and there are finitely many.
  for (std::vector<int> better = search.beat(best); !better.empty(); better = search.beat(best)) {
    best = {0, 0};
    for (const int arc : better) {
      best.weight += weights[at(arcs[at(arc)].from)];
      best.delay += arcs[at(arc)].delay;
    }
    cycle = std::move(better);
  }
  const auto is_lower = [&](int a, int b) { return arcs[at(a)].from < arcs[at(b)].from; };
  std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end(), is_lower), cycle.end());
  return cycle;
}

}  // namespace quell::planning
