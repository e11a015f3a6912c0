// Counts what is allocated: nodes take nothing from the system once the first frames have gone through.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "quell/runtime/node_runner.h"
#include "tests/core/runtime/counting_new.h"
#include "tests/core/runtime/memory_stream.h"

namespace quell {
namespace {

template <class Body>
std::size_t count_allocations(const Body& body) {
  const std::size_t before = test::allocations();
  body();
  return test::allocations() - before;
}

TEST(Allocations, AreSeenByThisProgram) {
  // Through volatile pointers, since a compiler may leave out what nobody uses.
  EXPECT_EQ(count_allocations([] {
              int* volatile one = new int;
              delete one;
              int* volatile three = new int[3];
              delete[] three;
            }),
            2U);
  BufferPool pool;
  EXPECT_GE(count_allocations([&] { pool.acquire(100); }), 1U) << "those of the library are not counted";
}

TEST(Allocations, AreNotNeededForIdleBlocks) {
  BufferPool pool;
  pool.set_limit(1000);
  const auto take_two = [&] { const Buffer a = pool.acquire(100), b = pool.acquire(100), c = pool.acquire(300); };
  take_two();
  EXPECT_EQ(count_allocations(take_two), 0U);
}

TEST(Allocations, AreNotNeededToCopyItems) {
  BufferPool pool;
  const Item items[] = {Item(), Image(QUELL_TYPE_COLOR, {8, 8}, pool), Camera(), Values{1, 2, 3}, Values(3, pool)};
  EXPECT_EQ(count_allocations([&] {
              for (const Item& item : items) {
                Item copy = item;
                copy = Item();
                copy = item;
              }
            }),
            0U);
}

class AllocationsOfANode : public testing::TestWithParam<ThreadSource> {
 protected:
  static constexpr Size kSize{64, 200};
  BufferPool pool;
  Executor executor{2, GetParam()};
  HostServices services{.executor = &executor};
};

TEST_P(AllocationsOfANode, AreNoneAfterTheFirstFrames) {
  const std::shared_ptr<const Graph> graph = test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {"toil": {"pass": "toil", "in": {"color": "color"}}}, "outputs": {"color": "toil.color"}})");
  const NodeLayout layout{.outputs = {{{QUELL_TYPE_COLOR, kSize}}, {{QUELL_TYPE_VALUE, {}, 3}}},
                          .in_place_of = {0, -1},
                          .scratch_bytes = 64 * 200 * sizeof(float),
                          .slot_scratch_bytes = 64 * sizeof(float)};
  NodeRunner runner("toil", *graph->nodes[0].instance, layout, services, pool);

  // What a frame leaves is the next one's history. In every other frame the color is held by somebody else, too, so that it
  // cannot be written over.
  const Image first = flat_color(kSize, 1.0F, pool);
  PortItems inputs{{Item()}, {Item()}, {Item()}, {Item()}}, outputs;
  Item history, counts;
  const auto run_frames = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t frame = begin; frame < end; ++frame) {
      inputs[0][0] = frame % 2 == 0 ? first : Image(QUELL_TYPE_COLOR, kSize, pool);
      inputs[1][0] = std::move(history);
      inputs[2][0] = counts;
      inputs[3][0] = std::move(counts);
      runner.run(frame, inputs, outputs);
      history = std::exchange(outputs[0][0], {});
      counts = std::exchange(outputs[1][0], {});
    }
  };
  run_frames(0, 20);
  EXPECT_EQ(count_allocations([&] { run_frames(20, 120); }), 0U);
  EXPECT_EQ(*counts.values(), Values({std::exp2(120) - 1, std::exp2(120) - 1, std::exp2(120) - 1}));
}

INSTANTIATE_TEST_SUITE_P(Threads, AllocationsOfANode, testing::Values(ThreadSource::threads));
#ifndef __SANITIZE_THREAD__
INSTANTIATE_TEST_SUITE_P(Tbb, AllocationsOfANode, testing::Values(ThreadSource::tbb));
#endif

