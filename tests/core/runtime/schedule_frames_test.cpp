// Frames of other sizes, gaps, and sessions that run more than once: the same under every schedule.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <thread>

#include "tests/core/runtime/memory_stream.h"
#include "tests/core/runtime/schedule_run.h"

namespace quell::test {
namespace {

using ::testing::HasSubstr;

// Loops of delay 1 and 3, a look ahead, an initial value of the same frame, a smaller image and a number.
std::shared_ptr<const Graph> graph_with_everything() {
  return test_graph(R"({"quell": 1, "inputs": {"color": "color", "other": "color"},
    "nodes": {
      "soft": {"pass": "soften", "in": {"color": "color"}},
      "fast": {"pass": "stir", "params": {"in_place": true},
               "in": {"color": "soft.color", "other": {"from": "fast.color", "delay": 1, "initial": {"from": "other"}}}},
      "slow": {"pass": "stir", "in": {"color": "fast.color", "other": {"from": "slow.color", "delay": 3, "initial": {"constant": [9]}},
               "more": [{"from": "other", "delay": -1, "initial": "none"}, {"from": "color", "delay": 2, "initial": "none"}]}},
      "small": {"pass": "shrink", "in": {"color": "slow.color"}},
      "kept": {"pass": "stir", "in": {"color": "small.color", "other": {"from": "kept.color", "delay": 2, "initial": "none"}}},
      "count": {"pass": "tally", "in": {"color": "kept.color", "previous": {"from": "count.count", "delay": 1, "initial": "none"}}}},
    "outputs": {"slow": "slow.color", "kept": "kept.color", "count": "count.count"}})");
}
const std::vector<TestInput> kInputs{{"color"}, {"other"}};

std::vector<std::int64_t> frames_up_to(int last) {
  std::vector<std::int64_t> frames(static_cast<std::size_t>(last));
  std::iota(frames.begin(), frames.end(), 1);
  return frames;
}

TEST(ScheduleOfFrames, OfOtherSizesDoesNotShow) {
  const std::vector<std::map<std::int64_t, Size>> changes = {
      {{5, {7, 9}}},                                          // one in the middle
      {{1, {7, 9}}},                                          // the first
      {{10, {30, 40}}},                                       // the last
      {{4, {7, 9}}, {5, {7, 9}}, {6, {7, 9}}},                // some alike in a row
      {{3, {7, 9}}, {4, {8, 9}}, {5, {1, 1}}, {6, {33, 2}}},  // each another
      {{2, {7, 9}}, {4, {7, 9}}, {6, {7, 9}}, {8, {7, 9}}},   // back and forth
  };
  for (const auto& odd : changes) {
    SCOPED_TRACE(std::to_string(odd.size()) + " odd frames from " + std::to_string(odd.begin()->first));
    const Scene scene{.frames = frames_up_to(10), .odd = odd};
    expect_same_in_all_settings(graph_with_everything(), kInputs, scene);
  }
}

TEST(ScheduleOfFrames, OfOtherSizesAmongFailuresDoesNotShow) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    Scene scene{.frames = frames_up_to(12)};
    for (int i = 0; i < 4; ++i) scene.odd[dice.from(1, 12)] = {dice.from(1, 20), dice.from(1, 20)};
    scene.unreadable = {{"color", dice.from(1, 12)}, {"other", dice.from(1, 12)}};
    scene.unwritable = {dice.from(1, 12)};
    expect_same_in_all_settings(graph_with_everything(), kInputs, scene);
  }
}

// One input has another size than the rest, which the graph refuses.
class UnevenSource final : public PatternSource {
 public:
  using PatternSource::PatternSource;
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override {
    if (input != "other" || (frame != 4 && frame != 5)) return PatternSource::read(input, frame, pool);
    Image image(QUELL_TYPE_COLOR, {3, 3}, pool);
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < 3; ++y) std::fill_n(image.writable_floats().row(y, c), 3, 1.0F);
    return image;
  }
};

TEST(ScheduleOfFrames, ThatTheGraphRefusesFailsThemAlone) {
  const Scene scene{.frames = frames_up_to(9)};
  const auto run = [&](const SessionOptions& options) {
    UnevenSource source(kInputs, scene);
    RecordingSink sink;
    Outcome outcome;
    outcome.reports = Session(graph_with_everything(), options).run(scene.frames, source, sink);
    outcome.pictures = sink.take();
    return outcome;
  };
  const Outcome want = run(serial());
  ASSERT_EQ(want.reports.size(), 9U);
  for (const FrameReport& report : want.reports) EXPECT_EQ(report.ok, report.frame != 4 && report.frame != 5) << report.error;
  EXPECT_THAT(want.reports[3].error, HasSubstr("a node's images have one size"));
  for (int number = 0; number < kSettings; ++number) {
    SCOPED_TRACE(describe(setting(number)));
    expect_same(run(concurrent(setting(number))), want);
  }
}

TEST(ScheduleOfFrames, WithGapsDoesNotShow) {
  for (const std::vector<std::int64_t>& frames :
       {std::vector<std::int64_t>{-3, -2, 0, 1, 2, 5, 6, 9, 10, 11}, {7}, {1, 3, 5, 7, 9}, {0, 1000000, 1000001, 3000000000}}) {
    SCOPED_TRACE("from frame " + std::to_string(frames.front()));
    expect_same_in_all_settings(graph_with_everything(), kInputs, {.frames = frames});
  }
}

