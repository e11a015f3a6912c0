// Frames in flight and memory are hard limits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "quell/runtime/window.h"
#include "tests/core/runtime/memory_stream.h"
#include "tests/core/runtime/schedule_gauge.h"
#include "tests/core/runtime/schedule_run.h"

namespace quell::test {
namespace {

using ::testing::HasSubstr;

#ifdef __SANITIZE_THREAD__
constexpr int kFrames = 10;
constexpr unsigned kGraphs = 10;
#else
constexpr int kFrames = 24;
constexpr unsigned kGraphs = 60;
#endif

void wait_ms(int ms) {
  if (ms > 0) std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

Scene scene_of(int frames) {
  Scene scene{.size = {16, 16}};
  for (int frame = 1; frame <= frames; ++frame) scene.frames.push_back(frame);
  return scene;
}

Plan plan_of(const std::shared_ptr<const Graph>& graph, PatternSource& source, const std::vector<std::string>& dumps = {}) {
  InputShapes shapes;
  for (const GraphInput& input : graph->inputs) shapes[input.name] = source.shape(input.name);
  return make_plan(graph, shapes, dumps);
}

// What takes its time. The waits only make frames overlap; nothing is asserted about them.
struct Slow {
  const char* name;
  int reader_ms, pass_ms, writer_ms;
};

class FrameLimit : public testing::TestWithParam<std::tuple<int, Slow>> {};

TEST_P(FrameLimit, Holds) {
  const auto& [window, slow] = GetParam();
  const auto graph = test_graph(R"({"quell": 1, "inputs": {"color": "color", "other": "color"},
    "nodes": {"slow": {"pass": "linger", "in": {"color": "color"}, "params": {"milliseconds": )" +
                                std::to_string(slow.pass_ms) + R"(, "every": 2}},
              "sum": {"pass": "stir", "in": {"color": "slow.color", "other": {"from": "sum.color", "delay": 2, "initial": "none"}}},
              "more": {"pass": "stir", "in": {"color": "other", "other": "sum.color"}}},
    "outputs": {"sum": "sum.color", "more": "more.color"}})");
  const std::vector<TestInput> inputs{{"color"}, {"other"}};
  const Scene scene = scene_of(kFrames);
  FrameGauge gauge(2);
  PatternSource source(inputs, scene);
  source.on_read = [&](std::string_view, std::int64_t frame) { gauge.read_begins(frame), wait_ms(slow.reader_ms); };
  RecordingSink sink;
  sink.on_write = [&](std::string_view, std::int64_t frame) { wait_ms(frame % 3 == 0 ? slow.writer_ms : 0); };
  sink.on_written = [&](std::string_view, std::int64_t frame) { gauge.write_ends(frame); };
  Session session(graph, concurrent({4, window}));
  const auto reports = session.run(scene.frames, source, sink);
  EXPECT_LE(gauge.most(), window);
  EXPECT_TRUE(gauge.all_are_closed());
  RecordProperty("most", gauge.most());
  expect_same({sink.take(), reports}, run(graph, inputs, scene, serial()));
}

INSTANTIATE_TEST_SUITE_P(Windows, FrameLimit,
                         testing::Combine(testing::Range(1, 9),
                                          testing::Values(Slow{"Reader", 2, 0, 0}, Slow{"Pass", 0, 3, 0}, Slow{"Writer", 0, 0, 3},
                                                          Slow{"Nothing", 0, 0, 0})),
                         [](const auto& chosen) {
                           return std::string("Slow") + std::get<1>(chosen.param).name +
                                  std::to_string(std::get<0>(chosen.param));
                         });

// The smallest limit that has room for so many frames.
std::size_t memory_for(const Plan& plan, int threads, int frames) {
  const Window window = choose_window(plan, threads, frames, 0);
  return window.fixed_bytes + static_cast<std::size_t>(frames) * window.bytes_per_frame;
}

TEST(MemoryLimit, HoldsForRandomGraphsAndChangesNothing) {
  for (unsigned seed = 0; seed < kGraphs; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice dice(seed);
    const TestGraph graph = random_graph(500 + seed, {3, 7});
    const auto checked = load(graph);
    Scene scene = scene_of(9);
    scene.unreadable = {{"a", 5}};
    scene.unwritable = {6};
    PatternSource source(graph.inputs, scene);
    const int threads = 1 << dice.below(4), frames = dice.from(1, 5);
    SessionOptions options = concurrent({threads, dice.chance(50) ? 0 : 8});
    for (const Place& dump : graph.dumps) options.dumps.push_back(graph.name(dump));
    const Plan plan = plan_of(checked, source, options.dumps);
    options.memory = memory_for(plan, threads, frames);
    EXPECT_EQ(choose_window(plan, threads, frames, options.memory).frames, frames);
    EXPECT_EQ(choose_window(plan, threads, frames + 1, options.memory).frames, frames) << "there is no room for one more";
    RecordingSink sink(scene.unwritable);
    source.keeps_busy = sink.keeps_busy = dice.chance(50);
    Session session(checked, options);
    session.pool().fill(0xff);
    Outcome got;
    got.reports = session.run(scene.frames, source, sink);
    got.pictures = sink.take();
    EXPECT_LE(session.pool().usage().peak, options.memory);
    SessionOptions reference = serial();
    reference.dumps = options.dumps;
    expect_same(got, run(checked, graph.inputs, scene, reference));
    if (HasFailure()) {
      ADD_FAILURE() << threads << " threads, room for " << frames << " frames\n" << to_json(graph, testing::TempDir());
      return;
    }
  }
}

const char* const kLoop = R"({"quell": 1, "inputs": {"color": "color"},
  "nodes": {"soft": {"pass": "soften", "in": {"color": "color"}},
            "turned": {"pass": "shelter", "in": {"color": "soft.color"}},
            "sum": {"pass": "stir", "in": {"color": "turned.color", "other": {"from": "sum.color", "delay": 3, "initial": "none"}}},
            "wait": {"pass": "linger", "in": {"color": "sum.color"}, "params": {"every": 2}}},
  "outputs": {"sum": "sum.color", "wait": "wait.color"}})";

TEST(MemoryLimit, HoldsForWhateverIsSlow) {
  const auto graph = test_graph(kLoop);
  const Scene scene = scene_of(kFrames);
  const Outcome want = run(graph, {{"color"}}, scene, serial());
  for (const int frames : {1, 2, 4, 7})
    for (const bool slow_reader : {true, false}) {
      SCOPED_TRACE(std::to_string(frames) + " frames");
      PatternSource source({{"color"}}, scene);
      source.on_read = [&](std::string_view, std::int64_t frame) { wait_ms(slow_reader ? static_cast<int>(frame % 3) : 0); };
      RecordingSink sink;
      sink.on_write = [&](std::string_view, std::int64_t frame) { wait_ms(slow_reader ? 0 : static_cast<int>(frame % 3)); };
      SessionOptions options = concurrent({4, 0});
      options.memory = memory_for(plan_of(graph, source), 4, frames);
      Session session(graph, options);
      const auto reports = session.run(scene.frames, source, sink);
      EXPECT_LE(session.pool().usage().peak, options.memory);
      expect_same({sink.take(), reports}, want);
    }
}

TEST(MemoryLimit, ThatHasNoRoomForOneFrameIsRefusedWithTheFigureNeeded) {
  const auto graph = test_graph(kLoop);
  const Scene scene = scene_of(3);
  PatternSource source({{"color"}}, {.frames = {1, 2, 3}, .size = {640, 400}});
  SessionOptions options = concurrent({2, 0});
  const std::size_t needed = memory_for(plan_of(graph, source), 2, 1);
  options.memory = needed - 1;
  RecordingSink sink;
  try {
    Session(graph, options).run(scene.frames, source, sink);
    FAIL() << "a frame of which one byte has no room was run";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::memory);
    EXPECT_THAT(error.what(), HasSubstr(std::to_string((needed + (1 << 20) - 1) >> 20))) << "in MiB, rounded up";
  }
  EXPECT_TRUE(sink.take().empty());
  options.memory = needed;
  EXPECT_EQ(Session(graph, options).run(scene.frames, source, sink).size(), 3U);
}

