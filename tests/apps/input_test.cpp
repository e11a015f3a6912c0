// How sequences are named, and what is said when something is missing.
#include <gmock/gmock.h>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Input : public RunnerTest {
 protected:
  /// A graph with a second, optional input.
  std::string make_graph_with_albedo(bool optional) {
    write_file("albedo.json", R"({ "quell": 1, "name": "two",
  "inputs": { "color": "color", "albedo": { "type": "albedo", "optional": )" +
                                  std::string(optional ? "true" : "false") + R"( } },
  "nodes": { "scale": { "pass": "test_scale", "in": { "color": "color" } },
             "other": { "pass": "test_scale", "in": { "color": "albedo" } } },
  "outputs": { "color": "scale.color", "albedo": "other.color" } })");
    return text("albedo.json");
  }
};

TEST_F(Input, GivesTheSameBytesHoweverItIsNamed) {
  make_shot(3);
  const std::string graph = make_graph();
  write_file("sequence.json", R"({ "quell_sequence": 1, "inputs": { "color": "shot/color.####.exr" } })");
  EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("by_folder"), "-q"}).err, "");
  EXPECT_EQ(run({"run", graph, text("sequence.json"), "-o", text("by_file"), "-q"}).err, "");
  EXPECT_EQ(run({"run", graph, "--in", "color=" + text("shot/color.%04d.exr"), "-o", text("by_option"), "-q"}).err, "");
  EXPECT_EQ(contents("by_folder").size(), 3U);
  EXPECT_EQ(contents("by_folder"), contents("by_file"));
  EXPECT_EQ(contents("by_folder"), contents("by_option"));
}

TEST_F(Input, CanBeFilesThatHoldAllInputsOrOneOfThem) {
  make_shot(3);
  const std::string graph = make_graph();
  EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("by_folder"), "-q"}).err, "");
  EXPECT_EQ(run({"run", graph, text("shot/color.####.exr"), "-o", text("by_pattern"), "-q"}).err, "");
  EXPECT_EQ(contents("by_folder"), contents("by_pattern"));
  const Outcome one = run({"run", graph, text("shot/color.0002.exr"), "-o", text("one")});
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(one.err, HasSubstr(": one file for all inputs\n"));
  EXPECT_THAT(one.err, HasSubstr("  color  color.0002.exr  frames 2  R,G,B\n"));
  EXPECT_THAT(list("one"), ElementsAre("color.0002.exr"));
}

TEST_F(Input, AnInputThatNoLayerServesIsToldWithTheLayers) {
  make_shot(1);
  const Outcome outcome = run({"check", make_graph_with_albedo(false), text("shot/color.####.exr")});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("inputs of the graph 'two' are missing:\n  albedo (albedo)"));
  EXPECT_THAT(outcome.err, HasSubstr("color.####.exr has the layers:\n  without a layer  (R,G,B"));
  EXPECT_THAT(outcome.err, HasSubstr("for example: --in albedo=PATTERN:LAYER"));
}

TEST_F(Input, CanBeCropped) {
  make_shot(1);
  EXPECT_THAT(run({"check", make_graph(), text("shot"), "--crop", "4,2,8,3"}).out, HasSubstr(", 8 x 3, "));
  const Outcome beyond = run({"check", make_graph(), text("shot"), "--crop", "10,0,8,3", "-q"});
  EXPECT_EQ(beyond.code, 2);
  EXPECT_THAT(beyond.err, HasSubstr("--crop: 10,0,8,3 is not all within the image, which is 16 x 8"));
  for (const char* wrong : {"", "1,2,3", "1,2,3,4,5", "a,0,1,1", "0,0,0,1", "0,-1,1,1", "1;2;3;4"})
    EXPECT_THAT(run({"check", make_graph(), text("shot"), "--crop", wrong}).err, HasSubstr("is not X,Y,WIDTH,HEIGHT in pixels"))
        << wrong;
}

TEST_F(Input, AWindowThatIsNoneIsRefused) {
  make_shot(1);
  EXPECT_THAT(run({"check", make_graph(), text("shot"), "--window", "dat"}).err,
              HasSubstr("--window: 'dat' is not possible; did you mean 'data'?"));
}

TEST_F(Input, IsLimitedToTheFramesAskedFor) {
  make_shot(6);
  EXPECT_EQ(run({"run", make_graph(), text("shot"), "-o", text("out"), "--frames", "1-6x2,6"}).code, 0);
  EXPECT_THAT(list("out"), ElementsAre("color.0001.exr", "color.0003.exr", "color.0005.exr", "color.0006.exr"));
}

TEST_F(Input, FramesThatAreMisspeltAreShown) {
  make_shot(1);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "--frames", "3-1"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--frames:1:3: error: the range descends"));
  EXPECT_THAT(outcome.err, HasSubstr("\n    3-1\n      ^\n"));
}

TEST_F(Input, FramesThatAreEmptyAreNotAllFrames) {
  make_shot(2);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "--frames", ""});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--frames:1:1: error: a frame number is missing here"));
}

