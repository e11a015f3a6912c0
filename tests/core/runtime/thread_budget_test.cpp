// Computing, decoding and encoding share one number of threads.
#include "quell/runtime/thread_budget.h"

#include <gtest/gtest.h>

#include <thread>

#include "quell/runtime/executor.h"

namespace quell {
namespace {

TEST(ThreadBudget, LendsNoMoreThanItHas) {
  ThreadBudget budget(2);
  EXPECT_TRUE(budget.try_take());
  EXPECT_TRUE(budget.try_take());
  EXPECT_FALSE(budget.try_take());
  budget.give_back();
  EXPECT_TRUE(budget.try_take());
}

TEST(ThreadBudget, TellsOnceWhoAskedInVain) {
  ThreadBudget budget(1);
  int told = 0;
  budget.on_free([&] { ++told; });
  budget.try_take();
  budget.give_back();
  EXPECT_EQ(told, 0) << "nobody asked";
  budget.try_take();
  EXPECT_FALSE(budget.try_take(true));
  budget.give_back();
  EXPECT_EQ(told, 1);
  budget.try_take();
  budget.give_back();
  EXPECT_EQ(told, 1);
}

TEST(ThreadBudget, GivesFilesWayBeforeComputing) {
  ThreadBudget budget(1);
  ASSERT_TRUE(budget.try_take());
  std::jthread file([&] {
    budget.take();
    budget.give_back();
  });
  while (!budget.is_wanted()) std::this_thread::yield();
  EXPECT_FALSE(budget.try_take());
  budget.give_back();
  file.join();
  EXPECT_TRUE(budget.try_take());
}

class BudgetOf : public ::testing::TestWithParam<ThreadSource> {};

TEST_P(BudgetOf, AnExecutorHasAHelperOnlyWithin) {
  Executor executor(4, GetParam());
  for (int i = 0; i < 4; ++i) executor.budget().try_take();  // the caller's own, and three that decode
  const auto caller = std::this_thread::get_id();
  std::atomic<bool> strayed = false;
  executor.run(200, [&](std::int64_t, std::uint32_t) { strayed = strayed || std::this_thread::get_id() != caller; });
  EXPECT_FALSE(strayed);
}

TEST_P(BudgetOf, HelpersGiveBackWhatTheyTook) {
  Executor executor(3, GetParam());
  for (int i = 0; i < 50; ++i) executor.run(64, [](std::int64_t, std::uint32_t) { std::this_thread::yield(); });
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(executor.budget().try_take());
  EXPECT_FALSE(executor.budget().try_take());
}

TEST_P(BudgetOf, TasksRunOnWorkersAndMayHoldLoops) {
  Executor executor(2, GetParam());
  std::atomic<int> chunks = 0, tasks = 0;
  const auto task = [&] {
    executor.run(10, [&](std::int64_t, std::uint32_t) { ++chunks; });
    ++tasks;
  };
  for (int i = 0; i < 20; ++i) executor.spawn(task);
  while (tasks < 20) std::this_thread::yield();
  EXPECT_EQ(chunks, 200);
}

#ifdef __SANITIZE_THREAD__
INSTANTIATE_TEST_SUITE_P(Threads, BudgetOf, ::testing::Values(ThreadSource::threads));
#else
INSTANTIATE_TEST_SUITE_P(Tbb, BudgetOf, ::testing::Values(ThreadSource::tbb));
INSTANTIATE_TEST_SUITE_P(Threads, BudgetOf, ::testing::Values(ThreadSource::threads));
#endif

}  // namespace
}  // namespace quell
