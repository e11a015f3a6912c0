// A frame that fails harms no other, and a run that is cancelled ends cleanly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <thread>

#include "tests/core/runtime/memory_stream.h"

namespace quell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string failing_graph(const std::string& params) {
  return R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"copy": {"pass": "fail_at", "in": {"color": "color"}, "params": )" +
         params + R"(},
              "sum": {"pass": "accumulate", "in": {"color": "copy.color", "history": {"from": "sum.color", "delay": 1, "initial": "none"}}}},
    "outputs": {"color": "sum.color"}})";
}

TEST(SessionFailure, OfAPassFailsItsFrameAlone) {
  MemorySource source;
  MemorySink sink;
  Session session(test_graph(failing_graph(R"({"frame": 3})")));
  const auto reports = session.run({1, 2, 3, 4, 5}, source, sink);
  ASSERT_EQ(reports.size(), 5U);
  EXPECT_FALSE(reports[2].ok);
  EXPECT_EQ(reports[2].error, "copy: this frame was told to fail");
  EXPECT_FALSE(sink.has("color", 3));
  EXPECT_EQ(sink.pixel("color", 2), 3.0F);
  EXPECT_EQ(sink.pixel("color", 4), 4.0F) << "the history of the frame that failed counts as absent";
  EXPECT_EQ(sink.pixel("color", 5), 9.0F);
}

TEST(SessionFailure, ToReadFailsItsFrameAlone) {
  MemorySource source;
  source.unreadable = {2};
  MemorySink sink;
  Session session(test_graph(kSumGraph));
  const auto reports = session.run({1, 2, 3}, source, sink);
  EXPECT_TRUE(reports[0].ok && !reports[1].ok && reports[2].ok);
  EXPECT_EQ(reports[1].error, "color.2.exr: no such file");
  EXPECT_EQ(sink.pixel("color", 3), 3.0F);
}

TEST(SessionFailure, ForLackOfMemoryIsToldInWords) {
  MemorySource source;
  source.paint = [](Image&, std::int64_t frame) {
    if (frame == 2) throw std::bad_alloc();
  };
  MemorySink sink;
  Session session(test_graph(kSumGraph));
  const auto reports = session.run({1, 2, 3}, source, sink);
  EXPECT_TRUE(reports[0].ok && !reports[1].ok && reports[2].ok);
  EXPECT_THAT(reports[1].error, HasSubstr("out of memory, with 0 MiB of images held"));
}

TEST(SessionFailure, ToWriteLeavesHistoryIntact) {
  MemorySource source;
  MemorySink sink;
  sink.unwritable = {2};
  Session session(test_graph(kSumGraph));
  const auto reports = session.run({1, 2, 3}, source, sink);
  EXPECT_FALSE(reports[1].ok);
  EXPECT_EQ(reports[1].error, "out.exr: disk full");
  EXPECT_EQ(sink.pixel("color", 3), 6.0F);
}

TEST(SessionFailure, ToReadAheadIsNoFailureOfTheFrameThatLooks) {
  MemorySource source;
  source.unreadable = {2};
  MemorySink sink;
  Session session(test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"sum": {"pass": "accumulate", "in": {"color": "color", "history": {"from": "color", "delay": -1, "initial": "none"}}}},
    "outputs": {"color": "sum.color"}})"));
  const auto reports = session.run({1, 2, 3}, source, sink);
  EXPECT_TRUE(reports[0].ok && !reports[1].ok && reports[2].ok);
  EXPECT_EQ(sink.pixel("color", 1), 1.0F);
}

TEST(Session, StartsHistoryAnewWhenTheSizeChanges) {
  MemorySource source;
  source.odd_size[3] = {5, 9};
  MemorySink sink;
  Session session(test_graph(kSumGraph));
  const auto reports = session.run({1, 2, 3, 4, 5}, source, sink);
  for (const FrameReport& report : reports) EXPECT_TRUE(report.ok) << report.error;
  EXPECT_EQ(sink.items.at({"color", 3}).image()->size(), (Size{5, 9}));
  EXPECT_EQ(sink.pixel("color", 3), 3.0F);
  EXPECT_EQ(sink.pixel("color", 4), 4.0F);
  EXPECT_EQ(sink.pixel("color", 5), 9.0F);
}

TEST(Session, ReportsFramesInOrderAsTheyAreDone) {
  MemorySource source;
  MemorySink sink;
  std::vector<std::int64_t> seen;
  Session session(test_graph(kSumGraph), {.on_frame = [&](const FrameReport& report) {
                    EXPECT_TRUE(sink.has("color", report.frame));
                    EXPECT_EQ(report.node_seconds.size(), 1U);
                    seen.push_back(report.frame);
                  }});
  session.run({3, 4, 9}, source, sink);
  EXPECT_THAT(seen, ElementsAre(3, 4, 9));
}

TEST(Session, EndsInTheMiddleOfAFrameWhenCancelled) {
  MemorySource source;
  MemorySink sink;
  std::atomic<bool> stop = false;
  std::jthread canceller;
  source.paint = [&](Image&, std::int64_t frame) {
    if (frame == 2)
      canceller = std::jthread([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        stop = true;
      });
  };
  Session session(test_graph(failing_graph(R"({"frame": 2, "wait": true})")), {.cancelled = [&] { return stop.load(); }});
  const auto reports = session.run({1, 2, 3}, source, sink);
  EXPECT_EQ(reports.size(), 1U) << "the frame that was cut short is neither done nor failed";
  EXPECT_FALSE(sink.has("color", 2));
  EXPECT_FALSE(sink.has("color", 3));
}

// Frames that keep coming leave the caller of run() no idle moment, and this pass never asks.
TEST(Session, EndsSoonAfterItIsCancelledWhileFramesKeepComing) {
  MemorySource source;
  source.paint = [](Image&, std::int64_t) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
  MemorySink sink;
  std::vector<std::int64_t> frames(2000);
  std::iota(frames.begin(), frames.end(), 1);
  const auto graph = test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"count": {"pass": "count", "in": {"color": "color"}}}, "outputs": {"count": "count.count"}})");
  std::atomic<bool> stop = false;
  Session session(graph, {.threads = 2,
                          .cancelled = [&] { return stop.load(); },
                          .on_frame =
                              [&](const FrameReport& report) {
                                if (report.frame == 10) stop = true;
                              }});
  EXPECT_LT(session.run(frames, source, sink).size(), 500U);
}

TEST(Session, RefusesASourceThatLacksARequiredInput) {
  MemorySource source;
  source.absent = {"color"};
  MemorySink sink;
  Session session(test_graph(kSumGraph));
  EXPECT_THAT([&] { session.run({1}, source, sink); }, ::testing::ThrowsMessage<Error>(HasSubstr("color")));
}

TEST(Session, RefusesToLookAheadOnPushedFrames) {
  BufferPool pool;
  Session session(test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"sum": {"pass": "accumulate", "in": {"color": "color", "history": {"from": "color", "delay": -1, "initial": "none"}}}},
    "outputs": {"color": "sum.color"}})"));
  EXPECT_THAT(
      [&] {
        session.push(1, {{"color", flat_color({2, 2}, 1, pool)}});
      },
      ::testing::ThrowsMessage<Error>(HasSubstr("use Session::run")));
}

}  // namespace
}  // namespace quell