// Eight branches that take one image when they run one after the other, and eight when all of them begin at once; beside them
// results that later frames need.
std::shared_ptr<const Graph> wide_graph() {
  std::string nodes, before = "color";
  for (const char* i : {"0", "1", "2", "3", "4", "5", "6", "7"}) {
    const std::string number(i), wait = "wait" + number, small = "small" + number, sum = "sum" + number;
    nodes += '"' + wait + R"(": {"pass": "linger", "in": {"color": "color"}, "params": {"salt": )" + number + R"(}},
      ")" + small +
             R"(": {"pass": "reduce", "in": {"color": ")" + wait + R"(.color"}},
      ")" + sum +
             R"(": {"pass": "stir", "in": {"color": ")" + small + R"(.weight", "other": ")" + before + R"("}},)";
    before = sum + ".color";
  }
  return test_graph(R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {)" + nodes + R"(
    "kept": {"pass": "parts", "in": {"color": "color", "items": ["color", "color"]}},
    "last": {"pass": "stir", "in": {"color": ")" +
                    before + R"(", "more": [{"from": "kept.items[0]", "delay": 1, "initial": "none"},
                                    {"from": "kept.items[1]", "delay": 2, "initial": "none"}]}}},
    "outputs": {"sum": "last.color"}})");
}

