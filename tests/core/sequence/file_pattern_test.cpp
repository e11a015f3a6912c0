#include "quell/sequence/file_pattern.h"

#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

FilePattern pattern(std::string_view text) { return FilePattern::parse(text, "folder", "--in"); }
std::string error(std::string_view text) {
  return message_of(Fault::usage, [&] { pattern(text); });
}

TEST(FilePattern, HoldsNoZeroByte) {
  EXPECT_THAT(error(std::string_view("a\0b.####.exr", 12)), HasSubstr("--in:1:2: error: no file's name holds a zero byte"));
}

TEST(FilePattern, NamesTheFileOfAFrame) {
  EXPECT_EQ(pattern("beauty_%d.exr").path(12), "folder/beauty_12.exr");
  EXPECT_EQ(pattern("a.%04d.exr").path(12), "folder/a.0012.exr");
  EXPECT_EQ(pattern("a.####.exr").path(12), "folder/a.0012.exr");
  EXPECT_EQ(pattern("a.#.exr").path(12), "folder/a.12.exr");
  EXPECT_EQ(pattern("a.##.exr").path(12345), "folder/a.12345.exr");
  EXPECT_EQ(pattern("sub/a.##.exr").path(3), "folder/sub/a.03.exr");
  EXPECT_EQ(pattern("/abs/a.##.exr").path(3), "/abs/a.03.exr");
  EXPECT_EQ(pattern("%03d").path(3), "folder/003");
  EXPECT_EQ(pattern("100%%_%d.exr").path(3), "folder/100%_3.exr");
}

TEST(FilePattern, PadsNegativeNumbersAsPrintfOrByDigits) {
  EXPECT_EQ(pattern("a.%04d.exr").file_name(-12), "a.-012.exr");  // printf("%04d", -12) is -012
  EXPECT_EQ(pattern("a.####.exr").file_name(-12), "a.-0012.exr");
  EXPECT_EQ(pattern("a_%d.exr").file_name(-12), "a_-12.exr");
}

TEST(FilePattern, IsWrittenAsItWasGiven) {
  EXPECT_EQ(pattern("sub/a.%04d.exr").text(), "folder/sub/a.%04d.exr");
  EXPECT_EQ(FilePattern("x", "a.", 4, ".exr").text(), "x/a.####.exr");
  EXPECT_EQ(FilePattern("x", "50%_", 1, ".exr").text(), "x/50%%_%d.exr");
}

TEST(FilePattern, RefusesWhatIsNotOneCounter) {
  EXPECT_EQ(error("a_%d.%04d.exr"),
            "--in:1:6: error: a second frame number; a pattern has one (a percent sign is written %%)\n"
            "    a_%d.%04d.exr\n"
            "         ^");
  EXPECT_THAT(error("a.exr"), HasSubstr("the pattern has no frame number; write the frame number as %d, %04d or ####"));
  EXPECT_THAT(error("#a#.exr"), HasSubstr("--in:1:3: error: a second frame number"));
  EXPECT_THAT(error("a_%i.exr"), HasSubstr("--in:1:3: error: unknown counter"));
  EXPECT_THAT(error("a_%4d.exr"), HasSubstr("unknown counter"));
  EXPECT_THAT(error("a_%"), HasSubstr("unknown counter"));
  EXPECT_THAT(error("a_%099d.exr"), HasSubstr("more than 20 digits"));
  EXPECT_THAT(error("a_%09999999999999d.exr"), HasSubstr("more than 20 digits"));
  EXPECT_THAT(error("f%d/a.exr"), HasSubstr("--in:1:2: error: the frame number must be in the file's name"));
}

TEST(FilePattern, FindsTheFramesInAListing) {
  const FrameFiles files =
      find_frames(pattern("a.####.exr"), {"a.-0003.exr", "a.0002.exr", "a.0010.exr", "a.10000.exr", "a.7.exr", "a.x.exr",
                                          "a..exr", "a.-.exr", "b.0001.exr", "a.0001.exr.tmp"});
  EXPECT_THAT(files.frames, ElementsAre(-3, 2, 10, 10000));
  EXPECT_THAT(files.padded_otherwise, ElementsAre("a.7.exr"));
  const FrameFiles plain = find_frames(pattern("a_%d.exr"), {"a_1.exr", "a_02.exr", "a_-4.exr", "a_99999999999999999999.exr"});
  EXPECT_THAT(plain.frames, ElementsAre(-4, 1));
  EXPECT_THAT(plain.padded_otherwise, ElementsAre("a_02.exr"));
}

TEST(FilePattern, PathAndMatchAreInverse) {
  for (const char* text : {"a%d.exr", "a.%04d.exr", "a.####.exr", "%d"}) {
    for (const std::int64_t frame : {-12345, -12, -1, 0, 1, 999, 9999, 10000}) {
      const auto match = pattern(text).match(pattern(text).file_name(frame));
      ASSERT_TRUE(match) << text << " " << frame;
      EXPECT_EQ(match->frame, frame);
      EXPECT_TRUE(match->exact);
    }
  }
}

TEST(ListFiles, TellsWhyAFolderCannotBeRead) {
  const test::TempFolder folder;
  test::make_text(folder / "file", "x");
  EXPECT_THAT(message_of(Fault::input, [&] { list_files(folder / "none"); }),
              HasSubstr("none: the folder cannot be read: No such file or directory"));
  EXPECT_THAT(message_of(Fault::input, [&] { list_files(folder / "file"); }), HasSubstr("Not a directory"));
}

}  // namespace
}  // namespace quell
