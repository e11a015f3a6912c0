#include <gtest/gtest.h>

#include <thread>

#include "quell/sdk/pass.h"
#include "tests/core/sdk/fake_host.h"

namespace quell::test {
namespace {

const std::vector<PortInfo> kNoPorts;

struct Rows : testing::Test {
  FakeHost host;
  quell_exec exec{sizeof(quell_exec), 0, 0, 2, 0, nullptr, nullptr, nullptr, nullptr};
  Frame frame{kNoPorts, kNoPorts, host.raw, exec};
};
using ParallelRows = Rows;

TEST_F(ParallelRows, CoverTheImageOnceInBandsOfEight) {
  std::vector<std::pair<int, int>> bands;
  frame.parallel_rows(20, [&](int y0, int y1) { bands.emplace_back(y0, y1); });
  EXPECT_EQ(bands, (std::vector<std::pair<int, int>>{{0, 8}, {8, 16}, {16, 20}}));
}

TEST_F(ParallelRows, TakeAnotherHeightOfBands) {
  std::vector<std::pair<int, int>> bands;
  frame.parallel_rows(
      3, [&](int y0, int y1) { bands.emplace_back(y0, y1); }, 2);
  EXPECT_EQ(bands, (std::vector<std::pair<int, int>>{{0, 2}, {2, 3}}));
}

TEST_F(ParallelRows, TellTheBodyItsSlot) {
  std::vector<std::uint32_t> slots;
  frame.parallel_rows(20, [&](int, int, std::uint32_t slot) { slots.push_back(slot); });
  EXPECT_EQ(slots, (std::vector<std::uint32_t>{0, 1, 0}));
}

TEST_F(ParallelRows, PassOnTheExceptionOfTheTopmostBand) {
  for (const bool backwards : {false, true}) {
    host.backwards = backwards;
    try {
      frame.parallel_rows(40, [](int y0, int) {
        if (y0 >= 16) throw std::runtime_error("row " + std::to_string(y0));
      });
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) { EXPECT_STREQ(error.what(), "row 16"); }
  }
}

TEST_F(ParallelRows, RunTheOtherBandsWhenOneFails) {
  int bands = 0;
  EXPECT_THROW(frame.parallel_rows(40,
                                   [&](int, int) {
                                     ++bands;
                                     throw 42;
                                   }),
               int);
  EXPECT_EQ(bands, 5);
}

TEST_F(ParallelRows, StopWhenCancelled) {
  host.cancel_at = 2;
  int bands = 0;
  EXPECT_THROW(frame.parallel_rows(80, [&](int, int) { ++bands; }), Cancelled);
  EXPECT_EQ(bands, 2);
}

TEST_F(ParallelRows, PreferTheErrorOfABandToBeingCancelled) {
  host.cancel_at = 2;
  EXPECT_THROW(frame.parallel_rows(80,
                                   [](int y0, int) {
                                     if (y0 == 8) throw std::domain_error("8");
                                   }),
               std::domain_error);
}

TEST_F(ParallelRows, ReportAHostThatFails) {
  host.raw.parallel_for = [](const quell_host*, std::int64_t, std::int64_t, std::int64_t, quell_chunk_fn, void*) {
    return QUELL_FAILED;
  };
  EXPECT_THROW(frame.parallel_rows(8, [](int, int) {}), std::runtime_error);
}

// Every band throws at once: the choice among them must not depend on who comes first.
TEST_F(ParallelRows, ChooseTheTopmostErrorAmongThreads) {
  host.raw.parallel_for = [](const quell_host*, std::int64_t begin, std::int64_t end, std::int64_t grain, quell_chunk_fn fn,
                             void* context) {
    std::vector<std::jthread> threads;
    for (std::int64_t from = begin, chunk = 0; from < end; from += grain, ++chunk)
      threads.emplace_back([=] { fn(context, chunk, from, from + grain, 0); });
    return QUELL_FAILED;
  };
  for (int i = 0; i < 20; ++i) {
    try {
      frame.parallel_rows(64, [](int y0, int) { throw y0; });
      FAIL() << "nothing was thrown";
    } catch (const int y0) { EXPECT_EQ(y0, 0); }
  }
}

}  // namespace
}  // namespace quell::test
