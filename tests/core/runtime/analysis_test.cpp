// What bounds the throughput of a graph: terms computed by hand, and the measuring of frames in memory.
#include "quell/runtime/analysis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/core/runtime/memory_stream.h"

namespace quell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using Limit = Analysis::Limit;

/// a and b in a loop of 2 frames, c behind it.
Plan plan_with_loop() {
  return make_plan(test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"a": {"pass": "accumulate", "in": {"color": "color", "history": {"from": "b.color", "delay": 2, "initial": "none"}}},
              "b": {"pass": "accumulate", "in": {"color": "a.color"}},
              "c": {"pass": "accumulate", "in": {"color": "b.color"}}},
    "outputs": {"color": "c.color"}})"),
                   {{"color", Shape{QUELL_TYPE_COLOR, {8, 6}}}});
}

Plan plan_without_loop() {
  return make_plan(test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"a": {"pass": "accumulate", "in": {"color": "color"}}}, "outputs": {"color": "a.color"}})"),
                   {{"color", Shape{QUELL_TYPE_COLOR, {8, 6}}}});
}

TEST(Analysis, DividesWorkByThreadsAndLoopsByTheirDelay) {
  const Analysis analysis = analyze(plan_with_loop(), {.threads = 2,
                                                       .on_one_thread = {2, 4, 6},
                                                       .on_all_threads = {1, 3, 4},
                                                       .reading = 1,
                                                       .writing = 3,
                                                       .source_uses_processor = true,
                                                       .sink_uses_processor = true});
  ASSERT_THAT(analysis.cycles, SizeIs(1));
  EXPECT_THAT(analysis.slowest()->nodes, ElementsAre(0, 1));
  EXPECT_DOUBLE_EQ(analysis.loop, (1 + 3) / 2.0);
  EXPECT_DOUBLE_EQ(analysis.work, (2 + 4 + 6 + 1 + 3) / 2.0);
  EXPECT_DOUBLE_EQ(analysis.io, (1 + 3) / 2.0);
  EXPECT_EQ(analysis.limit, Limit::work);
  EXPECT_DOUBLE_EQ(analysis.seconds_per_frame(), 8);
}

TEST(Analysis, TellsWhenALoopBinds) {
  const Analysis analysis =
      analyze(plan_with_loop(), {.threads = 4, .on_one_thread = {9, 9, 0.5}, .on_all_threads = {8, 7, 0.5}});
  EXPECT_DOUBLE_EQ(analysis.loop, 7.5);
  EXPECT_DOUBLE_EQ(analysis.work, 18.5 / 4);
  EXPECT_EQ(analysis.limit, Limit::loop);
}

TEST(Analysis, TakesNodesOfALoopAsFastAsTheyCanBe) {
  const Analysis analysis = analyze(plan_with_loop(), {.threads = 2, .on_one_thread = {1, 9, 0}, .on_all_threads = {3, 5, 0}});
  EXPECT_DOUBLE_EQ(analysis.loop, (1 + 5) / 2.0);
}

TEST(Analysis, CountsWhatWaitsAsNoWork) {
  const Analysis analysis = analyze(plan_without_loop(), {.threads = 2,
                                                          .on_one_thread = {2},
                                                          .on_all_threads = {1},
                                                          .reading = 9,
                                                          .writing = 3,
                                                          .source_uses_processor = false,
                                                          .sink_uses_processor = true});
  EXPECT_EQ(analysis.slowest(), nullptr);
  EXPECT_DOUBLE_EQ(analysis.loop, 0);
  EXPECT_DOUBLE_EQ(analysis.work, (2 + 3) / 2.0);
  EXPECT_DOUBLE_EQ(analysis.io, (9 + 3) / 3.0) << "three at a time";
  EXPECT_EQ(analysis.limit, Limit::io);
}

