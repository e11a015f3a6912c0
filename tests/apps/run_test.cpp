// Runs from beginning to end: what is written, what is told, and what frames that fail do.
#include <gmock/gmock.h>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

class Run : public RunnerTest {};

TEST_F(Run, TellsWhatItReadsHowFarItIsAndWhereTheResultsAre) {
  make_shot(3);
  add_image("albedo", 1, 0.5F);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out")});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("  color   color.####.exr   frames 1-3\n"));
  EXPECT_THAT(outcome.err, HasSubstr("'small' reads 'color' in 3 frames: 1-3\n"));
  EXPECT_THAT(outcome.err, HasSubstr("frame 2 (2 of 3): 0."));
  EXPECT_THAT(outcome.err, HasSubstr("3 of 3 frames done in "));
  EXPECT_THAT(outcome.err, HasSubstr("  " + text("out") + "/color.####.exr  frames 1-3\n"));
  EXPECT_THAT(outcome.err, HasSubstr("time of all frames added up"));
  EXPECT_THAT(outcome.err, ContainsRegex("\n  scale  +0\\.[0-9]+ s  +[0-9.]+ ms   100%\n"));
  EXPECT_THAT(list("out"), ElementsAre("color.0001.exr", "color.0002.exr", "color.0003.exr"));
}

TEST_F(Run, IsQuietWhenAskedTo) {
  make_shot(2);
  for (const char* flag : {"-q", "--quiet"}) {
    const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), flag});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out + outcome.err, "");
  }
}

TEST_F(Run, StaysSilentOnATerminalWhenQuiet) {
  if (!terminals_exist()) GTEST_SKIP() << "no pseudo-terminals here";
  make_shot(2);
  const std::string graph = make_graph();
  const Outcome outcome =
      Program({"run", graph, text("shot"), "-o", text("out"), "-q", "--plugin-path", TEST_PLUGINS}, true).finish();
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Run, SaysMoreWhenVerbose) {
  make_shot(2);
  const std::string graph = make_graph(R"({ "at": [2], "wrong": "warn" })");
  const Outcome usual = run({"run", graph, text("shot"), "-o", text("out")});
  EXPECT_THAT(usual.err, HasSubstr("warning: a warning of the pass\n"));
  EXPECT_THAT(usual.err, Not(HasSubstr("a detail of the pass")));
  const Outcome verbose = run({"run", graph, text("shot"), "-o", text("out"), "--verbose"});
  EXPECT_THAT(verbose.err, HasSubstr("a detail of the pass\n"));
  EXPECT_THAT(verbose.err, HasSubstr("frames at a time ("));
}

TEST_F(Run, GoesOnAfterAFrameThatAPassFails) {
  make_shot(4);
  const Outcome outcome = run({"run", make_graph(R"({ "at": [2, 3] })"), text("shot"), "-o", text("out"), "-q"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.err,
            "error: frame 2 (2 of 4) failed: scale: told to fail in frame 2\n"
            "error: frame 3 (3 of 4) failed: scale: told to fail in frame 3\n"
            "error: 2 of 4 frames failed:\n"
            "  frame 2: scale: told to fail in frame 2\n"
            "  frame 3: scale: told to fail in frame 3\n");
  EXPECT_THAT(list("out"), ElementsAre("color.0001.exr", "color.0004.exr"));
}

TEST_F(Run, StopsAfterAFrameThatFailedWhenToldTo) {
  make_shot(5);
  for (const char* executor : {"serial", "tbb"}) {
    const std::string out = std::string("out_") + executor;
    const Outcome outcome = run({"run", make_graph(R"({ "at": [3] })"), text("shot"), "-o", text(out), "-q", "--on-error", "stop",
                                 "--executor", executor});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.err, StartsWith("error: frame 3 (3 of 5) failed: scale: told to fail in frame 3\n"));
    EXPECT_THAT(outcome.err,
                EndsWith("error: stopped at frame 3 because of --on-error stop; frames done: 1-2; not computed: 4-5\n"));
    EXPECT_THAT(list(out), ElementsAre("color.0001.exr", "color.0002.exr"));
  }
}

