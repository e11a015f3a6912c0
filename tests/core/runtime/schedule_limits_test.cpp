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