// A chain in which every other node reads its own former color, which is therefore kept; what the others yield is written over.
// All have values, scratch, and a history of values.
std::string chain(int length) {
  std::string nodes;
  std::string color = "color", counts;
  for (int i = 0; i < length; ++i) {
    const std::string name = "n" + std::to_string(i);
    nodes += (i == 0 ? "\"" : ", \"") + name + R"(": {"pass": "toil", "in": {"color": ")" + color + "\"";
    if (i > 0) nodes += R"(, "counts": ")" + counts + "\"";
    if (i % 2 == 0) nodes += R"(, "history": {"from": ")" + name + R"(.color", "delay": 1, "initial": "none"})";
    nodes += R"(, "former": {"from": ")" + name + R"(.counts", "delay": 2, "initial": "none"}}})";
    color = name + ".color", counts = name + ".counts";
  }
  return R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {)" + nodes + R"(}, "outputs": {"color": ")" + color +
         R"(", "counts": ")" + counts + R"("}})";
}

// All of its nodes run together, and each reads what it made before.
std::string fused_chain(int length) {
  std::string nodes, color = "color";
  for (int i = 0; i < length; ++i) {
    const std::string name = "n" + std::to_string(i);
    nodes += (i == 0 ? "\"" : ", \"") + name + R"(": {"pass": "accumulate", "in": {"color": ")" + color +
             R"(", "history": {"from": ")" + name + R"(.color", "delay": 1, "initial": "none"}}})";
    color = name + ".color";
  }
  return R"({"quell": 1, "inputs": {"color": "color"}, "nodes": {)" + nodes + R"(}, "outputs": {"color": ")" + color + R"("}})";
}

// In the frames after the first ones.
std::size_t count_pushing(const std::string& graph, int threads) {
  BufferPool pool;
  const std::map<std::string, Item> inputs{{"color", flat_color({32, 24}, 1.0F, pool)}};
  Session session(test_graph(graph), {.threads = threads});
  std::int64_t frame = 0;
  const auto push_frames = [&](std::int64_t end) {
    for (; frame < end; ++frame) session.push(frame, inputs);
  };
  push_frames(20);
  return count_allocations([&] { push_frames(120); });
}

TEST(AllocationsOfASession, AreTheSameForOneNodeAndForFortyThatArePushed) {
  for (const int threads : {1, 2}) {
    const std::size_t one = count_pushing(chain(1), threads);
    EXPECT_EQ(count_pushing(chain(40), threads), one) << threads << " threads";
    EXPECT_GT(one, 0U) << "the map of outputs at least";
  }
}

TEST(AllocationsOfASession, AreTheSameForOneNodeAndForFortyThatAreFused) {
  for (const int threads : {1, 2}) EXPECT_EQ(count_pushing(fused_chain(40), threads), count_pushing(fused_chain(1), threads));
}

// Hands out one image, over and over, and lets results go.
class OneImage final : public FrameSource, public FrameSink {
 public:
  std::optional<Shape> shape(std::string_view) override { return shape_of(image_); }
  Item read(std::string_view, std::int64_t, BufferPool&) override { return image_; }
  void write(std::string_view, std::int64_t, const Item&) override {}

 private:
  BufferPool pool_;
  Item image_ = flat_color({32, 24}, 1.0F, pool_);
};

std::size_t count_running(int nodes, Schedule schedule) {
  OneImage stream;
  Session session(test_graph(chain(nodes)), {.threads = 2, .schedule = schedule, .frames_in_flight = 4});
  const auto run_frames = [&](std::int64_t begin, std::int64_t end) {
    std::vector<std::int64_t> frames(static_cast<std::size_t>(end - begin));
    std::iota(frames.begin(), frames.end(), begin);
    session.run(frames, stream, stream);
  };
  run_frames(0, 100);
  return count_allocations([&] { run_frames(100, 300); });
}

TEST(AllocationsOfASession, AreTheSameForOneNodeAndForFortyInASerialRun) {
  EXPECT_EQ(count_running(40, Schedule::serial), count_running(1, Schedule::serial));
}

// How far frames overlap differs from run to run, and with it how many blocks the pool comes to need and how often a list grows.
// One allocation a node and frame would be 7,800 more.
TEST(AllocationsOfASession, AreAboutTheSameForOneNodeAndForFortyInAConcurrentRun) {
  EXPECT_LT(count_running(40, Schedule::concurrent), count_running(1, Schedule::concurrent) + 780);
}

}  // namespace
}  // namespace quell
