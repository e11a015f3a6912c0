// Random changes of random graphs: what a rerun leaves behind, change after change, is what whole runs of each graph would leave.
#include <gtest/gtest.h>

#include <algorithm>

#include "quell/runtime/rerun.h"
#include "quell/runtime/window.h"
#include "tests/core/runtime/schedule_run.h"

namespace quell::test {
namespace {

#ifdef __SANITIZE_THREAD__
constexpr int kBlocks = 2;
#else
constexpr int kBlocks = 4;
#endif
constexpr unsigned kGraphsPerBlock = 16;
constexpr int kChanges = 7;

enum class Change { salt, radius, in_place, constant, delay, failures, drop_other, outputs, dumps, nothing, kind, start, kCount };

// One change that leaves a graph which can be planned.
class Editor {
 public:
  Editor(TestGraph& graph, Dice& dice, const std::vector<std::int64_t>& frames) : graph_(graph), dice_(dice), frames_(frames) {}

  void make(Change change) {
    TestNode& node = graph_.nodes[static_cast<std::size_t>(dice_.below(static_cast<int>(graph_.nodes.size())))];
    switch (change) {
      case Change::salt:
        node.salt = (node.salt + dice_.from(1, 400)) % 1000;
        return;
      case Change::radius:
        node.radius = dice_.below(3);
        return;
      case Change::in_place:
        node.in_place = !node.in_place;
        return;
      case Change::failures:
        if (node.kind == Kind::falter || node.kind == Kind::pulse) node.fails = {static_cast<int>(dice_.pick(frames_))};
        return;
      case Change::drop_other:
        node.other.clear();
        return;
      case Change::outputs:
        if (graph_.outputs.size() > 1 && dice_.chance(50)) graph_.outputs.pop_back();
        std::ranges::rotate(graph_.outputs, graph_.outputs.begin() + dice_.below(static_cast<int>(graph_.outputs.size())));
        return;
      case Change::dumps:
        graph_.dumps = dice_.chance(50) ? std::vector<Place>() : std::vector<Place>{dice_.pick(graph_.outputs)};
        return;
      case Change::kind:
        if (node.kind == Kind::stir) node.kind = Kind::soften, node.other.clear(), node.list.clear();
        return;
      default:
        for (std::vector<Wire>* wires : {&node.main, &node.other, &node.list})
          for (Wire& wire : *wires)
            if (wire.delay != 0) change_delayed(wire, change);
    }
  }

 private:
  void change_delayed(Wire& wire, Change change) {
    if (change == Change::constant) wire.constant = dice_.below(4000);
    if (change == Change::delay && wire.delay > 0) wire.delay = dice_.from(1, 3);
    if (change == Change::start && wire.start == Wire::Start::none) wire.start = Wire::Start::constant;
  }
  TestGraph& graph_;
  Dice& dice_;
  const std::vector<std::int64_t>& frames_;
};

// The nodes that a change of one node can affect, found in the test's own description of the graph.
std::set<std::string> affected(const TestGraph& graph, const std::set<int>& changed) {
  std::set<int> all = changed;
  for (std::size_t before = 0; before != all.size();) {
    before = all.size();
    for (int i = 0; i < static_cast<int>(graph.nodes.size()); ++i)
      for (const Wire& wire : wires(graph.nodes[static_cast<std::size_t>(i)]))
        if (all.contains(wire.from.node) ||
            (wire.start == Wire::Start::place && wire.delay != 0 && all.contains(wire.place.node)))
          all.insert(i);
    for (int i = 0; i < static_cast<int>(graph.nodes.size()); ++i)
      for (const Place& reset : graph.resets_of(i))
        if (all.contains(reset.node) &&
            std::ranges::any_of(wires(graph.nodes[static_cast<std::size_t>(i)]), [](const Wire& wire) { return wire.delay > 0; }))
          all.insert(i);
  }
  std::set<std::string> names;
  for (const int node : all) names.insert(graph.name(node));
  return names;
}

struct Tally {
  int needed = 0, computed = 0, strict = 0;
};

class Case {
 public:
  explicit Case(unsigned seed) : dice_(seed + 5000), scene_(random_scene(dice_)), graph_(random_graph(seed, scene_.frames)) {
    if (dice_.chance(50)) leave_out_mishaps();
    is_plain_ = scene_.unreadable.empty() && scene_.odd.empty() && scene_.unwritable.empty();
    limits_memory_ = dice_.chance(30);
    keeps_busy_ = dice_.chance(50);
    setting_ = setting(dice_.below(kSettings));
  }

  void run(Tally& tally) {
    for (int i = 0; i <= kChanges && !testing::Test::HasFailure(); ++i) {
      std::vector<TestNode> before = graph_.nodes;
      const auto change = dice_.chance(30) ? Change::salt : static_cast<Change>(dice_.below(static_cast<int>(Change::kCount)));
      if (i > 0) Editor(graph_, dice_, scene_.frames).make(change);
      SCOPED_TRACE("run " + std::to_string(i) + ", change " + std::to_string(static_cast<int>(change)));
      run_both(i > 0 && change == Change::salt ? std::optional(before) : std::nullopt, tally);
    }
  }

