// The maximum cycle ratio, against the enumeration of all cycles; and the slowest cycles of a plan's loops.
#include "quell/graph/cycle_ratio.h"

#include <limits>
#include <random>

#include "quell/graph/slowest_cycles.h"
#include "tests/core/graph/plan_graphs.h"

namespace quell::test {
namespace {

using planning::DelayedArc;
using planning::find_largest_ratio;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Arcs = std::vector<DelayedArc>;
using Weights = std::vector<std::int64_t>;

struct Sums {
  std::int64_t weight = 0, delay = 0;
  bool operator<(const Sums& other) const { return weight * other.delay < other.weight * delay; }
};

Sums sums_of(const std::vector<int>& cycle, const Weights& weights, const Arcs& arcs) {
  Sums sums;
  for (const int arc : cycle) {
    sums.weight += weights[static_cast<std::size_t>(arcs[static_cast<std::size_t>(arc)].from)];
    sums.delay += arcs[static_cast<std::size_t>(arc)].delay;
  }
  return sums;
}

/// Every path from `start` over higher nodes that are not on it yet; where it returns to the start, that is a cycle.
void follow(int start, int node, std::vector<int>& path, const Weights& weights, const Arcs& arcs, std::vector<Sums>& found) {
  for (int i = 0; i < static_cast<int>(arcs.size()); ++i) {
    const DelayedArc& arc = arcs[static_cast<std::size_t>(i)];
    const auto leaves = [&](int taken) { return arcs[static_cast<std::size_t>(taken)].from == arc.to; };
    if (arc.from != node || arc.to < start) continue;
    path.push_back(i);
    if (arc.to == start)
      found.push_back(sums_of(path, weights, arcs));
    else if (std::none_of(path.begin(), path.end(), leaves))
      follow(start, arc.to, path, weights, arcs, found);
    path.pop_back();
  }
}

std::vector<Sums> all_cycles(const Weights& weights, const Arcs& arcs) {
  std::vector<Sums> found;
  std::vector<int> path;
  for (int start = 0; start < static_cast<int>(weights.size()); ++start) follow(start, start, path, weights, arcs, found);
  return found;
}

void expect_cycle(const std::vector<int>& cycle, const Arcs& arcs) {
  for (std::size_t i = 0; i < cycle.size(); ++i) {
    const DelayedArc& arc = arcs[static_cast<std::size_t>(cycle[i])];
    EXPECT_EQ(arc.to, arcs[static_cast<std::size_t>(cycle[(i + 1) % cycle.size()])].from);
    EXPECT_GE(arc.from, arcs[static_cast<std::size_t>(cycle.front())].from);
  }
}

TEST(CycleRatio, IsThatOfTheBestOfAllCyclesOfRandomGraphs) {
  std::mt19937 random(7);  // NOLINT: the same graphs every time
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  int with_cycles = 0;
  for (int round = 0; round < 4000; ++round) {
    const int nodes = 1 + below(6);
    Weights weights;
    for (int i = 0; i < nodes; ++i) weights.push_back(below(3) == 0 ? 0 : below(20));
    Arcs arcs;
    for (int i = below(3 * nodes); i >= 0; --i) {
      const int from = below(nodes), to = below(nodes);
      arcs.push_back({from, to, from < to ? below(3) : 1 + below(4)});
    }
    const std::vector<Sums> cycles = all_cycles(weights, arcs);
    const std::vector<int> found = find_largest_ratio(weights, arcs);
    ASSERT_EQ(found.empty(), cycles.empty()) << "round " << round;
    if (cycles.empty()) continue;
    ++with_cycles;
    expect_cycle(found, arcs);
    const Sums best = *std::max_element(cycles.begin(), cycles.end()), got = sums_of(found, weights, arcs);
    ASSERT_EQ(got.weight * best.delay, best.weight * got.delay) << "round " << round;
  }
  EXPECT_GT(with_cycles, 2000);
}

TEST(CycleRatio, TellsCyclesApartThatFloatingPointCannot) {
  // 2^49 / (2^31 - 1) against (2^49 + 1) / (2^31 - 1): a difference in the last of 49 bits, under the largest delay.
  constexpr int kLongest = std::numeric_limits<int>::max();
  const Weights weights{std::int64_t{1} << 49, (std::int64_t{1} << 49) + 1, (std::int64_t{1} << 49) - 1};
  EXPECT_THAT(find_largest_ratio(weights, {{0, 0, kLongest}, {1, 1, kLongest}, {2, 2, kLongest}}), ElementsAre(1));
}

TEST(CycleRatio, TakesTheShortestOfParallelArcs) {
  EXPECT_THAT(find_largest_ratio({3, 4}, {{0, 1, 2}, {0, 1, 0}, {0, 1, 1}, {1, 0, 5}, {1, 0, 3}}), ElementsAre(1, 4));
}

TEST(CycleRatio, FindsCyclesThatTakeNoTime) {
  EXPECT_THAT(find_largest_ratio({0, 0, 0}, {{1, 2, 0}, {2, 1, 1}}), ElementsAre(0, 1));
  EXPECT_THAT(find_largest_ratio({1, 1}, {{0, 1, 0}}), IsEmpty());
  EXPECT_THAT(find_largest_ratio({}, {}), IsEmpty());
}

TEST(CycleRatio, CopesWithThousandsOfNodesAndTheLargestWeights) {
  // A ring whose arcs are in the worst order, and chords that make more, but lesser, cycles.
  constexpr int kNodes = 3000;
  const Weights weights(kNodes, std::int64_t{1} << 50);
  Arcs arcs{{kNodes - 1, 0, 1}};
  for (int i = kNodes - 2; i >= 0; --i) arcs.push_back({i, i + 1, 0});
  for (int i = 0; i + 7 < kNodes; i += 5) arcs.push_back({i, i + 7, std::numeric_limits<int>::max() - i});
  const std::vector<int> cycle = find_largest_ratio(weights, arcs);
  EXPECT_EQ(cycle.size(), static_cast<std::size_t>(kNodes));
  expect_cycle(cycle, arcs);
}

const InputShapes kColor64{{"color", image(64, 32)}};

TEST(SlowestCycles, AreNotTheSumOfALoop) {
  // One loop of two cycles: a, b in 3 frames and a, c in 2.
  const auto graph = Builder()
                         .input("color")
                         .node("before", mix(), {{"color", {"color"}}})
                         .node("a", mix(), {{"color", {"before.color"}}, {"more", {Wire("b.color", 3), Wire("c.color", 2)}}})
                         .node("b", mix(), {{"color", {"a.color"}}})
                         .node("c", mix(), {{"color", {"a.color"}}})
                         .node("after", mix(), {{"color", {"b.color"}}, {"more", {"c.color"}}})
                         .output("after.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  const std::vector<Cycle> b = find_slowest_cycles(plan, {9, 1, 5, 2.5, 9});
  ASSERT_EQ(b.size(), 1u);
  EXPECT_THAT(b[0].nodes, ElementsAre(1, 2));
  EXPECT_EQ(b[0].delay, 3);
  EXPECT_DOUBLE_EQ(b[0].seconds, 6);
  EXPECT_DOUBLE_EQ(b[0].seconds_per_frame(), 2);
  const std::vector<Cycle> c = find_slowest_cycles(plan, {9, 1, 5, 3.5, 9});
  EXPECT_THAT(c[0].nodes, ElementsAre(1, 3));
  EXPECT_DOUBLE_EQ(c[0].seconds_per_frame(), 2.25);
}

TEST(SlowestCycles, AreToldForEachLoop) {
  const auto graph = Builder()
                         .input("color")
                         .node("idle", mix(), {{"color", {"color"}}})
                         .node("a", blend(), {{"color", {"color"}}, {"history", {Wire("b.color", 1)}}})
                         .node("b", mix(), {{"color", {"a.color"}}})
                         .node("c", blend(), {{"color", {"b.color"}}, {"history", {Wire("c.color", 4)}}})
                         .output("c.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  ASSERT_EQ(plan.nodes.size(), 3u) << "'idle' does not run, so that places in the plan and in the graph differ";
  const std::vector<Cycle> cycles = find_slowest_cycles(plan, {0.25, 0.5, 8});
  ASSERT_EQ(cycles.size(), 2u);
  EXPECT_THAT(cycles[0].nodes, ElementsAre(1, 2));
  EXPECT_DOUBLE_EQ(cycles[0].seconds_per_frame(), 0.75);
  EXPECT_THAT(cycles[1].nodes, ElementsAre(3));
  EXPECT_DOUBLE_EQ(cycles[1].seconds_per_frame(), 2);
}

TEST(SlowestCycles, OfNoTimeAreStillTold) {
  const auto graph = Builder()
                         .input("color")
                         .node("a", blend(), {{"color", {"color"}}, {"history", {Wire("a.color", 1)}}})
                         .output("a.color")
                         .build();
  const std::vector<Cycle> cycles = find_slowest_cycles(make_plan(graph, kColor64), {0});
  ASSERT_EQ(cycles.size(), 1u);
  EXPECT_THAT(cycles[0].nodes, ElementsAre(0));
  EXPECT_EQ(cycles[0].seconds_per_frame(), 0);
}

}  // namespace
}  // namespace quell::test
