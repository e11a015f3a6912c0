#include "run_options.h"

#include <gmock/gmock.h>

#include "quell/text/error.h"

namespace quell::app::testing {
namespace {

TEST(ParseMemory, TakesBytesAndPowersOf1024) {
  EXPECT_EQ(parse_memory("1"), 1U);
  EXPECT_EQ(parse_memory("1000000"), 1000000U);
  EXPECT_EQ(parse_memory("3K"), 3U << 10);
  EXPECT_EQ(parse_memory("512M"), 512U << 20);
  EXPECT_EQ(parse_memory("1.5G"), std::size_t{3} << 29);
  EXPECT_EQ(parse_memory("2t"), std::size_t{2} << 40);
  EXPECT_EQ(parse_memory("auto"), 0U);
}

TEST(ParseMemory, RefusesWhatIsNoAmount) {
  for (const char* text :
       {"", "0", "0M", "-1", "+1", "G", "2GB", "2 G", "2X", "1e3", "1.5", ".5G", "nan", "inf", "0x10", "9999999T", "Auto", "1M "})
    EXPECT_THROW(parse_memory(text), Error) << text;
}

TEST(ParseSchedule, FillsTheSessionsOptions) {
  const SessionOptions usual = parse_schedule({});
  EXPECT_EQ(usual.threads, 0);
  EXPECT_EQ(usual.schedule, Schedule::concurrent);
  EXPECT_EQ(usual.frames_in_flight, 0);
  EXPECT_EQ(usual.memory, 0U);
  EXPECT_EQ(usual.on_error, OnError::go_on);
  const SessionOptions other = parse_schedule({"3", "4", "2G", "tbb", "stop"});
  EXPECT_EQ(other.threads, 3);
  EXPECT_EQ(other.frames_in_flight, 4);
  EXPECT_EQ(other.memory, std::size_t{2} << 30);
  EXPECT_EQ(other.on_error, OnError::stop);
  const SessionOptions serial = parse_schedule({.executor = "serial"});
  EXPECT_EQ(serial.schedule, Schedule::serial);
  EXPECT_EQ(serial.frames_in_flight, 1);
  EXPECT_EQ(parse_schedule({.cut = "240,101"}).cuts, (std::vector<std::int64_t>{101, 240}));
  EXPECT_THROW(parse_schedule({.cut = "first"}), Error);
}

}  // namespace
}  // namespace quell::app::testing
