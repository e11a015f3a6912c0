// Random graphs over random frames: what comes out is what the graph's definition says, and the same bits under every schedule.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "tests/core/runtime/schedule_naive.h"

namespace quell::test {
namespace {

#ifdef __SANITIZE_THREAD__
constexpr int kBlocks = 4;
#else
constexpr int kBlocks = 8;
#endif
constexpr unsigned kGraphs = 200, kGraphsPerBlock = 25, kSettingsPerGraph = 4;

struct Case {
  Scene scene;
  TestGraph graph;
};

Case draw_case(unsigned seed) {
  Dice dice(seed + 1000);
  Scene scene = random_scene(dice);
  TestGraph graph = random_graph(seed, scene.frames);
  return {std::move(scene), std::move(graph)};
}

SessionOptions with_dumps(SessionOptions options, const TestGraph& graph) {
  for (const Place& dump : graph.dumps) options.dumps.push_back(graph.name(dump));
  return options;
}

std::vector<std::string> names(const Graph& graph) {
  std::vector<std::string> list;
  for (const Node& node : graph.nodes) list.push_back(node.name);
  return list;
}

std::vector<unsigned> seeds(int block) {
  std::vector<unsigned> list(kGraphsPerBlock);
  std::iota(list.begin(), list.end(), static_cast<unsigned>(block) * kGraphsPerBlock);
  return list;
}

/// What every other way of running has to equal.
Outcome run_alone(const std::shared_ptr<const Graph>& checked, const Scene& scene, const TestGraph& graph) {
  return run(checked, graph.inputs, scene, with_dumps(serial(), graph));
}

class RandomGraphs : public testing::TestWithParam<int> {};

TEST_P(RandomGraphs, YieldWhatTheirDefinitionSaysUnderEverySchedule) {
  for (const unsigned seed : seeds(GetParam())) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto [scene, graph] = draw_case(seed);
    const auto checked = load(graph);
    const Outcome want = run_alone(checked, scene, graph);
    expect_same(without_words(want), compute_naively(graph, scene, names(*checked)));
    for (unsigned k = 0; k < kSettingsPerGraph; ++k) {
      const Setting chosen = setting(static_cast<int>((seed + 5 * k) % kSettings));
      SCOPED_TRACE(describe(chosen));
      SessionOptions options = with_dumps(concurrent(chosen), graph);
      options.fuse = k % 4 != 3;
      expect_same(run(checked, graph.inputs, scene, options, (seed + k) % 3 == 0), want);
    }
    if (HasFailure()) {
      ADD_FAILURE() << to_json(graph, testing::TempDir());
      return;
    }
  }
}

TEST_P(RandomGraphs, YieldTheSameWhereSessionsGoOnWithWhatOthersHaveSaved) {
  for (const unsigned seed : seeds(GetParam())) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto [scene, graph] = draw_case(seed);
    const auto checked = load(graph);
    const Outcome want = run_alone(checked, scene, graph);
    Dice dice(seed);
    std::set<std::int64_t> last_frames;
    for (const std::int64_t frame : scene.frames)
      if (dice.chance(30)) last_frames.insert(frame);
    const Setting chosen = setting(static_cast<int>(seed % kSettings));
    const SessionOptions options = seed % 4 == 0 ? serial() : concurrent(chosen);
    expect_same(run_in_parts(checked, graph.inputs, scene, with_dumps(options, graph), last_frames), want);
  }
}

// Of an outcome, what frames yield that are not among these.
Outcome without(Outcome outcome, const std::set<std::int64_t>& frames) {
  std::erase_if(outcome.pictures, [&](const auto& entry) { return frames.contains(entry.first.second); });
  std::erase_if(outcome.reports, [&](const FrameReport& report) { return frames.contains(report.frame); });
  return outcome;
}

TEST_P(RandomGraphs, YieldTheSameWhereNothingButTheHistoryOfOtherFramesIsWanted) {
  for (const unsigned seed : seeds(GetParam())) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto [scene, graph] = draw_case(seed);
    const auto checked = load(graph);
    Dice dice(seed);
    std::set<std::int64_t> history_only;
    for (const std::int64_t frame : scene.frames)
      if (dice.chance(50)) history_only.insert(frame);
    const SessionOptions options = seed % 4 == 0 ? serial() : concurrent(setting(static_cast<int>(seed % kSettings)));
    const Outcome got =
        run_for_history(checked, graph.inputs, scene, with_dumps(options, graph), {history_only.begin(), history_only.end()});
    EXPECT_EQ(got.reports.size(), scene.frames.size());
    for (const auto& [key, pictured] : got.pictures) EXPECT_FALSE(history_only.contains(key.second)) << key.second;
    for (const FrameReport& report : got.reports)
      EXPECT_EQ(report.history_only, history_only.contains(report.frame)) << report.frame;
    expect_same(without(got, history_only), without(run_alone(checked, scene, graph), history_only));
  }
}

