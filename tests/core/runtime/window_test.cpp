// How many frames at a time, and in how much memory.
#include "quell/runtime/window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/runtime/memory_stream.h"

namespace quell {
namespace {

using ::testing::HasSubstr;

constexpr Size kSize{100, 50};
const std::size_t kImage = Image::bytes_needed(QUELL_TYPE_COLOR, kSize);

Plan plan_of(const std::string& text) {
  return make_plan(test_graph(text), {{"color", Shape{QUELL_TYPE_COLOR, kSize, 0, true}}});
}

const char* const kOneLoop = kSumGraph;
const char* const kLoopAndMore = R"({"quell": 1, "inputs": {"color": "color"},
  "nodes": {"sum": {"pass": "accumulate", "in": {"color": "color", "history": {"from": "sum.color", "delay": 1, "initial": "none"}}},
            "copy": {"pass": "mix", "in": {"color": "sum.color", "other": "color"}}},
  "outputs": {"color": "copy.color"}})";

TEST(Window, GrowsWithThreads) {
  EXPECT_EQ(choose_window(plan_of(kLoopAndMore), 1, 0, 0).frames, 3);
  EXPECT_EQ(choose_window(plan_of(kLoopAndMore), 4, 0, 0).frames, 6);
  EXPECT_EQ(choose_window(plan_of(kLoopAndMore), 4, 0, 0).reason, "4 threads");
  EXPECT_EQ(choose_window(plan_of(kLoopAndMore), 500, 0, 0).frames, 16);
}

TEST(Window, IsSmallWhereALoopHoldsEveryNode) {
  const Window window = choose_window(plan_of(kOneLoop), 8, 0, 0);
  EXPECT_EQ(window.frames, 3) << "one in the loop, one being read, one being written";
  EXPECT_EQ(window.reason, "a loop holds every node");
}

TEST(Window, IsWhatWasAskedFor) { EXPECT_EQ(choose_window(plan_of(kOneLoop), 2, 7, 0).frames, 7); }

TEST(Window, CountsWhatAFrameAndTheHistoryTake) {
  const Window window = choose_window(plan_of(kOneLoop), 2, 0, 0);
  EXPECT_EQ(window.bytes_per_frame, kImage) << "the sum is written over the input";
  EXPECT_EQ(window.fixed_bytes, kImage);
}

TEST(Window, ShrinksToTheMemoryLimit) {
  const Window window = choose_window(plan_of(kOneLoop), 2, 7, 5 * kImage + 1);
  EXPECT_EQ(window.frames, 4);
  EXPECT_EQ(window.memory, 5 * kImage + 1);
  EXPECT_EQ(window.reason, "what the memory limit has room for");
}

TEST(Window, RefusesALimitWithoutRoomForAFrame) {
  try {
    choose_window(plan_of(kOneLoop), 2, 0, 2 * kImage - 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::memory);
    EXPECT_THAT(error.what(), HasSubstr("at least 1 MiB are needed; the limit is 1 MiB"));
  }
  EXPECT_EQ(choose_window(plan_of(kOneLoop), 2, 0, 2 * kImage).frames, 1);
}

TEST(Window, LeavesOthersHalfOfTheMemory) {
  const Window window = choose_window(plan_of(kOneLoop), 2, 0, 0);
  EXPECT_EQ(window.memory, available_memory() / 2);
  EXPECT_GT(window.memory, std::size_t{1} << 20);
}

}  // namespace
}  // namespace quell
