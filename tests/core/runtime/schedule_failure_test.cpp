// Failures count node by node, and the same under every schedule.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/core/runtime/memory_stream.h"
#include "tests/core/runtime/schedule_run.h"

namespace quell::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::int64_t> failed(const std::vector<FrameReport>& reports) {
  std::vector<std::int64_t> frames;
  for (const FrameReport& report : reports)
    if (!report.ok) frames.push_back(report.frame);
  return frames;
}

std::vector<std::int64_t> handed_out(const MemorySink& sink, const std::string& output) {
  std::vector<std::int64_t> frames;
  for (const auto& [key, item] : sink.items)
    if (key.first == output) frames.push_back(key.second);
  return frames;
}

std::string sum_of(const std::string& source, const std::string& name) {
  return '"' + name + R"(": {"pass": "accumulate", "in": {"color": ")" + source + R"(", "history": {"from": ")" + name +
         R"(.color", "delay": 1, "initial": "none"}}})";
}

std::shared_ptr<const Graph> graph_of(const std::string& nodes, const std::string& outputs) {
  return test_graph(R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {)" + nodes + R"(}, "outputs": {)" + outputs + "}}");
}

// The serial schedule, and some settings of the other.
class Failure : public testing::TestWithParam<int> {
 protected:
  SessionOptions options() const { return GetParam() < 0 ? serial() : concurrent(setting(GetParam())); }
  std::vector<FrameReport> run(const std::shared_ptr<const Graph>& graph, const std::vector<std::int64_t>& frames,
                               OnError on_error = OnError::go_on) {
    SessionOptions chosen = options();
    chosen.on_error = on_error;
    Session session(graph, chosen);
    return session.run(frames, source, sink);
  }
  MemorySource source;
  MemorySink sink;
};

TEST_P(Failure, OfANodeIsAbsentForLaterFramesWithWhatDependsOnIt) {
  const auto graph = graph_of(R"("bad": {"pass": "falter", "in": {"color": "color"}, "params": {"frames": [3]}},)" +
                                  sum_of("bad.color", "follower") + "," + sum_of("color", "other"),
                              R"("follower": "follower.color", "other": "other.color")");
  const auto reports = run(graph, {1, 2, 3, 4, 5});
  EXPECT_THAT(failed(reports), ElementsAre(3));
  EXPECT_EQ(reports[2].node, "bad");
  EXPECT_EQ(reports[2].error, "bad: told to fail on frame 3");
  EXPECT_EQ(reports[1].node, "");
  EXPECT_THAT(handed_out(sink, "follower"), ElementsAre(1, 2, 4, 5));
  EXPECT_THAT(handed_out(sink, "other"), ElementsAre(1, 2, 4, 5)) << "nothing of a failed frame is handed out";
  EXPECT_EQ(sink.pixel("follower", 2), 1 + 2);
  EXPECT_EQ(sink.pixel("follower", 4), 4) << "the follower of what failed counts as absent";
  EXPECT_EQ(sink.pixel("follower", 5), 4 + 5);
  EXPECT_EQ(sink.pixel("other", 4), 1 + 2 + 3 + 4) << "what does not depend on it is history all the same";
}

// Of two sums, one of which fails in frame 3; what frames 4 and 5 make of that.
std::shared_ptr<const Graph> two_sums() {
  return graph_of(R"("bad": {"pass": "falter", "in": {"color": "color"}, "params": {"frames": [3]}},)" +
                      sum_of("bad.color", "follower") + "," + sum_of("color", "other"),
                  R"("follower": "follower.color", "other": "other.color")");
}

TEST_P(Failure, EndsAllHistoryWhereThatIsWanted) {
  EXPECT_THAT(failed(run(two_sums(), {1, 2, 3, 4, 5}, OnError::reset)), ElementsAre(3));
  EXPECT_THAT(handed_out(sink, "other"), ElementsAre(1, 2, 4, 5));
  for (const char* sum : {"follower", "other"}) {
    EXPECT_EQ(sink.pixel(sum, 4), 4);
    EXPECT_EQ(sink.pixel(sum, 5), 4 + 5);
  }
}