// Several runs and pushes of one session, all that came out joined.
Outcome run_in_parts(const SessionOptions& options, const std::vector<std::vector<std::int64_t>>& parts, const Scene& scene) {
  PatternSource source(kInputs, scene);
  Session session(graph_with_everything(), options);
  Outcome all;
  for (const auto& part : parts) {
    RecordingSink sink(scene.unwritable);
    const auto reports = session.run(part, source, sink);
    all.reports.insert(all.reports.end(), reports.begin(), reports.end());
    const std::string number = std::to_string(&part - parts.data());
    for (auto& [key, pictured] : sink.take()) all.pictures[{number + ":" + key.first, key.second}] = std::move(pictured);
  }
  return all;
}

TEST(ScheduleOfFrames, OfSeveralRunsDoesNotShow) {
  Scene scene;
  scene.unwritable = {3};
  scene.odd = {{7, {5, 5}}};
  const std::vector<std::vector<std::vector<std::int64_t>>> plans = {
      {{1, 2, 3}, {4, 5, 6}},        // history goes on
      {{1, 2, 3, 4, 5}, {4, 5, 6}},  // some again
      {{1, 2, 3}, {}, {5, 6}},       // nothing in between, and a gap
      {{10, 11, 12}, {1, 2, 3}},     // back
      {{5, 6, 7}, {8, 9}},           // after another size
  };
  for (const auto& parts : plans) {
    SCOPED_TRACE("plan " + std::to_string(&parts - plans.data()));
    const Outcome want = run_in_parts(serial(), parts, scene);
    for (int number = 0; number < kSettings; ++number) {
      SCOPED_TRACE(describe(setting(number)));
      expect_same(run_in_parts(concurrent(setting(number)), parts, scene), want);
    }
  }
}

TEST(ScheduleOfFrames, ThatAreSplitIntoTwoRunsYieldsTheSameAsOne) {
  const auto sum = test_graph(R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {
    "sum": {"pass": "stir", "in": {"color": "color", "other": {"from": "sum.color", "delay": 3, "initial": "none"}}}},
    "outputs": {"color": "sum.color"}})");
  const Scene whole{.frames = frames_up_to(9)};
  const Outcome want = run(sum, {{"color"}}, whole, serial());
  for (int number = 0; number < kSettings; ++number) {
    SCOPED_TRACE(describe(setting(number)));
    PatternSource source({{"color"}}, whole);
    RecordingSink sink;
    Session session(sum, concurrent(setting(number)));
    Outcome got;
    for (const std::vector<std::int64_t>& part : {std::vector<std::int64_t>{1, 2, 3, 4, 5}, {6}, {7, 8, 9}})
      for (const FrameReport& report : session.run(part, source, sink)) got.reports.push_back(report);
    got.pictures = sink.take();
    expect_same(got, want);
  }
}

TEST(ScheduleOfFrames, ThatArePushedGoesOnWhereARunEndedAndBack) {
  for (int number = -1; number < kSettings; ++number) {
    SCOPED_TRACE(number < 0 ? "serial" : describe(setting(number)));
    MemorySource source;
    MemorySink sink;
    Session session(test_graph(kSumGraph), number < 0 ? serial() : concurrent(setting(number)));
    session.run({1, 2, 3}, source, sink);
    BufferPool pool;
    const auto pushed = session.push(4, {{"color", flat_color(source.size, 40.0F, pool)}});
    EXPECT_EQ(pushed.at("color").image()->floats().at(0, 0), 1 + 2 + 3 + 40);
    session.run({5, 6}, source, sink);
    EXPECT_EQ(sink.pixel("color", 6), 1 + 2 + 3 + 40 + 5 + 6);
  }
}

TEST(ScheduleOfFrames, OfSeveralSessionsAtATimeDoesNotShow) {
  const auto graph = graph_with_everything();
  const Scene scene{.frames = frames_up_to(20)};
  const Outcome want = run(graph, kInputs, scene, serial());
  std::vector<Outcome> got(4);
  {
    std::vector<std::jthread> callers;
    for (std::size_t i = 0; i < got.size(); ++i)
      callers.emplace_back([&, i] {
        SessionOptions options = concurrent({static_cast<int>(i) + 1, 4});
        if (i == 3) options.schedule = Schedule::serial;
        got[i] = run(graph, kInputs, scene, options);
      });
  }
  for (const Outcome& outcome : got) expect_same(outcome, want);
}

TEST(ScheduleOfFrames, WantsNumbersThatAscend) {
  for (const SessionOptions& options : {serial(), concurrent({2, 4})})
    for (const std::vector<std::int64_t>& frames : {std::vector<std::int64_t>{1, 3, 2}, {1, 1}, {0, -1}}) {
      MemorySource source;
      MemorySink sink;
      Session session(test_graph(kSumGraph), options);
      try {
        session.run(frames, source, sink);
        FAIL();
      } catch (const Error& error) { EXPECT_EQ(error.fault(), Fault::usage) << error.what(); }
      EXPECT_TRUE(sink.items.empty());
      EXPECT_EQ(session.run({7}, source, sink).size(), 1U) << "nothing is left behind";
    }
}

TEST(ScheduleOfFrames, TellsOfThemInOrderOnTheCallersThread) {
  for (int number = 0; number < kSettings; ++number) {
    SCOPED_TRACE(describe(setting(number)));
    MemorySource source;
    source.unreadable = {3, 9};
    MemorySink sink;
    std::vector<std::int64_t> told;
    SessionOptions options = concurrent(setting(number));
    const auto caller = std::this_thread::get_id();
    options.on_frame = [&](const FrameReport& report) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      EXPECT_EQ(sink.has("color", report.frame), report.ok) << "frame " << report.frame;
      told.push_back(report.frame);
    };
    const auto frames = frames_up_to(12);
    const auto reports = Session(test_graph(kSumGraph), options).run(frames, source, sink);
    EXPECT_EQ(told, frames);
    for (std::size_t i = 0; i < reports.size(); ++i) EXPECT_EQ(reports[i].frame, frames[i]);
  }
}

}  // namespace
}  // namespace quell::test
