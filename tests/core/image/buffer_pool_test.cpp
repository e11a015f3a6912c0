#include "quell/image/buffer_pool.h"

#include <gtest/gtest.h>

#include <barrier>
#include <cmath>
#include <cstdint>
#include <new>
#include <optional>
#include <thread>
#include <vector>

namespace quell {
namespace {

TEST(BufferPool, HandsOutAlignedMemoryAndCountsIt) {
  BufferPool pool;
  const Buffer a = pool.acquire(100);
  const Buffer b = pool.acquire(1000);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(a.data()) % 64, 0U);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(b.data()) % 64, 0U);
  EXPECT_EQ(pool.usage().in_use, 1100U);
  EXPECT_EQ(pool.usage().idle, 0U);
  EXPECT_EQ(pool.usage().allocated, 2U);
}

TEST(BufferPool, ReusesABlockOfTheSameSizeOnly) {
  BufferPool pool;
  const void* first = nullptr;
  {
    const Buffer a = pool.acquire(256);
    first = a.data();
  }
  EXPECT_EQ(pool.usage().idle, 256U);
  const Buffer other_size = pool.acquire(512);
  EXPECT_EQ(pool.usage().allocated, 2U);
  const Buffer again = pool.acquire(256);
  EXPECT_EQ(again.data(), first);
  EXPECT_EQ(pool.usage().allocated, 2U);
  EXPECT_EQ(pool.usage().idle, 0U);
}

TEST(BufferPool, KeepsTheLargestSumAsPeak) {
  BufferPool pool;
  {
    const Buffer a = pool.acquire(100);
    const Buffer b = pool.acquire(200);
  }
  const Buffer c = pool.acquire(100);
  EXPECT_EQ(pool.usage().peak, 300U);
  EXPECT_EQ(pool.usage().in_use, 100U);
  EXPECT_EQ(pool.usage().idle, 200U);
}

TEST(BufferPool, GivesIdleBlocksBackWhenTrimmed) {
  BufferPool pool;
  pool.acquire(100);
  EXPECT_EQ(pool.usage().idle, 100U);
  pool.trim();
  EXPECT_EQ(pool.usage().idle, 0U);
}

// Sanitizers take a request that large for a mistake of the program.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(BufferPool, GivesIdleBlocksBackBeforeItGivesUp) {
  BufferPool pool;
  pool.acquire(100);
  EXPECT_THROW(pool.acquire(std::size_t{1} << 60), std::bad_alloc);
  EXPECT_EQ(pool.usage().idle, 0U);
}

TEST(BufferPool, CountsNothingOfARequestThatFailed) {
  BufferPool pool;
  const Buffer a = pool.acquire(100);
  EXPECT_THROW(pool.acquire(std::size_t{1} << 60), std::bad_alloc);
  EXPECT_EQ(pool.usage().in_use, 100U);
  EXPECT_EQ(pool.usage().peak, 100U);
  EXPECT_EQ(pool.usage().allocated, 1U);
}
#endif

TEST(BufferPool, GivesTheLargestIdleBlocksBackWhenTheLimitIsNear) {
  BufferPool pool;
  pool.set_limit(1000);
  { const Buffer a = pool.acquire(100), b = pool.acquire(200), c = pool.acquire(200), d = pool.acquire(300); }
  EXPECT_EQ(pool.usage().idle, 800U);
  const Buffer fits = pool.acquire(150);
  EXPECT_EQ(pool.usage().idle, 800U);
  const Buffer other = pool.acquire(350);  // makes 1300 with the idle ones
  EXPECT_EQ(pool.usage().idle, 500U);
  EXPECT_EQ(pool.usage().peak, 1000U);
  const auto before = pool.usage().allocated;
  const Buffer again = pool.acquire(200);
  EXPECT_EQ(pool.usage().allocated, before);
}

TEST(BufferPool, KeepsNothingIdleWhileMoreThanTheLimitIsInUse) {
  BufferPool pool;
  pool.set_limit(1000);
  pool.acquire(100);
  Buffer a = pool.acquire(800);
  Buffer b = pool.acquire(600);
  EXPECT_EQ(pool.usage().in_use, 1400U);
  EXPECT_EQ(pool.usage().idle, 0U);
  EXPECT_EQ(pool.usage().peak, 1400U);
  a = Buffer();
  EXPECT_EQ(pool.usage().idle, 0U) << "600 in use and 800 idle would be more than 1000";
  b = Buffer();
  EXPECT_EQ(pool.usage().idle, 600U);
}