TEST_F(Run, TellsOfACutThatHasNothingToEnd) {
  make_shot(3);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "-q", "--cut", "2"});
  EXPECT_EQ(outcome.code, 0);
  const Outcome loud = run({"run", make_graph(), text("shot"), "-o", text("out"), "--cut", "2"});
  EXPECT_THAT(loud.err, HasSubstr("warning: --cut has no effect: every frame of the graph 'small' is computed by itself\n"));
  const Outcome wrong = run({"run", make_graph(), text("shot"), "-o", text("out"), "--cut", "2-"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--cut:1:3: error: "));
}

TEST_F(Run, WithNothingLeftToStopEndsAsUsual) {
  make_shot(2);
  const Outcome outcome =
      run({"run", make_graph(R"({ "at": [2] })"), text("shot"), "-o", text("out"), "-q", "--on-error", "stop"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, Not(HasSubstr("stopped")));
}

TEST_F(Run, WithTooLittleMemoryDoesNothing) {
  make_shot(2);
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "-q", "--memory", "1K"});
  EXPECT_EQ(outcome.code, 33);
  EXPECT_THAT(outcome.err, StartsWith("error: "));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Run, GoesOnAfterAFrameThatCannotBeRead) {
  make_shot(3);
  const std::string whole = read_file(path("shot/color.0002.exr"));
  write_file("shot/color.0002.exr", whole.substr(0, whole.size() - 20));
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out")});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("error: frame 2 (2 of 3) failed: " + text("shot/color.0002.exr")));
  EXPECT_THAT(outcome.err, HasSubstr("2 of 3 frames done"));
  EXPECT_THAT(outcome.err, HasSubstr("color.####.exr  frames 1,3\n"));
  EXPECT_THAT(outcome.err, HasSubstr("error: 1 of 3 frames failed:\n  frame 2: "));
  EXPECT_THAT(list("out"), ElementsAre("color.0001.exr", "color.0003.exr"));
}

TEST_F(Run, SumsUpWhatWasNotFinite) {
  make_shot(3);
  add_image("color", 2, std::numeric_limits<float>::quiet_NaN());
  add_image("color", 3, std::numeric_limits<float>::infinity());
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "-q"});
  EXPECT_EQ(outcome.code, 0);
  // 16 x 8 pixels of 3 channels, twice
  EXPECT_EQ(outcome.err, "warning: color: 768 values were NaN or infinite and count as 0 (frames 2-3)\n");
}

TEST_F(Run, SumsUpWhatWasTooBrightForHalf) {
  make_shot(2);
  // Red 1/4 stays below 65504, green 1 and 2 and blue 8 do not.
  const std::string graph = make_graph(R"({ "gain": 1e5 })");
  const Outcome outcome = run({"run", graph, text("shot"), "-o", text("out"), "-q"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(
      outcome.err,
      "warning: 256 pixels were too bright for half floats and were clamped to 65504; --type float keeps them as they are\n");
  EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("out"), "-q", "--type", "float"}).err, "");
}

TEST_F(Run, TakesParametersFromOutside) {
  make_shot(1);
  write_file("params.json", R"({ "scale.gain": 3 })");
  const std::string graph = make_graph();
  const auto bytes_with = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"run", graph, text("shot"), "-o", text("out"), "-q"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run(arguments).err, "");
    return read_file(path("out/color.0001.exr"));
  };
  const std::string plain = bytes_with({}), tripled = bytes_with({"--params", text("params.json")});
  EXPECT_NE(plain, tripled);
  EXPECT_EQ(tripled, bytes_with({"--set", "scale.gain=3"}));
  EXPECT_EQ(plain, bytes_with({"--params", text("params.json"), "--set", "scale.gain=1"})) << "--set wins";
}

TEST_F(Run, GivesTheSameBytesHoweverItRuns) {
  make_shot(6);
  const std::string graph = make_graph(R"({ "gain": 0.3 })");
  EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("serial"), "-q", "--executor", "serial"}).code, 0);
  EXPECT_EQ(contents("serial").size(), 6U);
  for (const char* threads : {"1", "2", "4"})
    for (const char* frames : {"1", "4", "auto"}) {
      const std::string out = std::string(threads) + "_" + frames;
      EXPECT_EQ(run({"run", graph, text("shot"), "-o", text(out), "-q", "--threads", threads, "--frames-in-flight", frames}).code,
                0);
      EXPECT_EQ(contents(out), contents("serial")) << out;
    }
}

TEST_F(Run, WithoutAFolderForTheResultsDoesNothing) {
  make_shot(1);
  EXPECT_EQ(run({"run", make_graph(), text("shot")}).code, 2);
}

TEST_F(Run, DryRunTellsEverythingAndWritesNothing) {
  make_shot(3);
  const Outcome outcome =
      run({"run", make_graph(), text("shot"), "-o", text("out"), "--dry-run", "-q", "--frames", "2-3", "--format", "png"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("would read, for frames 2-3:\n  color  " + text("shot") + "/color.####.exr\n"));
  EXPECT_THAT(outcome.out, HasSubstr("would run:\nsmall"));
  EXPECT_THAT(outcome.out, HasSubstr("would write:\n  " + text("out") + "/color.####.png  (2 files)\n"));
  EXPECT_THAT(outcome.out, HasSubstr("dry run: nothing was computed or written\n"));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Run, DryRunSaysWhatWouldBeReplaced) {
  make_shot(3);
  const std::string graph = make_graph();
  run({"run", graph, text("shot"), "-o", text("out"), "--frames", "1-2"});
  const auto before = contents("out");
  const Outcome outcome = run({"run", graph, text("shot"), "-o", text("out"), "-n", "-q", "--set", "scale.gain=5"});
  EXPECT_THAT(outcome.out, HasSubstr("  2 of these files exist and would be replaced\n"));
  EXPECT_EQ(contents("out"), before);
}

}  // namespace
}  // namespace quell::app::testing