TEST(MemoryLimit, HoldsWhenNodesRunAheadOfThePlansOrder) {
  const auto graph = wide_graph();
  Scene scene = scene_of(10);
  scene.size = {40, 24};
  const Outcome want = run(graph, {{"color"}}, scene, serial());
  for (const int threads : {4, 8})
    for (const int frames : {1, 2, 3, 4, 6}) {
      SCOPED_TRACE(std::to_string(threads) + " threads, room for " + std::to_string(frames) + " frames");
      PatternSource source({{"color"}}, scene);
      source.on_read = [&](std::string_view, std::int64_t frame) { wait_ms(static_cast<int>(frame % 4)); };
      RecordingSink sink;
      sink.on_write = [&](std::string_view, std::int64_t frame) { wait_ms(frame % 4 == 2 ? 9 : 0); };
      SessionOptions options = concurrent({threads, 0});
      options.memory = memory_for(plan_of(graph, source), threads, frames);
      Session session(graph, options);
      const auto reports = session.run(scene.frames, source, sink);
      EXPECT_LE(session.pool().usage().peak, options.memory);
      expect_same({sink.take(), reports}, want);
    }
}

// Frames are read before their size is known: what was read ahead may be beyond the limit, but nothing else.
TEST(MemoryLimit, HoldsWhenLargerFramesCome) {
  const auto graph = test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"copies": {"pass": "parts", "in": {"color": "color", "items": ["color", "color", "color", "color", "color", "color"]}},
              "wait": {"pass": "linger", "in": {"color": "copies.items[0]"}},
              "sum": {"pass": "stir", "in": {"color": "wait.color", "more": ["copies.items[1]", "copies.items[2]",
                      "copies.items[3]", "copies.items[4]", "copies.items[5]"]}}},
    "outputs": {"sum": "sum.color"}})");
  Scene scene = scene_of(20);
  scene.size = {8, 8};
  for (std::int64_t frame = 6; frame <= 16; ++frame) scene.odd[frame] = {64, 64};
  const Outcome want = run(graph, {{"color"}}, scene, serial());
  PatternSource large({{"color"}}, {.frames = scene.frames, .size = {64, 64}});
  const std::size_t read_ahead = 8 * Image::bytes_needed(QUELL_TYPE_COLOR, {64, 64});
  for (const int frames : {1, 2, 3}) {
    SCOPED_TRACE("room for " + std::to_string(frames) + " large frames");
    PatternSource source({{"color"}}, scene);
    SessionOptions options = concurrent({4, 8});
    options.memory = memory_for(plan_of(graph, large), 4, frames);
    RecordingSink sink;
    Session session(graph, options);
    const auto reports = session.run(scene.frames, source, sink);
    EXPECT_LE(session.pool().usage().peak, options.memory + read_ahead);
    expect_same({sink.take(), reports}, want);
  }
}

TEST(MemoryLimit, FailsFramesThatAreTooLargeAlone) {
  const auto graph = test_graph(kLoop);
  Scene scene = scene_of(9);
  scene.odd = {{4, {100, 100}}, {7, {100, 100}}};
  PatternSource source({{"color"}}, scene);
  for (const Schedule schedule : {Schedule::serial, Schedule::concurrent}) {
    SessionOptions options{.threads = 2, .schedule = schedule, .frames_in_flight = 3};
    options.memory = memory_for(plan_of(graph, source), 2, 3);
    RecordingSink sink;
    const auto reports = Session(graph, options).run(scene.frames, source, sink);
    ASSERT_EQ(reports.size(), 9U);
    for (const FrameReport& report : reports) EXPECT_EQ(report.ok, report.frame != 4 && report.frame != 7) << report.error;
    EXPECT_THAT(reports[3].error, HasSubstr("are needed")) << "as when no frame fits";
    EXPECT_EQ(sink.take().size(), 2U * 7);
  }
}

// A sink may hold what it gets; what is held longer than a frame is beyond any limit, but must not bring the run to a halt.
TEST(MemoryLimit, DoesNotStallWhenTheSinkHoldsOn) {
  const auto graph = test_graph(kLoop);
  const Scene scene = scene_of(kFrames);
  PatternSource source({{"color"}}, scene);
  MemorySink sink;
  SessionOptions options = concurrent({4, 4});
  options.memory = memory_for(plan_of(graph, source), 4, 2);
  Session session(graph, options);
  EXPECT_EQ(session.run(scene.frames, source, sink).size(), scene.frames.size());
  EXPECT_EQ(sink.items.size(), 2 * scene.frames.size());
}

}  // namespace
}  // namespace quell::test
