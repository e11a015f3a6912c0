#include "quell/sequence/frame_range.h"

#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::int64_t> frames(std::string_view text) { return FrameRange::parse(text).frames(); }
std::string error(std::string_view text) {
  return message_of(Fault::usage, [&] { FrameRange::parse(text); });
}

TEST(FrameRange, ReadsSingleFramesRangesAndSteps) {
  EXPECT_THAT(frames("7"), ElementsAre(7));
  EXPECT_THAT(frames("0-3"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(frames("1-10x3"), ElementsAre(1, 4, 7, 10));
  EXPECT_THAT(frames("1-9:4"), ElementsAre(1, 5, 9));
  EXPECT_THAT(frames("1-8x4"), ElementsAre(1, 5));
  EXPECT_THAT(frames("1,5,9-12"), ElementsAre(1, 5, 9, 10, 11, 12));
  EXPECT_THAT(frames(" 1 , 5 - 7 x 2 "), ElementsAre(1, 5, 7));
  EXPECT_THAT(frames("0007"), ElementsAre(7));
}

TEST(FrameRange, ReadsNegativeNumbers) {
  EXPECT_THAT(frames("-2-1"), ElementsAre(-2, -1, 0, 1));
  EXPECT_THAT(frames("-5--3"), ElementsAre(-5, -4, -3));
  EXPECT_THAT(frames("-7"), ElementsAre(-7));
}

TEST(FrameRange, SortsAndNamesEachFrameOnce) { EXPECT_THAT(frames("5,1-3,2"), ElementsAre(1, 2, 3, 5)); }

TEST(FrameRange, ReachesTheEndsOf64Bits) {
  EXPECT_THAT(frames("9223372036854775807"), ElementsAre(INT64_MAX));
  EXPECT_THAT(frames("-9223372036854775808-9223372036854775807x9223372036854775807"), ElementsAre(INT64_MIN, -1, INT64_MAX - 1));
}

TEST(FrameRange, PointsAtWhatIsWrong) {
  EXPECT_EQ(error("1-100,20-10"),
            "--frames:1:10: error: the range descends; write 10-20 (frames always run in ascending order)\n"
            "    1-100,20-10\n"
            "             ^");
  EXPECT_THAT(error(""), HasSubstr("--frames:1:1: error: a frame number is missing here; write frames as 1-100"));
  EXPECT_THAT(error("1,,2"), HasSubstr("--frames:1:3: error: a frame number is missing"));
  EXPECT_THAT(error("1-"), HasSubstr("--frames:1:3: error: the last frame of the range is missing"));
  EXPECT_THAT(error("1-9x"), HasSubstr("--frames:1:5: error: the step is missing"));
  EXPECT_THAT(error("1-9x0"), HasSubstr("--frames:1:5: error: the step must be at least 1"));
  EXPECT_THAT(error("1-9x-2"), HasSubstr("--frames:1:5: error: the step must be at least 1"));
  EXPECT_THAT(error("5x2"), HasSubstr("--frames:1:2: error: a step needs a range before it"));
  EXPECT_THAT(error("1-9 a"), HasSubstr("--frames:1:5: error: 'a' does not belong here"));
  EXPECT_THAT(error("1.5"), HasSubstr("--frames:1:2: error: '.' does not belong here"));
}

TEST(FrameRange, RefusesNumbersBeyond64Bits) {
  EXPECT_THAT(error("1-9223372036854775808"), HasSubstr("--frames:1:3: error: this number does not fit 64 bits"));
}

TEST(FrameRange, RefusesAbsurdCountsWithoutMakingThem) {
  EXPECT_EQ(frames("1-10000000").size(), FrameRange::kMaxFrames);
  EXPECT_THAT(error("0-10000000"), HasSubstr("more than 10 000 000 frames"));
  EXPECT_THAT(error("1-6000000,1-6000000"), HasSubstr("--frames:1:11: error: more than 10 000 000 frames"));
  EXPECT_THAT(error("-9223372036854775808-9223372036854775807"), HasSubstr("more than 10 000 000 frames"));
}

TEST(FrameRange, IsWrittenInTheUsualForm) {
  const auto text = [](std::string_view from) { return FrameRange::parse(from).text(); };
  EXPECT_EQ(text("0,1,2,3"), "0-3");
  EXPECT_EQ(text("7"), "7");
  EXPECT_EQ(text("1-99:2"), "1-99x2");
  EXPECT_EQ(text("9-12,5,1"), "1,5,9-12");
  EXPECT_EQ(text("1,3"), "1,3");
  EXPECT_EQ(text("-5--1"), "-5--1");
  EXPECT_EQ(FrameRange().text(), "none");
}

TEST(FrameRange, ItsTextNamesTheSameFrames) {
  for (const char* from :
       {"1-8", "1,2,4,8,16", "1-9x2,10-20x5", "-3-3x3,100", "0,2,4,5,6", "-9223372036854775808,9223372036854775807"}) {
    const FrameRange range = FrameRange::parse(from);
    EXPECT_EQ(FrameRange::parse(range.text()).frames(), range.frames()) << from << " became " << range.text();
  }
}

}  // namespace
}  // namespace quell