TEST_F(Input, FramesAskedForThatAreMissingAreNamed) {
  make_shot(2);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "--frames", "2-4", "-q"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.err, "error: " + text("shot") + ": files of the frames asked for are missing:\n  frame 3, color: " +
                             text("shot/color.0003.exr") + "\n  frame 4, color: " + text("shot/color.0004.exr") +
                             "\n--on-missing hold or reset, or --keep-going, computes the others\n");
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Input, IncompleteFramesAreLeftOutAndNamed) {
  make_shot(3);
  add_image("albedo", 1, 0.5F);
  add_image("albedo", 3, 0.5F);
  const Outcome outcome = run({"run", make_graph_with_albedo(false), text("shot"), "-o", text("out"), "-q"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "warning: frame 2 is left out, because files are missing:\n  frame 2, albedo: " +
                             text("shot/albedo.0002.exr") + "\n");
  EXPECT_EQ(list("out").size(), 4U);
}

TEST_F(Input, ThatNoFrameHasWholeEndsTheRun) {
  make_shot(1);
  add_image("albedo", 2, 0.5F);
  const Outcome outcome = run({"run", make_graph_with_albedo(false), text("shot"), "-o", text("out"), "-q"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("there is no frame for which every input exists; missing are:\n  frame 1, albedo: "));
}

TEST_F(Input, ThatTheSequenceLacksIsNamedWithWhatItHas) {
  make_shot(1);
  const Outcome outcome = run({"run", make_graph_with_albedo(false), text("shot"), "-o", text("out"), "-q"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.err, "error: " + text("shot") +
                             ": inputs of the graph 'two' are missing:\n  albedo (albedo)\nthe sequence has: color\n"
                             "name their files, for example: --in albedo=FOLDER/NAME.####.exr\n");
}

TEST_F(Input, ThatIsOptionalMayBeAbsent) {
  make_shot(1);
  write_file("optional.json", R"({ "quell": 1, "inputs": { "color": "color", "extra": { "type": "color", "optional": true } },
  "nodes": { "scale": { "pass": "test_scale", "in": { "color": "color", "more": ["extra"] } } },
  "outputs": { "color": "scale.color" } })");
  EXPECT_EQ(run({"run", text("optional.json"), text("shot"), "-o", text("out")}).code, 0);
}

TEST_F(Input, ThatTheGraphDoesNotReadIsNotLookedFor) {
  make_shot(2);
  write_file("shot/albedo.0001.exr", "not an image");
  EXPECT_EQ(run({"run", make_graph(), text("shot"), "-o", text("out"), "-q"}).err, "");
}

TEST_F(Input, IsAmbiguousOnlyWhenTheGraphReadsIt) {
  make_shot(2);
  const std::string graph = make_graph();
  for (const char* name : {"shot/albedo.0001.exr", "shot/albedo_1.exr"}) write_file(name, "");
  EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("out"), "-q"}).err, "");
  std::filesystem::copy(path("shot/color.0001.exr"), path("shot/beauty_1.exr"));
  const Outcome outcome = run({"run", graph, text("shot"), "-o", text("out"), "-q"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("several files could be the input 'color':\n"));
  EXPECT_THAT(outcome.err, HasSubstr("say which, for example: --in color=" + text("shot/")));
  EXPECT_EQ(run({"run", graph, text("shot"), "--in", "color=" + text("shot/color.####.exr"), "-o", text("out")}).code, 0);
}

TEST_F(Input, ThatTheGraphDoesNotHaveIsNotSilentlyIgnored) {
  make_shot(1);
  const Outcome outcome =
      run({"run", make_graph(), text("shot"), "--in", "colour=" + text("shot/color.####.exr"), "-o", text("out"), "-q"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("the graph has no input 'colour'; did you mean 'color'?; it has 'color'"));
}

TEST_F(Input, ThatDoesNotExistIsAnInputError) {
  const std::string graph = make_graph();
  const Outcome nowhere = run({"run", graph, text("nowhere"), "-o", text("out"), "-q"});
  EXPECT_EQ(nowhere.code, 3);
  EXPECT_EQ(nowhere.err, "error: " + text("nowhere") + ": no such folder or file\n");
  const Outcome pattern = run({"run", graph, "--in", "color=" + text("none.%d.exr"), "-o", text("out"), "-q"});
  EXPECT_EQ(pattern.code, 3);
  EXPECT_THAT(pattern.err, HasSubstr("there is no file of this name for the input 'color'"));
}

TEST_F(Input, WhoseNumbersArePaddedInAnotherWayIsExplained) {
  make_shot(2);
  const Outcome outcome = run({"run", make_graph(), "--in", "color=" + text("shot/color.%d.exr"), "-o", text("out"), "-q"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err,
              ::testing::StartsWith("warning: " + text("shot/color.%d.exr") + ": no file is named like this pattern"));
  EXPECT_THAT(outcome.err, HasSubstr("\nerror: " + text("shot/color.%d.exr") + ": there is no file of this name"));
}

TEST_F(Input, ThatIsNoImageIsAnInputError) {
  write_file("shot/color.0001.exr", "not an image");
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "-q"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("error: " + text("shot/color.0001.exr")));
}

TEST_F(Input, ThatIsNotNamedAtAllIsAUsageError) {
  const Outcome outcome = run({"run", make_graph(), "-o", text("out")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err,
            "error: SEQUENCE: no sequence is given; name a folder, a sequence.json, or the files of each input (color) with --in "
            "INPUT=PATTERN\n");
}

}  // namespace
}  // namespace quell::app::testing