TEST_P(Failure, LeavesTheHistoryOfTheFrameBeforeWhereThatIsWanted) {
  source.unreadable = {5};
  EXPECT_THAT(failed(run(two_sums(), {1, 2, 3, 4, 5, 6}, OnError::hold)), ElementsAre(3, 5));
  for (const char* sum : {"follower", "other"}) {
    EXPECT_EQ(sink.pixel(sum, 4), 1 + 2 + 4) << sum;
    EXPECT_EQ(sink.pixel(sum, 6), 1 + 2 + 4 + 6) << sum;
  }
}

TEST_P(Failure, OfWritingIsNoneOfTheHistory) {
  for (const OnError on_error : {OnError::reset, OnError::hold}) {
    sink.items.clear();
    sink.unwritable = {2};
    EXPECT_THAT(failed(run(graph_of(sum_of("color", "sum"), R"("sum": "sum.color")"), {1, 2, 3}, on_error)), ElementsAre(2));
    EXPECT_EQ(sink.pixel("sum", 3), 1 + 2 + 3);
  }
}

TEST_P(Failure, OfTheFirstFrameLeavesNothingToHold) {
  source.unreadable = {1};
  EXPECT_THAT(failed(run(two_sums(), {1, 2}, OnError::hold)), ElementsAre(1));
  EXPECT_EQ(sink.pixel("other", 2), 2);
}

TEST_P(Failure, OfANodeLeavesTheHistoryOfInputs) {
  const auto graph = graph_of(
      R"("bad": {"pass": "falter", "in": {"color": "color"}, "params": {"frames": [2]}},
         "sum": {"pass": "accumulate", "in": {"color": "bad.color", "history": {"from": "color", "delay": 1, "initial": "none"}}})",
      R"("sum": "sum.color")");
  EXPECT_THAT(failed(run(graph, {1, 2, 3})), ElementsAre(2));
  EXPECT_EQ(sink.pixel("sum", 3), 2 + 3);
}

TEST_P(Failure, OfSeveralNodesIsReportedForTheFirstInThePlan) {
  for (const bool slow_one_first : {true, false}) {
    const std::string slow =
        R"("wait": {"pass": "linger", "in": {"color": "color"}, "params": {"milliseconds": 2}},
           "slow": {"pass": "falter", "in": {"color": "wait.color"}, "params": {"frames": [2, 3]}})";
    const std::string quick =
        R"("quick": {"pass": "falter", "in": {"color": "color"}, "params": {"frames": [1, 2, 3], "how": "start"}},
           "after": {"pass": "falter", "in": {"color": "quick.color"}, "params": {"frames": [1, 2, 3]}})";
    const auto graph =
        graph_of(slow_one_first ? slow + "," + quick : quick + "," + slow, R"("slow": "slow.color", "after": "after.color")");
    const auto reports = run(graph, {1, 2, 3, 4});
    EXPECT_THAT(failed(reports), ElementsAre(1, 2, 3));
    EXPECT_EQ(reports[0].node, "quick");
    EXPECT_EQ(reports[1].node, slow_one_first ? "slow" : "quick");
    EXPECT_EQ(reports[2].node, slow_one_first ? "slow" : "quick");
    EXPECT_THAT(reports[1].error, StartsWith(reports[1].node + ": told to fail on frame 2"));
  }
}

TEST_P(Failure, OfAnyKindIsContained) {
  for (const std::string how : {"start", "chunk", "memory", "foreign"}) {
    const auto graph =
        graph_of(R"("bad": {"pass": "falter", "in": {"color": "color"}, "params": {"frames": [2], "how": ")" + how + R"("}})",
                 R"("color": "bad.color")");
    const auto reports = run(graph, {1, 2, 3});
    EXPECT_THAT(failed(reports), ElementsAre(2)) << how;
    EXPECT_EQ(reports[1].node, "bad") << how;
    EXPECT_THAT(reports[1].error, StartsWith("bad: ")) << how;
  }
}

