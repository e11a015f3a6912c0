#include "quell/runtime/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "tests/core/runtime/memory_stream.h"

namespace quell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<bool> oks(const std::vector<FrameReport>& reports) {
  std::vector<bool> list;
  for (const FrameReport& report : reports) list.push_back(report.ok);
  return list;
}

TEST(Session, CarriesHistoryFromFrameToFrame) {
  MemorySource source;
  MemorySink sink;
  Session session(test_graph(kSumGraph));
  const auto reports = session.run({1, 2, 3, 4}, source, sink);
  EXPECT_THAT(oks(reports), ElementsAre(true, true, true, true));
  EXPECT_EQ(sink.pixel("color", 1), 1.0F);
  EXPECT_EQ(sink.pixel("color", 4, 7, 5), 1.0F + 2.0F + 3.0F + 4.0F);
}

TEST(Session, CountsADelayInFrameNumbers) {
  MemorySource source;
  MemorySink sink;
  Session session(test_graph(kSumGraph));
  session.run({1, 2, 5, 6}, source, sink);
  EXPECT_EQ(sink.pixel("color", 2), 3.0F);
  EXPECT_EQ(sink.pixel("color", 5), 5.0F) << "frame 4 was not computed, so there is no history";
  EXPECT_EQ(sink.pixel("color", 6), 11.0F);
}

TEST(Session, ReachesBackAsFarAsTheDelay) {
  MemorySource source;
  MemorySink sink;
  Session session(test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"sum": {"pass": "accumulate", "in": {"color": "color", "history": {"from": "color", "delay": 3, "initial": "none"}}}},
    "outputs": {"color": "sum.color"}})"));
  session.run({0, 1, 2, 3, 4, 5}, source, sink);
  EXPECT_EQ(sink.pixel("color", 2), 2.0F);
  EXPECT_EQ(sink.pixel("color", 3), 3.0F + 0.0F);
  EXPECT_EQ(sink.pixel("color", 5), 5.0F + 2.0F);
}

TEST(Session, StandsInAConstantWhereThereIsNoHistory) {
  MemorySource source;
  MemorySink sink;
  Session session(test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"sum": {"pass": "accumulate",
                      "in": {"color": "color", "history": {"from": "sum.color", "delay": 1, "initial": {"constant": [10, 20, 30]}}}}},
    "outputs": {"color": "sum.color"}})"));
  session.run({1, 2}, source, sink);
  const FloatImage first = sink.items.at({"color", 1}).image()->floats();
  EXPECT_EQ(first.at(3, 3, 0), 11.0F);
  EXPECT_EQ(first.at(3, 3, 1), 21.0F);
  EXPECT_EQ(first.at(3, 3, 2), 31.0F);
  EXPECT_EQ(sink.pixel("color", 2), 13.0F);
}

TEST(Session, StandsInAValueOfTheSameFrameWhereThereIsNoHistory) {
  MemorySource source;
  MemorySink sink;
  Session session(test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"sum": {"pass": "accumulate",
                      "in": {"color": "color", "history": {"from": "color", "delay": 1, "initial": {"from": "color"}}}}},
    "outputs": {"color": "sum.color"}})"));
  session.run({4, 5}, source, sink);
  EXPECT_EQ(sink.pixel("color", 4), 8.0F);
  EXPECT_EQ(sink.pixel("color", 5), 9.0F);
}

TEST(Session, LooksAheadOnInputs) {
  MemorySource source;
  MemorySink sink;
  Session session(test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"sum": {"pass": "accumulate", "in": {"color": "color", "history": {"from": "color", "delay": -2, "initial": "none"}}}},
    "outputs": {"color": "sum.color"}})"));
  session.run({1, 2, 3, 4}, source, sink);
  EXPECT_EQ(sink.pixel("color", 1), 4.0F);
  EXPECT_EQ(sink.pixel("color", 2), 6.0F);
  EXPECT_EQ(sink.pixel("color", 3), 3.0F) << "frame 5 is not part of the run";
  EXPECT_EQ(source.reads.size(), 4U) << "every frame is read once";
}

TEST(Session, RunsWithoutAnOptionalInput) {
  MemorySource source;
  source.absent = {"extra"};
  MemorySink sink;
  Session session(test_graph(R"({"quell": 1, "inputs": {"color": "color", "extra": {"type": "color", "optional": true}},
    "nodes": {"soft": {"pass": "mix", "in": {"color": "extra"}},
              "sum": {"pass": "accumulate", "in": {"color": "color", "history": "soft.color"}}},
    "outputs": {"color": "sum.color"}})"));
  session.run({7}, source, sink);
  EXPECT_EQ(sink.pixel("color", 7), 7.0F);
}

TEST(Session, CarriesValuesAndHandsThemOut) {
  MemorySource source;
  MemorySink sink;
  Session session(test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"count": {"pass": "count", "in": {"color": "color", "previous": {"from": "count.count", "delay": 1, "initial": "none"}}}},
    "outputs": {"count": "count.count"}})"));
  session.run({1, 2, 3}, source, sink);
  EXPECT_THAT(*sink.items.at({"count", 3}).values(), ElementsAre(3.0));
}

