// Topological order and cycles, against definitions applied by brute force to small random graphs.
#include "quell/graph/order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace quell::detail {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Dependencies random_graph(std::mt19937& random, int nodes, int edges) {
  Dependencies needs(static_cast<std::size_t>(nodes));
  std::uniform_int_distribution<int> any(0, nodes - 1);
  for (int i = 0; i < edges; ++i) needs[static_cast<std::size_t>(any(random))].push_back(any(random));
  return needs;
}

// Fewest steps from each node to each other (Floyd and Warshall); on the diagonal, the shortest cycle through a node.
std::vector<std::vector<int>> distances(const Dependencies& needs) {
  const std::size_t n = needs.size();
  std::vector<std::vector<int>> steps(n, std::vector<int>(n, 1'000'000));
  for (std::size_t i = 0; i < n; ++i)
    for (const int j : needs[i]) steps[i][static_cast<std::size_t>(j)] = 1;
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) steps[i][j] = std::min(steps[i][j], steps[i][k] + steps[k][j]);
  return steps;
}

TEST(Order, PutsEveryNodeAfterWhatItNeedsAndElseTheSmallestFirst) {
  EXPECT_THAT(sort_topologically({{}, {}, {}}), ElementsAre(0, 1, 2));
  EXPECT_THAT(sort_topologically({{2}, {}, {1}}), ElementsAre(1, 2, 0));
  EXPECT_THAT(sort_topologically({{3, 3}, {}, {}, {2}}), ElementsAre(1, 2, 3, 0));
  EXPECT_THAT(sort_topologically({}), IsEmpty());
}

TEST(Order, LeavesOutWhatIsInOrBehindACycle) { EXPECT_THAT(sort_topologically({{1}, {0}, {0}, {}}), ElementsAre(3)); }

TEST(Order, FindsACycleOfOneNode) { EXPECT_THAT(find_cycles({{}, {1}}), ElementsAre(ElementsAre(1))); }

TEST(Order, FindsOneCycleForEachGroup) {
  EXPECT_THAT(find_cycles({{1}, {2}, {0, 1}, {4}, {3}}), ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4)));
}

TEST(Order, OfRandomGraphsIsRight) {
  std::mt19937 random(1);
  for (int round = 0; round < 500; ++round) {
    const Dependencies needs = random_graph(random, 9, 3 + round % 15);
    const auto steps = distances(needs);
    const std::vector<int> order = sort_topologically(needs);
    for (std::size_t node = 0; node < needs.size(); ++node) {
      const auto place = std::find(order.begin(), order.end(), static_cast<int>(node));
      // A node has no place exactly when it needs, through others, one that needs itself.
      bool reaches_cycle = steps[node][node] < 1'000'000;
      for (std::size_t other = 0; other < needs.size(); ++other)
        reaches_cycle = reaches_cycle || (steps[node][other] < 1'000'000 && steps[other][other] < 1'000'000);
      EXPECT_EQ(place == order.end(), reaches_cycle);
      if (place == order.end()) continue;
      for (const int needed : needs[node]) EXPECT_LT(std::find(order.begin(), order.end(), needed), place);
    }
  }
}

TEST(Order, CyclesOfRandomGraphsAreTheShortestOfTheirGroups) {
  std::mt19937 random(2);
  for (int round = 0; round < 500; ++round) {
    const Dependencies needs = random_graph(random, 9, 5 + round % 20);
    const auto steps = distances(needs);
    std::vector<bool> is_covered(needs.size(), false);
    for (const std::vector<int>& cycle : find_cycles(needs)) {
      EXPECT_EQ(cycle.front(), *std::min_element(cycle.begin(), cycle.end()));
      for (std::size_t i = 0; i < cycle.size(); ++i) {
        const auto& next = needs[static_cast<std::size_t>(cycle[i])];
        EXPECT_NE(std::find(next.begin(), next.end(), cycle[(i + 1) % cycle.size()]), next.end());
      }
      const auto start = static_cast<std::size_t>(cycle.front());
      int shortest = 1'000'000;
      for (std::size_t node = 0; node < needs.size(); ++node) {
        if (steps[start][node] == 1'000'000 || steps[node][start] == 1'000'000) continue;
        shortest = std::min(shortest, steps[node][node]);
        EXPECT_FALSE(is_covered[node]) << "two cycles for one group";
        is_covered[node] = true;
      }
      EXPECT_EQ(static_cast<int>(cycle.size()), shortest);
    }
    for (std::size_t node = 0; node < needs.size(); ++node) EXPECT_EQ(is_covered[node], steps[node][node] < 1'000'000);
  }
}

}  // namespace
}  // namespace quell::detail
