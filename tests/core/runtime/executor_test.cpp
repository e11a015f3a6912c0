#include "quell/runtime/executor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace quell {
namespace {

class ExecutorOf : public ::testing::TestWithParam<ThreadSource> {};

TEST_P(ExecutorOf, RunsEveryChunkOnce) {
  for (const int threads : {1, 2, 8}) {
    const auto executor = make_executor(threads, GetParam());
    EXPECT_EQ(executor->slots(), static_cast<std::uint32_t>(threads));
    std::vector<std::atomic<int>> hits(1000);
    executor->run(1000, [&](std::int64_t chunk, std::uint32_t) { ++hits[static_cast<std::size_t>(chunk)]; });
    for (const auto& count : hits) EXPECT_EQ(count, 1);
  }
}

TEST_P(ExecutorOf, NeverGivesASlotToTwoChunksAtATime) {
  const auto executor = make_executor(4, GetParam());
  std::vector<std::atomic<int>> inside(executor->slots());
  std::atomic<bool> shared = false;
  executor->run(200, [&](std::int64_t, std::uint32_t slot) {
    if (inside[slot].fetch_add(1) != 0) shared = true;
    std::this_thread::yield();
    --inside[slot];
  });
  EXPECT_FALSE(shared);
}

TEST_P(ExecutorOf, RunsANestedLoopInlineWithTheSameSlot) {
  const auto executor = make_executor(4, GetParam());
  std::atomic<int> inner = 0;
  std::atomic<bool> strayed = false;
  executor->run(16, [&](std::int64_t, std::uint32_t slot) {
    const auto thread = std::this_thread::get_id();
    executor->run(10, [&](std::int64_t, std::uint32_t nested) {
      if (nested != slot || std::this_thread::get_id() != thread) strayed = true;
      ++inner;
    });
  });
  EXPECT_EQ(inner, 160);
  EXPECT_FALSE(strayed);
}

TEST_P(ExecutorOf, RunsInParallelAgainAfterANestedLoop) {
  const auto executor = make_executor(2, GetParam());
  std::atomic<int> count = 0;
  executor->run(2, [&](std::int64_t, std::uint32_t) { executor->run(3, [&](std::int64_t, std::uint32_t) { ++count; }); });
  executor->run(5, [&](std::int64_t, std::uint32_t) { ++count; });
  EXPECT_EQ(count, 11);
}

TEST_P(ExecutorOf, DoesNothingForNoChunks) {
  make_executor(2, GetParam())->run(0, [](std::int64_t, std::uint32_t) { FAIL(); });
}

TEST_P(ExecutorOf, TakesLoopsFromSeveralThreads) {
  const auto executor = make_executor(2, GetParam());
  std::atomic<int> count = 0;
  {
    std::vector<std::jthread> callers;
    for (int t = 0; t < 4; ++t)
      callers.emplace_back([&] {
        for (int i = 0; i < 20; ++i) executor->run(10, [&](std::int64_t, std::uint32_t) { ++count; });
      });
  }
  EXPECT_EQ(count, 800);
}

TEST_P(ExecutorOf, TakesLoopsFromMoreThreadsThanItHas) {
  const auto executor = make_executor(1, GetParam());
  std::atomic<int> count = 0;
  std::atomic<bool> strayed = false;
  {
    std::vector<std::jthread> callers;
    for (int t = 0; t < 4; ++t)
      callers.emplace_back([&] {
        for (int i = 0; i < 20; ++i)
          executor->run(10, [&](std::int64_t, std::uint32_t slot) { ++count, strayed = strayed || slot != 0; });
      });
  }
  EXPECT_EQ(count, 800);
  EXPECT_FALSE(strayed);
}

// A program may hold several sessions, and a source may use one of its own to serve another.
TEST_P(ExecutorOf, KeepsSlotsOfItsOwnWithinABodyOfAnother) {
  const auto outer = make_executor(4, GetParam()), inner = make_executor(1, GetParam());
  std::atomic<bool> strayed = false;
  std::atomic<int> count = 0;
  outer->run(16, [&](std::int64_t, std::uint32_t slot) {
    inner->run(3, [&](std::int64_t, std::uint32_t of_inner) { ++count, strayed = strayed || of_inner >= inner->slots(); });
    outer->run(1, [&](std::int64_t, std::uint32_t nested) { strayed = strayed || nested != slot; });
  });
  EXPECT_EQ(count, 48);
  EXPECT_FALSE(strayed);
}

// A race detector cannot follow oneTBB as Debian builds it.
#ifdef __SANITIZE_THREAD__
INSTANTIATE_TEST_SUITE_P(Threads, ExecutorOf, ::testing::Values(ThreadSource::threads));
#else
INSTANTIATE_TEST_SUITE_P(Tbb, ExecutorOf, ::testing::Values(ThreadSource::tbb));
INSTANTIATE_TEST_SUITE_P(Threads, ExecutorOf, ::testing::Values(ThreadSource::threads));
#endif

}  // namespace
}  // namespace quell