// So tall that fused nodes that run ahead have several bands, whose rows meet in windows.
Scene make_tall(Scene scene, Dice& dice) {
  scene.size = {dice.from(1, 5), dice.from(60, 400)};
  scene.frames.resize(4);
  return scene;
}

int count_turns_in_bands(const std::shared_ptr<const Graph>& checked, const TestGraph& graph, const Scene& scene) {
  PatternSource source(graph.inputs, scene);
  InputShapes shapes;
  for (const GraphInput& input : checked->inputs) shapes[input.name] = source.shape(input.name);
  const Plan plan = make_plan(checked, shapes);
  return static_cast<int>(std::ranges::count_if(plan.turns, [&](const PlannedTurn& turn) {
    return turn.is_fused() && std::ranges::max(turn.ahead) > 0 && turn.band < scene.size.height;
  }));
}

TEST_P(RandomGraphs, YieldTheSameFusedOrNotOverManyBands) {
  int turns_in_bands = 0;
  for (const unsigned seed : seeds(GetParam())) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto [drawn, graph] = draw_case(seed);
    Dice dice(seed + 2000);
    const Scene scene = make_tall(drawn, dice);
    const auto checked = load(graph);
    SessionOptions alone = with_dumps(serial(), graph);
    alone.fuse = false;
    const Outcome want = run(checked, graph.inputs, scene, alone);
    for (const int threads : {1, 4})
      expect_same(run(checked, graph.inputs, scene, with_dumps(concurrent({threads, 2}), graph)), want);
    turns_in_bands += count_turns_in_bands(checked, graph, scene);
  }
  EXPECT_GT(turns_in_bands, 3) << "the graphs must be of a kind that tries what is tested";
}

INSTANTIATE_TEST_SUITE_P(Block, RandomGraphs, testing::Range(0, kBlocks));

// The graphs must be of a kind that tries what is tested.
TEST(RandomGraphsOfTheTest, HaveEverythingOften) {
  std::map<std::string, int> counts;
  for (unsigned seed = 0; seed < kGraphs; ++seed) {
    const auto [scene, graph] = draw_case(seed);
    const auto checked = load(graph);
    const Outcome outcome = compute_naively(graph, scene, names(*checked));
    PatternSource source(graph.inputs, scene);
    InputShapes shapes;
    for (const GraphInput& input : checked->inputs) shapes[input.name] = source.shape(input.name);
    const Plan plan = make_plan(checked, shapes);
    counts["graphs of which five nodes or more run"] += plan.nodes.size() >= 5;
    for (const PlannedTurn& turn : plan.turns) {
      counts["fused nodes"] += turn.is_fused();
      counts["fused nodes that run ahead"] += turn.is_fused() && std::ranges::max(turn.ahead) > 0;
      counts["images that are whole beside a window"] += std::ranges::count(turn.windows, true, &PlannedWindow::whole);
    }
    counts["images that are never whole"] += static_cast<int>(plan.inner.size());
    counts["loops"] += static_cast<int>(plan.loops.size());
    for (const PlannedNode& planned : plan.nodes)
      for (const int input : planned.in_place_of) counts["written in place"] += input >= 0;
    counts["dumps"] += !graph.dumps.empty();
    counts["subgraphs"] += graph.groups > 0;
    counts["cuts"] += !scene.cuts.empty();
    for (const auto& [group, place] : graph.resets) {
      const bool is_given = graph.present(place) && !graph.node(place).fails.empty();
      counts["resets that are given"] += is_given;
      counts["resets of subgraphs"] += group >= 0;
    }
    counts["odd sizes"] += !scene.odd.empty();
    for (const FrameReport& report : outcome.reports) {
      counts["good frames"] += report.ok;
      counts["frames with a node that fails"] += !report.node.empty();
      counts["frames that cannot be read or written"] += !report.ok && report.node.empty();
    }
    for (int index = 0; index < static_cast<int>(graph.nodes.size()); ++index) {
      const TestNode& node = graph.nodes[static_cast<std::size_t>(index)];
      counts["pruned nodes"] += !graph.present({index});
      for (const Wire& wire : wires(node)) {
        counts["back edges"] += wire.delay > 0 && wire.from.node >= index;
        counts["ahead"] += wire.delay < 0;
        counts["never there"] += !graph.present(wire.from);
        counts["initial values of the same frame"] += wire.delay != 0 && wire.start == Wire::Start::place;
      }
    }
  }
  EXPECT_EQ(counts.size(), 21U);
  for (const auto& [what, count] : counts) {
    RecordProperty(what, count);
    EXPECT_GE(count, 25) << what;
  }
}

}  // namespace
}  // namespace quell::test