 private:
  void leave_out_mishaps() {
    scene_.unreadable.clear(), scene_.unwritable.clear(), scene_.odd.clear();
    for (TestNode& node : graph_.nodes) node.fails.clear();
  }

  SessionOptions options(const std::shared_ptr<const Graph>& graph) {
    SessionOptions options = concurrent(setting_);
    options.cuts = scene_.cuts;
    for (const Place& dump : graph_.dumps) options.dumps.push_back(graph_.name(dump));
    if (!limits_memory_) return options;
    InputShapes shapes;
    PatternSource source(graph_.inputs, scene_);
    for (const GraphInput& input : graph->inputs) shapes[input.name] = source.shape(input.name);
    const Window window = choose_window(make_plan(graph, shapes, options.dumps), setting_.threads, 1, 0);
    options.memory = 2 * (window.fixed_bytes + window.bytes_per_frame) + static_cast<std::size_t>(dice_.below(40)) * 20'000;
    return options;
  }

  void run_both(const std::optional<std::vector<TestNode>>& before, Tally& tally) {
    const auto checked = load(graph_);
    SessionOptions how = options(checked);
    const Outcome want = test::run(checked, graph_.inputs, scene_, how, keeps_busy_);
    PatternSource source(graph_.inputs, scene_);
    RecordingSink sink(scene_.unwritable);
    source.keeps_busy = sink.keeps_busy = keeps_busy_;
    const RerunReport got = rerun_.run(checked, scene_.frames, source, sink, how);
    for (const auto& [key, pictured] : want.pictures) folder_want_.insert_or_assign(key, pictured);
    for (auto& [key, pictured] : sink.take()) folder_got_.insert_or_assign(key, pictured);
    expect_same({folder_got_, {}}, {folder_want_, {}});
    expect_same_fate(got, want);
    for (std::size_t i = 0; i < got.nodes.size(); ++i) tally.needed += 1, tally.computed += got.computed[i] > 0;
    const bool all_well = std::ranges::all_of(want.reports, &FrameReport::ok);
    if (before && was_well_ && all_well && is_plain_ && !limits_memory_ && ++tally.strict) expect_only_affected(got, *before);
    was_well_ = all_well;
  }

  // Whatever was handed out before was so without a failure, and need not be said again.
  static void expect_same_fate(const RerunReport& got, const Outcome& want) {
    if (got.results.empty()) {
      EXPECT_TRUE(std::ranges::all_of(want.reports, &FrameReport::ok));
      return;
    }
    ASSERT_EQ(got.frames.size(), want.reports.size());
    for (std::size_t i = 0; i < got.frames.size(); ++i) {
      EXPECT_EQ(got.frames[i].frame, want.reports[i].frame);
      EXPECT_EQ(got.frames[i].ok, want.reports[i].ok) << got.frames[i].error << want.reports[i].error;
      EXPECT_EQ(got.frames[i].node, want.reports[i].node);
      EXPECT_EQ(got.frames[i].error, want.reports[i].error);
    }
  }

  void expect_only_affected(const RerunReport& got, const std::vector<TestNode>& before) {
    std::set<int> changed;
    for (int i = 0; i < static_cast<int>(before.size()); ++i)
      if (const TestNode& node = graph_.nodes[static_cast<std::size_t>(i)];
          node.kind != Kind::pulse && before[static_cast<std::size_t>(i)].salt != node.salt)
        changed.insert(i);
    const std::set<std::string> may = affected(graph_, changed);
    for (std::size_t i = 0; i < got.nodes.size(); ++i)
      EXPECT_EQ(got.computed[i], may.contains(got.nodes[i]) ? static_cast<int>(scene_.frames.size()) : 0) << got.nodes[i];
  }

  Dice dice_;
  Scene scene_;
  TestGraph graph_;
  bool is_plain_, limits_memory_, keeps_busy_, was_well_ = false;
  Setting setting_;
  Rerun rerun_;
  Pictures folder_want_, folder_got_;
};

class RandomChanges : public testing::TestWithParam<int> {};

TEST_P(RandomChanges, LeaveWhatWholeRunsWouldLeaveAndComputeNoMoreThanTheyAffect) {
  Tally tally;
  for (unsigned i = 0; i < kGraphsPerBlock && !HasFailure(); ++i) {
    const unsigned seed = static_cast<unsigned>(GetParam()) * kGraphsPerBlock + i;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Case(seed).run(tally);
  }
  RecordProperty("needed", tally.needed);
  RecordProperty("computed", tally.computed);
  EXPECT_LT(tally.computed, tally.needed * 9 / 10) << "a test in which nothing is ever kept shows nothing";
  EXPECT_GE(tally.strict, 3);
}

INSTANTIATE_TEST_SUITE_P(Rerun, RandomChanges, testing::Range(0, kBlocks));

}  // namespace
}  // namespace quell::test
