// Where results go, and in what form.
#include <gmock/gmock.h>

#include <sys/stat.h>
#include <unistd.h>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Output : public RunnerTest {};

TEST_F(Output, CanBeSeveralFormats) {
  make_shot(1);
  EXPECT_EQ(run({"run", make_graph(), text("shot"), "-o", text("out"), "--format", "exr", "--format", "png"}).code, 0);
  EXPECT_THAT(list("out"), ElementsAre("color.0001.exr", "color.0001.png"));
}

TEST_F(Output, HoldsInnerImagesOnRequest) {
  make_shot(1);
  write_file("two.json", R"({
  "quell": 1, "inputs": { "color": "color" },
  "nodes": { "first": { "pass": "test_scale", "in": { "color": "color" } },
             "second": { "pass": "test_scale", "in": { "color": "first.color" } } },
  "outputs": { "color": "second.color" } })");
  const Outcome outcome = run({"run", text("two.json"), text("shot"), "-o", text("out"), "--dump", "first.color"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(list("out"), ElementsAre("color.0001.exr", "first.color.0001.exr"));
  EXPECT_THAT(outcome.err, HasSubstr("/first.color.####.exr  frame 1\n"));
}

TEST_F(Output, OfAnInnerImageThatDoesNotExistIsRefused) {
  make_shot(1);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "--dump", "scale.colour"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, ::testing::StartsWith("error: --dump: "));
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'scale.color'?"));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Output, TakesThePaddingOfTheInputOrWhatIsAsked) {
  make_shot(1);
  const std::string graph = make_graph();
  std::filesystem::rename(path("shot/color.0001.exr"), path("shot/color.000001.exr"));
  EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("out")}).code, 0);
  EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("out"), "--padding", "2"}).code, 0);
  EXPECT_THAT(list("out"), ElementsAre("color.000001.exr", "color.01.exr"));
}

TEST_F(Output, ChangesWithTypeAndCompression) {
  make_shot(1);
  const std::string graph = make_graph();
  const auto size_with = [&](const std::string& option, const std::string& value) {
    EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("out"), option, value}).code, 0);
    return std::filesystem::file_size(path("out/color.0001.exr"));
  };
  // 16 x 8 pixels of 3 channels, uncompressed: 2 bytes more each
  const auto half = size_with("--compression", "none");
  EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("out"), "--compression", "none", "--type", "float"}).code, 0);
  EXPECT_EQ(std::filesystem::file_size(path("out/color.0001.exr")) - half, 16U * 8 * 3 * 2);
  EXPECT_LT(size_with("--compression", "zip"), half);
}

TEST_F(Output, NeverReplacesWhatIsRead) {
  make_shot(2);
  const auto before = contents("shot");
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("shot") + "/../shot/"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err.substr(outcome.err.find("error")),
            "error: --out: the results would replace " + text("shot") +
                "/../shot/color.0001.exr, which is 'color' of the sequence; choose another folder\n");
  EXPECT_EQ(contents("shot"), before);
}

TEST_F(Output, NeverReplacesWhatOtherGraphsRead) {
  make_shot(1);
  write_file("to_reference.json", R"({
  "quell": 1, "inputs": { "color": "color" },
  "nodes": { "scale": { "pass": "test_scale", "in": { "color": "color" } } },
  "outputs": { "reference": "scale.color" } })");
  std::filesystem::copy(path("shot/color.0001.exr"), path("shot/reference.0001.exr"));
  const auto before = contents("shot");
  const Outcome outcome = run({"run", text("to_reference.json"), text("shot"), "-o", text("shot")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("reference.0001.exr, which is 'reference' of the sequence; choose another folder\n"));
  EXPECT_EQ(contents("shot"), before);
}

TEST_F(Output, NeedsAFolderWithAName) {
  make_shot(1);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", "", "--dry-run"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: --out: the name is empty; name a folder for the results\n");
}

TEST_F(Output, MayLieBesideWhatIsReadUnderOtherNames) {
  make_shot(1);
  EXPECT_EQ(run({"run", make_graph(), text("shot"), "-o", text("shot"), "--format", "png"}).code, 0);
  EXPECT_THAT(list("shot"), ElementsAre("color.0001.exr", "color.0001.png"));
}

TEST_F(Output, ToAFileIsRefused) {
  make_shot(1);
  write_file("out", "");
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "-q"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: --out: " + text("out") + " is a file; name a folder for the results\n");
}

TEST_F(Output, ToAFolderThatCannotBeMadeIsRefused) {
  make_shot(1);
  write_file("file", "");
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("file/out"), "-q"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: --out: the folder " + text("file/out") + " cannot be made: Not a directory\n");
}

TEST_F(Output, ToAFolderWithoutPermissionIsRefused) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  make_shot(1);
  std::filesystem::create_directory(path("out"));
  chmod(path("out").c_str(), 0500);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "-q"});
  chmod(path("out").c_str(), 0700);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: --out: nothing can be written to " + text("out") + ": Permission denied\n");
}

TEST_F(Output, InAFormatThatCannotHoldItIsRefusedBeforeTheRun) {
  make_shot(1);
  add_image("normal", 1, 0.5F);
  write_file("normals.json", R"({ "quell": 1, "inputs": { "normal": "normal" },
  "nodes": { "scale": { "pass": "test_scale", "in": { "color": "normal" } } }, "outputs": { "normal": "scale.color" } })");
  const Outcome outcome = run({"run", text("normals.json"), text("shot"), "-o", text("out"), "--format", "png", "-q"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("PNG cannot hold an image of type normal; choose exr"));
}

}  // namespace
}  // namespace quell::app::testing