TEST(Session, HandsOutInnerImagesWhenAsked) {
  MemorySource source;
  MemorySink sink;
  Session session(test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"soft": {"pass": "mix", "in": {"color": "color"}}, "sum": {"pass": "accumulate", "in": {"color": "soft.color"}}},
    "outputs": {"color": "sum.color"}})"),
                  {.dumps = {"soft.color", "color"}});
  session.run({3}, source, sink);
  EXPECT_EQ(sink.pixel("soft.color", 3), 3.0F);
  EXPECT_EQ(sink.pixel("input.color", 3), 3.0F);
  EXPECT_EQ(sink.items.size(), 3U);
}

// A noisy picture, so that any difference in rounding or order would show.
void paint_noise(Image& image, std::int64_t frame) {
  std::uint32_t state = static_cast<std::uint32_t>(frame) * 2654435761u + 1;
  const FloatOutput view = image.writable_floats();
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        state = state * 1664525u + 1013904223u;
        view.at(x, y, c) = static_cast<float>(state >> 8) / 16777216.0F;
      }
}

TEST(Session, GivesTheSameBitsForAnyNumberOfThreads) {
  const char* const graph = R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"a": {"pass": "mix", "in": {"color": "color", "other": {"from": "b.color", "delay": 1, "initial": "none"}}, "params": {"weight": 0.5}},
              "b": {"pass": "mix", "in": {"color": "a.color", "other": {"from": "color", "delay": 2, "initial": {"constant": [0.1]}}}},
              "sum": {"pass": "accumulate", "in": {"color": "b.color", "history": {"from": "sum.color", "delay": 1, "initial": "none"}}}},
    "outputs": {"color": "sum.color"}})";
  const auto results = [&](int threads) {
    MemorySource source;
    source.size = {61, 47};
    source.paint = paint_noise;
    MemorySink sink;
    Session session(test_graph(graph), {.threads = threads});
    session.run({1, 2, 3, 4, 5}, source, sink);
    return sink.items;
  };
  const auto want = results(1);
  ASSERT_EQ(want.size(), 5U);
  for (const int threads : {2, 3, 8})
    for (const auto& [key, item] : results(threads)) {
      const FloatImage a = want.at(key).image()->floats(), b = item.image()->floats();
      for (int c = 0; c < 3; ++c)
        for (int y = 0; y < a.height; ++y)
          ASSERT_EQ(std::memcmp(a.row(y, c), b.row(y, c), sizeof(float) * static_cast<std::size_t>(a.width)), 0)
              << threads << " threads, frame " << key.second << ", row " << y;
    }
}

TEST(Session, ReplacesNanAndInfinityOnceAtTheEntrance) {
  MemorySource source;
  source.paint = [](Image& image, std::int64_t frame) {
    if (frame == 2) image.writable_floats().at(1, 1, 0) = std::numeric_limits<float>::quiet_NaN();
    if (frame == 2) image.writable_floats().at(2, 1, 1) = -std::numeric_limits<float>::infinity();
  };
  MemorySink sink;
  Session session(test_graph(kSumGraph));
  const auto reports = session.run({1, 2}, source, sink);
  EXPECT_TRUE(reports[0].replaced.empty());
  ASSERT_EQ(reports[1].replaced.size(), 1u);
  EXPECT_EQ(describe(reports[1].replaced[0]), "color: 2 values were NaN or infinite and count as 0");
  EXPECT_EQ(sink.pixel("color", 2, 1, 1), 1.0F);
  EXPECT_EQ(sink.pixel("color", 2, 0, 0), 3.0F);
}

TEST(Session, TakesNoMoreMemoryAfterTheFirstFrames) {
  MemorySource source;
  Session session(test_graph(kSumGraph));
  MemorySink sink;
  session.run({1, 2, 3, 4}, source, sink);
  sink.items.clear();
  const auto warm = session.pool().usage();
  for (std::int64_t frame = 5; frame < 40; ++frame) {
    session.run({frame}, source, sink);
    sink.items.clear();
  }
  EXPECT_EQ(session.pool().usage().allocated, warm.allocated);
}

TEST(Session, RunsFramesPushedFromMemory) {
  BufferPool pool;
  Session session(test_graph(kSumGraph));
  session.push(1, {{"color", flat_color({4, 4}, 1.0F, pool)}});
  const auto outputs = session.push(2, {{"color", flat_color({4, 4}, 2.0F, pool)}});
  EXPECT_EQ(outputs.at("color").image()->floats().at(0, 0), 3.0F);
}

TEST(Session, LeavesPushedImagesAsTheyWere) {
  BufferPool pool;
  Image image = flat_color({4, 4}, 1.0F, pool);
  image.writable_floats().at(0, 0) = std::numeric_limits<float>::infinity();
  Session session(test_graph(kSumGraph));
  session.push(1, {{"color", image}});
  session.push(2, {{"color", image}});
  EXPECT_EQ(image.floats().at(0, 0), std::numeric_limits<float>::infinity());
  EXPECT_EQ(image.floats().at(1, 0), 1.0F);
}

TEST(Session, SaysWhichInputsAGraphHas) {
  BufferPool pool;
  Session session(test_graph(kSumGraph));
  try {
    session.push(1, {{"colour", flat_color({4, 4}, 1.0F, pool)}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::usage);
    EXPECT_THAT(error.what(), HasSubstr("the graph has no input 'colour'; did you mean 'color'?"));
  }
}

}  // namespace
}  // namespace quell
