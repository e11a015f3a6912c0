#include "progress.h"

#include <gmock/gmock.h>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Progress, SaysFrameAndTimeOnPlainLines) { EXPECT_EQ(plain_line(3, 4, 12, 0.814), "frame 3 (4 of 12): 0.81 s"); }

TEST(Progress, FillsTheBarAsFramesAreDone) {
  EXPECT_EQ(progress_line({.total = 4}, 80), "[                              ]  0/4");
  EXPECT_EQ(progress_line({.done = 2, .total = 4, .frame = 8, .seconds = 4, .bytes = 3 << 20}, 90),
            "[###############               ]  2/4  frame 8  0.50 frames/s  4.0 s left  3.0 MiB");
  EXPECT_EQ(progress_line({.done = 4, .total = 4, .frame = 9, .seconds = 0.4, .bytes = 3 << 20}, 90),
            "[##############################]  4/4  frame 9  10 frames/s  3.0 MiB");
}

TEST(Progress, LeavesTheLastColumnFreeWhateverTheWidth) {
  const ProgressState state{.done = 999, .total = 100000, .frame = -12345, .seconds = 12345, .bytes = std::size_t{7} << 40};
  for (int columns = 0; columns < 200; ++columns)
    EXPECT_LT(progress_line(state, columns).size(), static_cast<std::size_t>(std::max(columns, 2))) << columns;
}

TEST(Progress, WritesDurationsAsPeopleDo) {
  EXPECT_EQ(format_duration(-1), "0.00 s");
  EXPECT_EQ(format_duration(0.994), "0.99 s");
  EXPECT_EQ(format_duration(0.996), "1.0 s");
  EXPECT_EQ(format_duration(9.96), "10 s");
  EXPECT_EQ(format_duration(59.6), "1 min 00 s");
  EXPECT_EQ(format_duration(200), "3 min 20 s");
  EXPECT_EQ(format_duration(3600), "1 h 00 min");
  EXPECT_EQ(format_duration(7499), "2 h 05 min");
}

TEST(Progress, WritesSizesAsPeopleDo) {
  EXPECT_EQ(format_bytes(0), "0 bytes");
  EXPECT_EQ(format_bytes(1023), "1023 bytes");
  EXPECT_EQ(format_bytes(1536), "1.5 KiB");
  EXPECT_EQ(format_bytes(12 << 20), "12 MiB");
  EXPECT_EQ(format_bytes(std::size_t{1023} << 20), "1.0 GiB");
  EXPECT_EQ(format_rate(0.251), "0.25");
  EXPECT_EQ(format_rate(1.24), "1.2");
  EXPECT_EQ(format_rate(37.4), "37");
}

class ProgressOnATerminal : public RunnerTest {};

TEST_F(ProgressOnATerminal, RedrawsOneLineAndTakesItAway) {
  if (!terminals_exist()) GTEST_SKIP() << "no pseudo-terminals here";
  make_shot(3);
  const std::string graph = make_graph();
  const Outcome outcome = Program({"run", graph, text("shot"), "-o", text("out"), "--plugin-path", TEST_PLUGINS}, true).finish();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("]  0/3\r\x1b[K["));
  EXPECT_THAT(outcome.err, HasSubstr("]  3/3  frame 3  "));
  EXPECT_THAT(outcome.err, HasSubstr("iB\r\x1b[K3 of 3 frames done in "));
  EXPECT_THAT(outcome.err, Not(HasSubstr("frame 1 (1 of 3)"))) << "plain lines are for files";
}

TEST_F(ProgressOnATerminal, IsPlainOnADumbTerminal) {
  if (!terminals_exist()) GTEST_SKIP() << "no pseudo-terminals here";
  make_shot(1);
  const std::string graph = make_graph();
  const Outcome outcome =
      Program({"run", graph, text("shot"), "-o", text("out"), "--plugin-path", TEST_PLUGINS}, true, {"TERM=dumb"}).finish();
  EXPECT_THAT(outcome.err, HasSubstr("frame 1 (1 of 1): "));
  EXPECT_THAT(outcome.err, Not(HasSubstr("\x1b")));
}

}  // namespace
}  // namespace quell::app::testing