TEST(BufferPool, GivesIdleBlocksBackWhenTheLimitIsLowered) {
  BufferPool pool;
  { const Buffer a = pool.acquire(100), b = pool.acquire(200), c = pool.acquire(300); }
  pool.set_limit(350);
  EXPECT_EQ(pool.usage().idle, 300U);
  pool.set_limit(0);
  const Buffer many = pool.acquire(5000);
  EXPECT_EQ(pool.usage().idle, 300U) << "without a limit nothing is given back";
}

// Each thread holds two blocks at most, of sizes that differ all the time, so idle ones pile up to the limit and are given back.
TEST(BufferPool, StaysWithinTheLimitOnSeveralThreads) {
  constexpr std::size_t kLargest = 64 * 40, kThreads = 4;
  BufferPool pool;
  pool.set_limit(kThreads * 2 * kLargest);
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < kThreads; ++t)
      threads.emplace_back([&pool, t] {
        Buffer held;
        for (std::size_t i = 0; i < 2000; ++i) {
          held = pool.acquire(64 * (1 + (7 * i + 11 * t) % 40));
          const BufferPool::Usage usage = pool.usage();
          ASSERT_LE(usage.in_use + usage.idle, kThreads * 2 * kLargest);
        }
      });
  }
  EXPECT_EQ(pool.usage().in_use, 0U);
  EXPECT_LE(pool.usage().peak, kThreads * 2 * kLargest);
  EXPECT_GT(pool.usage().allocated, 100U) << "sizes took turns";
}

TEST(BufferPool, CountsWhatThreadsTakeAtATimeInItsPeak) {
  constexpr std::size_t kThreads = 4, kBytes = std::size_t{8} << 20;
  BufferPool pool;
  for (std::size_t round = 1; round <= 20; ++round) {
    std::barrier start(kThreads), all_hold(kThreads);
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < kThreads; ++t)
      threads.emplace_back([&] {
        start.arrive_and_wait();
        const Buffer mine = pool.acquire(kBytes + round);
        all_hold.arrive_and_wait();
        ASSERT_TRUE(mine);
      });
    threads.clear();
    ASSERT_EQ(pool.usage().peak, kThreads * (kBytes + round));
    pool.trim();
  }
}

TEST(Buffer, IsUniqueUntilSomebodyElseHoldsIt) {
  BufferPool pool;
  const Buffer a = pool.acquire(64);
  EXPECT_TRUE(a.unique());
  {
    const Buffer b = a;  // NOLINT: the copy is the point
    EXPECT_FALSE(a.unique());
    EXPECT_EQ(b.data(), a.data());
  }
  EXPECT_TRUE(a.unique());
  EXPECT_EQ(pool.usage().in_use, 64U);
}

TEST(Buffer, MayOutliveItsPool) {
  std::optional<BufferPool> pool(std::in_place);
  Buffer a = pool->acquire(64);
  pool.reset();
  static_cast<char*>(a.data())[63] = 1;
  a = Buffer();
  EXPECT_FALSE(a);
}

TEST(Buffer, MayBeCopiedAndDroppedOnAnyThread) {
  BufferPool pool;
  {
    const Buffer shared = pool.acquire(4096);
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&pool, copy = shared] {
        for (int i = 0; i < 1000; ++i) {
          const Buffer mine = copy;  // NOLINT: the copy is the point
          const Buffer other = pool.acquire(128);
          ASSERT_TRUE(mine && other);
        }
      });
  }
  EXPECT_EQ(pool.usage().in_use, 0U);
  EXPECT_LE(pool.usage().allocated, 5U);
}

TEST(BufferPool, FillsBlocksWithNanWhenAsked) {
  BufferPool pool;
  pool.fill(0xff);
  const Buffer a = pool.acquire(64);
  EXPECT_TRUE(std::isnan(static_cast<const float*>(a.data())[15]));
}

}  // namespace
}  // namespace quell