TEST(Analysis, NamesTheMoreSpecialOfEqualTerms) {
  const Plan loop = plan_with_loop();
  EXPECT_EQ(analyze(loop, {.on_one_thread = {0, 0, 0}, .on_all_threads = {0, 0, 0}}).limit, Limit::loop);
  EXPECT_EQ(analyze(plan_without_loop(), {.on_one_thread = {0}, .on_all_threads = {0}}).limit, Limit::io);
}

TEST(Measuring, RunsOnOneThreadAndThenOnAll) {
  MemorySource source;
  MemorySink sink;
  std::vector<std::int64_t> told;
  SessionOptions options;
  options.threads = 2;
  options.on_frame = [&](const FrameReport& report) { told.push_back(report.frame); };
  const FrameTimes times = measure(test_graph(kSumGraph), {3, 4, 5, 6}, source, sink, options);
  EXPECT_THAT(told, ElementsAre(3, 4, 5, 6, 3, 4, 5, 6));
  EXPECT_EQ(times.frames, 3U);
  EXPECT_EQ(times.threads, 2);
  EXPECT_THAT(times.on_one_thread, ElementsAre(::testing::Gt(0)));
  EXPECT_THAT(times.on_all_threads, ElementsAre(::testing::Gt(0)));
  EXPECT_FALSE(times.source_uses_processor);
  EXPECT_FALSE(times.sink_uses_processor);
  EXPECT_EQ(sink.pixel("color", 6), 3.0F + 4.0F + 5.0F + 6.0F) << "history starts anew with the second run";
}

TEST(Measuring, RunsOnceWhereOneThreadIsAll) {
  MemorySource source;
  MemorySink sink;
  SessionOptions options;
  options.threads = 1;
  const FrameTimes times = measure(test_graph(kSumGraph), {1, 2}, source, sink, options);
  EXPECT_THAT(source.reads, SizeIs(2));
  EXPECT_EQ(times.frames, 2U);
  EXPECT_EQ(times.on_one_thread, times.on_all_threads);
}

TEST(Measuring, TakesMediansWithoutTheFirstFrame) {
  using namespace std::chrono_literals;
  MemorySource source;
  MemorySink sink;
  // Of frames 2 and 3 the median lies in the middle; were frame 1 counted, it would be one of the two that do not wait.
  source.paint = [](Image&, std::int64_t frame) {
    if (frame == 2) std::this_thread::sleep_for(100ms);
  };
  SessionOptions options;
  options.threads = 1;
  EXPECT_GE(measure(test_graph(kSumGraph), {1, 2, 3}, source, sink, options).reading, 0.05);
}

std::string failure(FrameSource& source, FrameSink& sink, const std::string& graph = kSumGraph) {
  try {
    measure(test_graph(graph), {1, 2, 3}, source, sink);
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::frame) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "nothing failed";
  return "";
}

TEST(Measuring, EndsWithTheReasonWhenAFrameFails) {
  MemorySource source, unreadable;
  MemorySink sink, unwritable;
  unreadable.unreadable = {2};
  EXPECT_EQ(failure(unreadable, sink), "frame 2: color.2.exr: no such file");
  unwritable.unwritable = {3};
  EXPECT_THAT(failure(source, unwritable), HasSubstr("frame 3: "));
  EXPECT_THAT(failure(source, unwritable), HasSubstr("disk full"));
  EXPECT_THAT(failure(source, sink, R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {"bad": {"pass": "fail_at",
    "in": {"color": "color"}, "params": {"frame": 1}}}, "outputs": {"color": "bad.color"}})"),
              HasSubstr("frame 1: bad: this frame was told to fail"));
}

TEST(Measuring, CanBeCancelled) {
  MemorySource source;
  MemorySink sink;
  SessionOptions options;
  options.cancelled = [&] { return sink.has("color", 2); };
  EXPECT_THROW(measure(test_graph(kSumGraph), {1, 2, 3, 4}, source, sink, options), Cancelled);
}

}  // namespace
}  // namespace quell
