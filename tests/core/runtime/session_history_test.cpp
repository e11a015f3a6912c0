// Frames that are computed again, or in another order than that of their numbers.
#include <gtest/gtest.h>

#include "tests/core/runtime/memory_stream.h"

namespace quell {
namespace {

TEST(SessionHistory, HoldsTheLatestResultOfAFrameThatIsComputedAgain) {
  BufferPool pool;
  Session session(test_graph(kSumGraph));
  session.push(1, {{"color", flat_color({4, 4}, 1.0F, pool)}});
  session.push(1, {{"color", flat_color({4, 4}, 10.0F, pool)}});
  const auto outputs = session.push(2, {{"color", flat_color({4, 4}, 2.0F, pool)}});
  EXPECT_EQ(outputs.at("color").image()->floats().at(0, 0), 12.0F);
}

TEST(SessionHistory, ForgetsAFrameThatIsComputedAgainAndFails) {
  BufferPool pool;
  bool stop = false;
  Session session(test_graph(kSumGraph), {.cancelled = [&] { return stop; }});
  session.push(1, {{"color", flat_color({4, 4}, 1.0F, pool)}});
  stop = true;
  EXPECT_THROW(session.push(1, {{"color", flat_color({4, 4}, 10.0F, pool)}}), Cancelled);
  stop = false;
  const auto outputs = session.push(2, {{"color", flat_color({4, 4}, 2.0F, pool)}});
  EXPECT_EQ(outputs.at("color").image()->floats().at(0, 0), 2.0F);
}

TEST(SessionHistory, StaysAsLongAsTheDelayWhenFramesDescend) {
  MemorySource source;
  Session session(test_graph(kSumGraph));
  for (std::int64_t frame = 50; frame > 0; --frame) {
    MemorySink sink;
    session.run({frame}, source, sink);
    EXPECT_EQ(sink.pixel("color", frame), static_cast<float>(frame)) << "the frame before was not computed yet";
  }
  EXPECT_EQ(session.pool().usage().in_use, Image::bytes_needed(QUELL_TYPE_COLOR, source.size));
}

TEST(SessionHistory, IsThatOfTheNewRunWhenARunStartsAgain) {
  MemorySource source;
  Session session(test_graph(kSumGraph));
  MemorySink first, second;
  session.run({1, 2, 3}, source, first);
  source.paint = [](Image& image, std::int64_t) { image.writable_floats().at(0, 0) = 100.0F; };
  session.run({1, 2, 3, 4}, source, second);
  EXPECT_EQ(second.pixel("color", 4), 400.0F);
}

TEST(SessionHistory, EndsAtCuts) {
  for (const Schedule schedule : {Schedule::serial, Schedule::concurrent}) {
    MemorySource source;
    MemorySink sink;
    Session session(test_graph(kSumGraph), {.threads = 2, .schedule = schedule, .cuts = {6, 4}});
    session.run({1, 2, 3, 4, 5, 6, 7}, source, sink);
    const std::vector<float> want = {1, 3, 6, 4, 9, 6, 13};
    for (std::int64_t frame = 1; frame <= 7; ++frame)
      EXPECT_EQ(sink.pixel("color", frame), want[static_cast<std::size_t>(frame) - 1]) << frame;
  }
}

TEST(SessionHistory, EndsAtACutWhoseFrameIsNotPartOfTheRun) {
  MemorySource source;
  MemorySink sink;
  const auto graph = test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"sum": {"pass": "accumulate", "in": {"color": "color",
                      "history": {"from": "color", "delay": 3, "initial": "none"}}}},
    "outputs": {"color": "sum.color"}})");
  Session(graph, {.cuts = {4}}).run({1, 3, 6, 9}, source, sink);
  EXPECT_EQ(sink.pixel("color", 6), 6.0F) << "frame 3 lies beyond the cut";
  EXPECT_EQ(sink.pixel("color", 9), 15.0F) << "frame 6 does not";
}

TEST(SessionHistory, LooksAheadToACutOnly) {
  MemorySource source;
  MemorySink sink;
  const auto graph = test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"sum": {"pass": "accumulate", "in": {"color": "color",
                      "history": {"from": "color", "delay": -2, "initial": "none"}}}},
    "outputs": {"color": "sum.color"}})");
  Session(graph, {.cuts = {4}}).run({1, 2, 3, 4, 5, 6}, source, sink);
  const std::vector<float> want = {1 + 3, 2, 3, 4 + 6, 5, 6};
  for (std::int64_t frame = 1; frame <= 6; ++frame)
    EXPECT_EQ(sink.pixel("color", frame), want[static_cast<std::size_t>(frame) - 1]) << frame;
}

TEST(SessionHistory, EndsAtCutsOfPushedFrames) {
  BufferPool pool;
  Session session(test_graph(kSumGraph), {.cuts = {2}});
  session.push(1, {{"color", flat_color({4, 4}, 1.0F, pool)}});
  const auto cut = session.push(2, {{"color", flat_color({4, 4}, 10.0F, pool)}});
  EXPECT_EQ(cut.at("color").image()->floats().at(0, 0), 10.0F);
  const auto after = session.push(3, {{"color", flat_color({4, 4}, 100.0F, pool)}});
  EXPECT_EQ(after.at("color").image()->floats().at(0, 0), 110.0F);
}

// A graph whose history is as long as three frames, with a number that the caller gives.
const char* const kResetGraph = R"({"quell": 1, "inputs": {"color": "color", "cut": "value"},
  "nodes": {"sum": {"pass": "accumulate", "in": {"color": "color",
                    "history": {"from": "color", "delay": 3, "initial": "none"}}}},
  "outputs": {"color": "sum.color"}, "reset": "cut"})";

TEST(SessionHistory, EndsWhereAnInputOfTheGraphResetsIt) {
  BufferPool pool;
  Session session(test_graph(kResetGraph));
  const auto push = [&](std::int64_t frame, double cut) {
    const auto color = flat_color({4, 4}, static_cast<float>(frame), pool);
    return session.push(frame, {{"color", color}, {"cut", Values{cut}}}).at("color").image()->floats().at(0, 0);
  };
  EXPECT_EQ(push(1, 0), 1.0F);
  EXPECT_EQ(push(2, 0), 2.0F);
  EXPECT_EQ(push(3, 0.5), 3.0F);
  EXPECT_EQ(push(4, 0), 4.0F) << "frame 1 lies before the reset in frame 3";
  EXPECT_EQ(push(5, 0), 5.0F);
  EXPECT_EQ(push(6, 0), 9.0F) << "frame 3 itself does not";
  EXPECT_EQ(push(11, 0), 11.0F);
  EXPECT_EQ(push(12, 1), 12.0F);
  EXPECT_EQ(push(12, 0), 12.0F);
  EXPECT_EQ(push(14, 0), 14.0F + 11.0F) << "frame 12, when it was computed again, reset nothing";
}

}  // namespace
}  // namespace quell