TEST_P(Failure, InOneChunkDisturbsNoFrameThatRunsMeanwhile) {
  const auto graph = graph_of(
      R"("soft": {"pass": "soften", "in": {"color": "color"}},
         "bad": {"pass": "falter", "in": {"color": "soft.color"}, "params": {"frames": [2, 3, 5, 8, 9, 12], "in_place": true}},
         "after": {"pass": "soften", "in": {"color": "bad.color"}, "params": {"radius": 2}})",
      R"("color": "after.color", "soft": "soft.color")");
  Scene scene{.size = {64, 200}};
  for (int frame = 1; frame <= 12; ++frame) scene.frames.push_back(frame);
  const Outcome got = test::run(graph, {{"color"}}, scene, options());
  EXPECT_THAT(failed(got.reports), ElementsAre(2, 3, 5, 8, 9, 12));
  expect_same(got, test::run(graph, {{"color"}}, scene, serial()));
}

TEST_P(Failure, ToReadComputesNothingOfTheFrame) {
  source.unreadable = {3};
  const auto graph = graph_of(sum_of("color", "sum") + R"(,
         "before": {"pass": "accumulate", "in": {"color": "color", "history": {"from": "color", "delay": 1, "initial": "none"}}})",
                              R"("sum": "sum.color", "before": "before.color")");
  const auto reports = run(graph, {1, 2, 3, 4, 5});
  EXPECT_THAT(failed(reports), ElementsAre(3));
  EXPECT_EQ(reports[2].node, "");
  EXPECT_EQ(reports[2].error, "color.3.exr: no such file");
  EXPECT_THAT(handed_out(sink, "sum"), ElementsAre(1, 2, 4, 5));
  EXPECT_EQ(sink.pixel("sum", 4), 4);
  EXPECT_EQ(sink.pixel("before", 4), 4);
  EXPECT_EQ(sink.pixel("before", 5), 4 + 5);
}

TEST_P(Failure, ToReadWithSomethingElseThanAnErrorIsContained) {
  source.paint = [](Image&, std::int64_t frame) {
    if (frame == 2) throw std::runtime_error("the network is gone");
    if (frame == 4) throw std::bad_alloc();
  };
  const auto reports = run(test_graph(kSumGraph), {1, 2, 3, 4, 5});
  EXPECT_THAT(failed(reports), ElementsAre(2, 4));
  EXPECT_EQ(reports[1].error, "the network is gone");
  EXPECT_THAT(reports[3].error, HasSubstr("out of memory, with 0 MiB of images held"));
  EXPECT_EQ(sink.pixel("color", 5), 5);
}

TEST_P(Failure, ThatIsNoExceptionOfTheStandardIsContainedToo) {
  source.paint = [](Image&, std::int64_t frame) {
    if (frame == 2) throw 7;
  };
  const auto reports = run(test_graph(kSumGraph), {1, 2, 3});
  EXPECT_THAT(failed(reports), ElementsAre(2));
  EXPECT_FALSE(reports[1].error.empty());
}

TEST_P(Failure, OfTheCallersCallbackEndsTheRunAndHarmsNoLaterOne) {
  SessionOptions chosen = options();
  bool is_broken = true;
  chosen.on_frame = [&](const FrameReport& report) {
    if (is_broken && report.frame == 3) throw std::runtime_error("the caller has had enough");
  };
  Session session(test_graph(kSumGraph), chosen);
  EXPECT_THROW(session.run({1, 2, 3, 4, 5, 6}, source, sink), std::runtime_error);
  is_broken = false;
  sink.items.clear();
  EXPECT_THAT(failed(session.run({20, 21, 22}, source, sink)), ElementsAre());
  EXPECT_THAT(handed_out(sink, "color"), ElementsAre(20, 21, 22));
  EXPECT_EQ(sink.pixel("color", 22), 20 + 21 + 22);
  sink.items.clear();
  EXPECT_EQ(session.pool().usage().in_use, Image::bytes_needed(QUELL_TYPE_COLOR, source.size)) << "one frame of history";
}

