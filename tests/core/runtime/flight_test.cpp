// Which nodes of which frames may run, without any thread.
#include "quell/runtime/flight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/core/runtime/memory_stream.h"

namespace quell {
namespace {

using ::testing::ElementsAre;

// a -> b -> c in each frame, and a reads b of the frame before.
const char* const kLoop = R"({"quell": 1, "inputs": {"color": "color"},
  "nodes": {"a": {"pass": "accumulate", "in": {"color": "color", "history": {"from": "b.color", "delay": 1, "initial": "none"}}},
            "b": {"pass": "mix", "in": {"color": "a.color", "other": "color"}},
            "c": {"pass": "mix", "in": {"color": "b.color", "other": "color"}}},
  "outputs": {"color": "c.color"}})";

// Two nodes that need nothing of each other, and one that needs both.
const char* const kBranches = R"({"quell": 1, "inputs": {"color": "color"},
  "nodes": {"left": {"pass": "mix", "in": {"color": "color", "other": "color"}},
            "right": {"pass": "mix", "in": {"color": "color", "other": "color"}},
            "sum": {"pass": "mix", "in": {"color": "left.color", "other": "right.color"}}},
  "outputs": {"color": "sum.color"}})";

struct FlightOf : ::testing::Test {
  BufferPool pool;
  std::vector<std::int64_t> frames = {1, 2, 3, 4, 5, 6};
  std::unique_ptr<PlanState> state;
  std::unique_ptr<Flight> flight;

  // `room`: bytes beside what the frames themselves take.
  void prepare(const char* text, int window_frames, std::size_t room = 1 << 20) {
    state = std::make_unique<PlanState>(
        make_plan(test_graph(text), {{"color", Shape{QUELL_TYPE_COLOR, {8, 6}, 0, true}}}, {}, false), window_frames, pool);
    Window window = choose_window(state->plan, 1, window_frames, 0);
    window.memory = window.fixed_bytes + window.bytes_per_frame * static_cast<std::size_t>(window_frames) + room;
    flight = std::make_unique<Flight>(frames);
    flight->use(*state, window, 1);
  }
  void begin_all() {
    while (flight->may_admit()) flight->admit();
    while (flight->begun() < flight->admitted()) flight->begin(true);
  }
  std::vector<std::pair<std::size_t, int>> take_all() {
    std::vector<std::pair<std::size_t, int>> taken;
    while (const auto node = flight->take()) taken.emplace_back(node->index, node->step);
    return taken;
  }
  using Node = std::pair<std::size_t, int>;
};

TEST_F(FlightOf, ALoopLetsOneFrameInAtATime) {
  prepare(kLoop, 3);
  begin_all();
  EXPECT_THAT(take_all(), ElementsAre(Node(0, 0)));
  EXPECT_FALSE(flight->complete({0, 0}));
  EXPECT_THAT(take_all(), ElementsAre(Node(0, 1)));
  EXPECT_FALSE(flight->complete({0, 1}));
  EXPECT_THAT(take_all(), ElementsAre(Node(0, 2), Node(1, 0))) << "what follows the loop overlaps with its next turn";
  EXPECT_TRUE(flight->complete({0, 2}));
}

TEST_F(FlightOf, AFrameWithoutItsPredecessorWaitsForNobody) {
  frames = {1, 3, 4};
  prepare(kLoop, 3);
  begin_all();
  EXPECT_THAT(take_all(), ElementsAre(Node(0, 0), Node(1, 0)));
  flight->complete({1, 0});
  flight->complete({1, 1});
  EXPECT_THAT(take_all(), ElementsAre(Node(1, 1), Node(1, 2), Node(2, 0))) << "in the order of frames, whatever came first";
}

TEST_F(FlightOf, NobodyWaitsForAFrameThatCannotBeRead) {
  prepare(kLoop, 3);
  while (flight->may_admit()) flight->admit();
  flight->begin(true);
  flight->begin(false);
  flight->begin(true);
  EXPECT_THAT(take_all(), ElementsAre(Node(0, 0), Node(2, 0)));
  flight->complete({0, 0});
  flight->complete({0, 1});
  EXPECT_THAT(take_all(), ElementsAre(Node(0, 1), Node(0, 2))) << "no node of the frame that cannot be read";
}

TEST_F(FlightOf, FramesAreAdmittedUpToTheWindow) {
  prepare(kBranches, 2);
  begin_all();
  EXPECT_EQ(flight->admitted(), 2U);
  flight->retire();
  EXPECT_TRUE(flight->may_admit());
  flight->admit();
  EXPECT_FALSE(flight->may_admit());
}

TEST_F(FlightOf, FramesAreAdmittedUpToTheMemoryLimit) {
  prepare(kBranches, 4, 0);
  Window window = choose_window(state->plan, 1, 4, 0);
  window.memory = window.fixed_bytes + 2 * window.bytes_per_frame;
  flight->use(*state, window, 1);
  begin_all();
  EXPECT_EQ(flight->admitted(), 2U);
  flight->hold(0, true);  // its results alone are less than a whole frame, but not enough for one more
  EXPECT_FALSE(flight->may_admit());
  flight->retire();
  EXPECT_TRUE(flight->may_admit());
}

TEST_F(FlightOf, ANodeAheadOfItsTurnNeedsRoomOfItsOwn) {
  prepare(kBranches, 1, 0);
  begin_all();
  EXPECT_THAT(take_all(), ElementsAre(Node(0, 0))) << "the plan's order is always paid for";
  EXPECT_EQ(flight->ready(), 0U) << "those that there is no memory for do not keep anybody busy";
  flight->complete({0, 0});
  EXPECT_THAT(take_all(), ElementsAre(Node(0, 1)));

  prepare(kBranches, 1, Image::bytes_needed(QUELL_TYPE_COLOR, {8, 6}));
  begin_all();
  EXPECT_THAT(take_all(), ElementsAre(Node(0, 0), Node(0, 1)));
}

TEST_F(FlightOf, ChargesAreGivenBack) {
  frames.resize(100);
  std::iota(frames.begin(), frames.end(), 1);
  prepare(kBranches, 2, Image::bytes_needed(QUELL_TYPE_COLOR, {8, 6}));
  std::vector<FrameStep> running;
  while (flight->retired() < frames.size()) {
    begin_all();
    EXPECT_EQ(flight->admitted() - flight->retired(), std::min<std::size_t>(2, frames.size() - flight->retired()));
    while (const auto node = flight->take()) running.push_back(*node);
    ASSERT_FALSE(running.empty());
    std::ranges::sort(running);
    const FrameStep first = running.front();
    running.erase(running.begin());
    if (!flight->complete(first)) continue;
    ASSERT_EQ(first.index, flight->retired());
    flight->hold(first.index, true);
    flight->hold(first.index, false);
    flight->retire();
  }
}

}  // namespace
}  // namespace quell
