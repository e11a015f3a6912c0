#include "quell/sequence/input_spec.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using test::message_of;
using testing::HasSubstr;

class FolderLayoutOf : public testing::Test {
 protected:
  /// Recognition looks at names alone, so the files may be empty.
  void make(const std::vector<std::string>& names) {
    for (const std::string& name : names) test::make_text(folder_ / name, "");
  }
  FolderLayout recognize(const InputSpecs& elsewhere = {}) { return recognize_folder(folder_.path(), elsewhere); }
  std::string error() {
    return message_of(Fault::input, [&] { recognize(); });
  }
  test::TempFolder folder_;
};

/// "id=ID_%d.exr normal=..." of what was recognized.
std::string summary(const FolderLayout& layout) {
  std::string text;
  for (const auto& [name, spec] : layout.inputs) text += (text.empty() ? "" : " ") + name + "=" + spec.pattern.name();
  return text;
}

TEST_F(FolderLayoutOf, TheCourseIsRecognized) {
  make({"beauty_0.exr", "beauty_10.exr", "normal_0.exr", "position_0.exr", "depth_0.exr", "ID_0.exr", "matrix_0.mat",
        "README.md"});
  const FolderLayout layout = recognize();
  EXPECT_EQ(layout.description, "GAMES202 course layout");
  EXPECT_EQ(
      summary(layout),
      "camera=matrix_%d.mat color=beauty_%d.exr depth=depth_%d.exr id=ID_%d.exr normal=normal_%d.exr position=position_%d.exr");
  EXPECT_EQ(layout.inputs.at("id").conventions.background, -1);
}

TEST_F(FolderLayoutOf, OurOwnRenderingsAreRecognized) {
  make({"color_1spp.0001.exr", "albedo.0001.exr", "id.0001.exr", "motion.0001.exr", "reference.0001.exr", "frame.0001.json"});
  const FolderLayout layout = recognize();
  EXPECT_EQ(layout.description, "one file for each buffer, with camera sidecars");
  EXPECT_EQ(summary(layout),
            "albedo=albedo.####.exr camera=frame.####.json color=color_1spp.####.exr id=id.####.exr motion=motion.####.exr "
            "reference=reference.####.exr");
}

TEST_F(FolderLayoutOf, AnyNamedAndNumberedExrIsAnInput) {
  make({"color.0001.exr", "cloud_shadow_3.exr", "my-file_3.exr", "7.exr", "notes_3.txt", "info_3.json", ".hidden_3.exr",
        "plain.exr"});
  EXPECT_EQ(summary(recognize()), "cloud_shadow=cloud_shadow_%d.exr color=color.####.exr");
}

TEST_F(FolderLayoutOf, PaddingIsSeenByLeadingZeros) {
  make({"a.0998.exr", "a.1000.exr", "b_9.exr", "b_10.exr", "c.1000.exr", "c.1001.exr", "d.-0001.exr", "d.0000.exr", "e.0999.exr",
        "e.10000.exr"});
  EXPECT_EQ(summary(recognize()), "a=a.####.exr b=b_%d.exr c=c.%d.exr d=d.####.exr e=e.####.exr");
}

TEST_F(FolderLayoutOf, TwoFilesForAnInputAreAnErrorThatListsThem) {
  make({"beauty_0.exr", "beauty_1.exr", "color.0001.exr", "normal.0001.exr"});
  const std::string path = folder_.path().string();
  EXPECT_EQ(error(),
            path +
                ": several files could be the input 'color':\n  beauty_%d.exr  (frames 0-1)\n  color.####.exr  (frames 1)\n"
                "say which, for example: --in color=" +
                path + "/beauty_%d.exr");
}

TEST_F(FolderLayoutOf, EveryAmbiguityIsTold) {
  make({"a.1.exr", "a.0001.exr", "frame.0001.json", "matrix_1.mat"});
  EXPECT_THAT(error(), HasSubstr("'a':\n  a.####.exr  (frames 1)\n  a.%d.exr  (frames 1)"));
  EXPECT_THAT(error(), HasSubstr("'camera':\n  frame.####.json  (frames 1)\n  matrix_%d.mat  (frames 1)"));
}

TEST_F(FolderLayoutOf, AnInputNamedElsewhereIsNotAmbiguous) {
  make({"beauty_0.exr", "color.0001.exr", "normal.0001.exr"});
  InputSpecs elsewhere;
  elsewhere["color"];
  EXPECT_EQ(summary(recognize(elsewhere)), "normal=normal.####.exr");
}

TEST_F(FolderLayoutOf, AFolderWithoutASequenceSaysWhatWasExpected) {
  make({"README.md", "plain.exr"});
  EXPECT_THAT(error(), HasSubstr("no sequence is recognized here; expected files such as color.0001.exr"));
}

}  // namespace
}  // namespace quell
