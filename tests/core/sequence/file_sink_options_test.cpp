#include "quell/sequence/file_sink.h"
#include "quell/sequence/pending_file.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(FileSinkOptions, AreCheckedAgainstWhatIsPossible) {
  EXPECT_EQ(parse_pixel_type("half"), PixelType::half);
  EXPECT_EQ(parse_pixel_type("float"), PixelType::single);
  EXPECT_EQ(parse_pixel_type("auto"), PixelType::automatic);
  EXPECT_EQ(message_of(Fault::usage, [] { parse_pixel_type("hafl"); }),
            "--type: 'hafl' is not possible; did you mean 'half'?; choose 'auto', 'half' or 'float'");
  EXPECT_EQ(parse_file_format("png"), FileFormat::png);
  EXPECT_THAT(message_of(Fault::usage, [] { parse_file_format("jpg"); }), HasSubstr("choose 'exr' or 'png'"));
  EXPECT_THAT(message_of(Fault::usage, [] { FileSink({.folder = "x", .compression = "zipp"}); }),
              HasSubstr("--compression: 'zipp' is not possible; did you mean 'zips' or 'zip'?; choose 'none', 'rle', "));
  EXPECT_THAT(message_of(Fault::usage, [] { FileSink({.folder = "x", .padding = 0}); }), HasSubstr("choose 1 to 20"));
}

TEST(PendingFile, DisappearsUnlessCommitted) {
  const test::TempFolder folder;
  {
    const PendingFile dropped(folder / "a.exr");
    test::make_text(dropped.path(), "x");
    EXPECT_EQ(dropped.path().parent_path(), folder.path());
    EXPECT_EQ(folder.names().size(), 1U);
  }
  EXPECT_THAT(folder.names(), IsEmpty());
  PendingFile kept(folder / "a.exr");
  test::make_text(kept.path(), "y");
  kept.commit();
  EXPECT_THAT(folder.names(), ElementsAre("a.exr"));
}

}  // namespace
}  // namespace quell
