#include "quell/image/buffer_pool.h"

#include <gtest/gtest.h>

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
#endif

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
