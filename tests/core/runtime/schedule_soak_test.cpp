// Many small frames: memory stays what it was, and nothing stalls.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <numeric>

#include "quell/runtime/window.h"
#include "tests/core/runtime/memory_stream.h"
#include "tests/core/runtime/schedule_run.h"

namespace quell::test {
namespace {

#ifdef __SANITIZE_THREAD__
constexpr std::int64_t kFrames = 500;
#else
constexpr std::int64_t kFrames = 2000;
#endif
constexpr std::int64_t kWarm = 200;

std::size_t resident_bytes() {
  std::size_t total = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

struct Memory {
  BufferPool::Usage pool;
  std::size_t resident = 0;
};

std::shared_ptr<const Graph> graph_with_loops() {
  return test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {
      "soft": {"pass": "soften", "in": {"color": "color"}},
      "fast": {"pass": "stir", "params": {"in_place": true},
               "in": {"color": "soft.color", "other": {"from": "fast.color", "delay": 1, "initial": "none"}}},
      "slow": {"pass": "stir", "in": {"color": "fast.color", "other": {"from": "slow.color", "delay": 3, "initial": {"constant": [9]}}}},
      "turned": {"pass": "shelter", "in": {"color": "slow.color"}},
      "parts": {"pass": "parts", "in": {"color": "turned.color", "items": ["soft.color", "slow.color"]}},
      "last": {"pass": "stir", "in": {"color": "parts.items[0]", "other": "parts.items[1]"}}},
    "outputs": {"last": "last.color", "turned": "turned.color"}})");
}

std::vector<std::int64_t> many_frames() {
  std::vector<std::int64_t> frames(kFrames);
  std::iota(frames.begin(), frames.end(), 1);
  return frames;
}

constexpr Size kSize{16, 12};

class Soak : public testing::TestWithParam<int> {};

TEST_P(Soak, NeitherGrowsNorStalls) {
  const std::vector<std::int64_t> frames = many_frames();
  std::vector<std::int64_t> told;
  PatternSource source({{"color"}}, {.frames = frames, .size = kSize});
  RecordingSink sink;
  Memory warm;
  SessionOptions options = concurrent({4, GetParam()});
  Session* running = nullptr;
  options.on_frame = [&](const FrameReport& report) {
    EXPECT_TRUE(report.ok) << report.error;
    told.push_back(report.frame);
    sink.take();
    if (report.frame == kWarm) warm = {running->pool().usage(), resident_bytes()};
  };
  Session session(graph_with_loops(), options);
  running = &session;
  session.run(frames, source, sink);
  EXPECT_EQ(told, frames);

  const Memory end{session.pool().usage(), resident_bytes()};
  std::printf(
      "%d frames in flight: %zu blocks and a peak of %zu KiB after %d frames, %zu and %zu KiB at the end; %zu and %zu MiB "
      "resident\n",
      GetParam(), warm.pool.allocated, warm.pool.peak >> 10, static_cast<int>(kWarm), end.pool.allocated, end.pool.peak >> 10,
      warm.resident >> 20, end.resident >> 20);
  // How much the frames overlap is a matter of time. But there is a bound from the first frame on, for each size of block
  // (images, scratch, slots' scratch), and each block was taken once.
  const Window window = choose_window(*session.plan(), 4, GetParam(), 0);
  const std::size_t most_in_use = window.fixed_bytes + static_cast<std::size_t>(window.frames) * window.bytes_per_frame;
  EXPECT_LE(end.pool.peak, 3 * most_in_use);
  EXPECT_EQ(end.pool.in_use + end.pool.idle, end.pool.peak);
  EXPECT_LT(end.resident, warm.resident + (std::size_t{64} << 20));
}

TEST_P(Soak, WithinATightLimitNeitherGrowsNorStalls) {
  const std::vector<std::int64_t> frames = many_frames();
  PatternSource source({{"color"}}, {.frames = frames, .size = kSize});
  const auto graph = graph_with_loops();
  const Window window = choose_window(make_plan(graph, {{"color", source.shape("color")}}), 4, 1, 0);
  SessionOptions options = concurrent({4, GetParam()});
  options.memory = window.fixed_bytes + 5 * window.bytes_per_frame / 2;
  std::vector<std::int64_t> told;
  RecordingSink sink;
  options.on_frame = [&](const FrameReport& report) {
    EXPECT_TRUE(report.ok) << report.error;
    told.push_back(report.frame);
    sink.take();
  };
  Session session(graph, options);
  session.run(frames, source, sink);
  EXPECT_EQ(told, frames);
  EXPECT_LE(session.pool().usage().peak, options.memory);
}

INSTANTIATE_TEST_SUITE_P(Windows, Soak, testing::Values(1, 4, 8));

}  // namespace
}  // namespace quell::test