TEST_P(Failure, ToWriteLeavesHistory) {
  sink.unwritable = {2, 3};
  const auto reports = run(test_graph(kSumGraph), {1, 2, 3, 4});
  EXPECT_THAT(failed(reports), ElementsAre(2, 3));
  EXPECT_EQ(reports[1].node, "");
  EXPECT_EQ(reports[1].error, "out.exr: disk full");
  EXPECT_EQ(sink.pixel("color", 4), 1 + 2 + 3 + 4);
}

// Refuses one of two outputs, in several ways.
class PickySink final : public FrameSink {
 public:
  void write(std::string_view output, std::int64_t frame, const Item& item) override {
    if (output == "sum" && frame == 2) throw std::runtime_error("no space left");
    if (output == "sum" && frame == 3) throw std::bad_alloc();
    kept.write(output, frame, item);
  }
  MemorySink kept;
};

TEST_P(Failure, ToWriteOneOutputFailsTheFrame) {
  const auto graph =
      graph_of(sum_of("color", "sum") + "," + sum_of("color", "other"), R"("sum": "sum.color", "other": "other.color")");
  PickySink picky;
  Session session(graph, options());
  const auto reports = session.run({1, 2, 3, 4}, source, picky);
  EXPECT_THAT(failed(reports), ElementsAre(2, 3));
  EXPECT_EQ(reports[1].error, "no space left");
  EXPECT_THAT(reports[2].error, HasSubstr("out of memory"));
  EXPECT_EQ(picky.kept.pixel("sum", 4), 1 + 2 + 3 + 4);
}

TEST_P(Failure, EndsTheRunWhenAsked) {
  for (const std::string others : {"", ", 4, 6"}) {
    sink.items.clear();
    const auto graph = graph_of(
        R"("wait": {"pass": "linger", "in": {"color": "color"}, "params": {"milliseconds": 10, "every": 3}},
           "bad": {"pass": "falter", "in": {"color": "wait.color"}, "params": {"frames": [3)" +
            others + R"(], "how": "start"}})",
        R"("color": "bad.color")");
    const auto reports = run(graph, {1, 2, 3, 4, 5, 6, 7, 8}, OnError::stop);
    ASSERT_EQ(reports.size(), 3U) << "later frames end sooner, but frame 3 is the first to fail";
    EXPECT_THAT(failed(reports), ElementsAre(3));
    EXPECT_THAT(handed_out(sink, "color"), ElementsAre(1, 2));
  }
}

TEST_P(Failure, ToReadOrWriteEndsTheRunWhenAsked) {
  source.unreadable = {4};
  auto reports = run(test_graph(kSumGraph), {1, 2, 3, 4, 5, 6}, OnError::stop);
  EXPECT_EQ(reports.size(), 4U);
  EXPECT_THAT(handed_out(sink, "color"), ElementsAre(1, 2, 3));
  sink.items.clear();
  sink.unwritable = {2};
  reports = run(test_graph(kSumGraph), {1, 2, 3, 4, 5, 6}, OnError::stop);
  EXPECT_EQ(reports.size(), 2U);
  EXPECT_THAT(handed_out(sink, "color"), ElementsAre(1));
}

TEST_P(Failure, OfEveryFrameIsReportedForEach) {
  const auto graph = graph_of(
      R"("bad": {"pass": "falter", "in": {"color": "color"}, "params": {"frames": [1, 2, 3, 4, 5, 6, 7, 8], "how": "start"}})",
      R"("color": "bad.color")");
  EXPECT_EQ(failed(run(graph, {1, 2, 3, 4, 5, 6, 7, 8})).size(), 8U);
  EXPECT_TRUE(sink.items.empty());
}

INSTANTIATE_TEST_SUITE_P(Schedules, Failure, testing::Values(-1, 0, 1, 5, 10, 7, 13, 15), [](const auto& chosen) {
  if (chosen.param < 0) return std::string("Serial");
  const Setting s = setting(chosen.param);
  return "Threads" + std::to_string(s.threads) + "Frames" + std::to_string(s.frames);
});

}  // namespace
}  // namespace quell::test
