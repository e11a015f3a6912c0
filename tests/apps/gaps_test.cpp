// Frames of which files are missing, and frames that are there already.
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class Gaps : public RunnerTest {
 protected:
  Gaps() {
    write_file("loop.json", R"({"quell": 1, "name": "loop", "inputs": {"color": "color"},
      "nodes": {"blend": {"pass": "temporal_blend", "params": {"alpha": 0.5, "clamp": "none"},
                "in": {"color": "color", "history": {"from": "blend.color", "delay": 1, "initial": "none"}}}},
      "outputs": {"color": "blend.color"}})");
  }
  Outcome compute(const std::string& out, const std::vector<std::string>& more = {},
                  const std::string& graph = "loop.json") const {
    std::vector<std::string> words = {"run", text(graph), text("shot"), "-o", text(out), "--type", "float"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  void remove(const std::string& file) const { ASSERT_TRUE(fs::remove(path(file))); }
  std::string name(int frame) const { return "color.000" + std::to_string(frame) + ".exr"; }
};

TEST_F(Gaps, AreErrorsWhereFramesWereAskedForOrThatIsWanted) {
  make_shot(5);
  remove("shot/" + name(3));
  const Outcome asked = compute("out", {"--frames", "1-5"});
  EXPECT_EQ(asked.code, 3);
  EXPECT_THAT(asked.err, HasSubstr("--on-missing hold or reset, or --keep-going, computes the others"));
  EXPECT_EQ(compute("out", {"--frames", "1-5", "--on-missing", "error"}).code, 3);
  EXPECT_EQ(compute("out", {"--on-missing", "never"}).code, 2);
  EXPECT_TRUE(list("out").empty());
}

TEST_F(Gaps, AreFilledWithTheFileBefore) {
  make_shot(5);
  fs::create_directories(path("full"));
  fs::copy(path("shot"), path("full"));
  fs::copy_file(path("shot/" + name(2)), path("full/" + name(3)), fs::copy_options::overwrite_existing);
  fs::copy_file(path("shot/" + name(2)), path("full/" + name(4)), fs::copy_options::overwrite_existing);
  ASSERT_EQ(run({"run", text("loop.json"), text("full"), "-o", text("want"), "--type", "float"}).code, 0);
  remove("shot/" + name(3));
  remove("shot/" + name(4));
  const Outcome outcome = compute("got", {"--frames", "1-5", "--on-missing", "hold"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("frames 3-4: earlier files stand in"));
  EXPECT_EQ(list("got").size(), 5U);
  // Nothing but the names of what they were read from differs, which headers do not tell.
  EXPECT_EQ(contents("got"), contents("want"));
}

TEST_F(Gaps, ThatNothingPrecedesCannotBeFilled) {
  make_shot(3);
  remove("shot/" + name(1));
  const Outcome outcome = compute("out", {"--frames", "1-3", "--on-missing", "hold"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("there is no earlier one to hold"));
}

TEST_F(Gaps, EndTheHistoryWhereThatIsWanted) {
  make_shot(6);
  ASSERT_EQ(compute("want", {"--frames", "4-6"}).code, 0);
  remove("shot/" + name(3));
  const Outcome outcome = compute("got", {"--frames", "1-6", "--on-missing", "reset"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(list("got"), ElementsAre(name(1), name(2), name(4), name(5), name(6)));
  for (const int frame : {4, 5, 6})  // headers tell another beginning of the history
    EXPECT_EQ(pixels_of(path("got") / name(frame)), pixels_of(path("want") / name(frame))) << frame;
}

TEST_F(Gaps, FailAloneWhereTheRunKeepsGoing) {
  make_shot(5);
  remove("shot/" + name(3));
  const Outcome outcome = compute("out", {"--frames", "1-5", "--keep-going"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("1 of 5 frames failed"));
  EXPECT_THAT(list("out"), ElementsAre(name(1), name(2), name(4), name(5)));
  EXPECT_EQ(compute("out", {"--keep-going", "--on-error", "stop"}).code, 2);
}

TEST_F(Gaps, HistoryEndsOrIsHeldAfterAFailureWhereThatIsWanted) {
  make_shot(4);
  write_file("shot/" + name(2), "no image");
  for (const char* what : {"reset", "hold"}) {
    const Outcome outcome = compute(what, {"--on-error", what});
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_THAT(list(what), ElementsAre(name(1), name(3), name(4)));
  }
  EXPECT_NE(read_file(path("reset/" + name(3))), read_file(path("hold/" + name(3))));
}

class SkipExisting : public Gaps {
 protected:
  Outcome again(const std::vector<std::string>& more = {}, const std::string& graph = "loop.json") const {
    std::vector<std::string> words = {"--skip-existing"};
    words.insert(words.end(), more.begin(), more.end());
    return compute("out", words, graph);
  }
};

TEST_F(SkipExisting, ComputesWhatIsMissingAsIfNothingWereThere) {
  make_shot(6);
  ASSERT_EQ(compute("out").code, 0);
  const auto whole = contents("out");
  remove("out/" + name(4));
  write_file("out/" + name(2), read_file(path("out/" + name(2))).substr(0, 400));
  const Outcome outcome = again();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("4 of 6 frames are there already; of 2 the history is computed"));
  EXPECT_THAT(outcome.err, HasSubstr("frame 4 "));
  EXPECT_THAT(outcome.err, Not(HasSubstr("frame 5 ")));
  EXPECT_EQ(contents("out"), whole);
}

TEST_F(SkipExisting, HasNothingToDoWhereAllIsThere) {
  make_shot(3);
  ASSERT_EQ(compute("out").code, 0);
  const auto before = fs::last_write_time(path("out/" + name(1)));
  const Outcome outcome = again({"--log-json", text("log")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("all 3 frames are there already"));
  EXPECT_EQ(fs::last_write_time(path("out/" + name(1))), before);
}

TEST_F(SkipExisting, TrustsNoFileOfAnotherGraphOrOtherInputs) {
  make_shot(3);
  ASSERT_EQ(compute("out").code, 0);
  EXPECT_THAT(again({"--set", "blend.alpha=0.25"}).err, Not(HasSubstr("there already")));
  ASSERT_EQ(compute("out").code, 0);
  EXPECT_THAT(again({"--crop", "8x8+0+0"}).err, Not(HasSubstr("there already")));
  ASSERT_EQ(compute("out").code, 0);
  EXPECT_THAT(again({"--cut", "2"}).err, Not(HasSubstr("there already")));
  ASSERT_EQ(compute("out").code, 0);
  fs::copy_file(path("out/" + name(1)), path("out/" + name(2)), fs::copy_options::overwrite_existing);
  EXPECT_THAT(again().err, HasSubstr("2 of 3 frames are there already")) << "a file under another's name";
}

TEST_F(SkipExisting, TrustsNoFileOlderThanWhatItWasMadeOf) {
  make_shot(4);
  ASSERT_EQ(compute("out").code, 0);
  fs::last_write_time(path("shot/" + name(3)), fs::last_write_time(path("out/" + name(4))) + std::chrono::seconds(10));
  EXPECT_THAT(again().err, HasSubstr("2 of 4 frames are there already")) << "frame 4 remembers frame 3";
}

TEST_F(SkipExisting, ComputesNoHistoryWhereFramesStandForThemselves) {
  make_shot(4);
  const std::string graph = make_graph();
  const auto compute_it = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run", graph, text("shot"), "-o", text("out")};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  ASSERT_EQ(compute_it({}).code, 0);
  remove("out/" + name(3));
  const Outcome outcome = compute_it({"--skip-existing"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("3 of 4 frames are there already"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("history is computed")));
  EXPECT_EQ(list("out").size(), 4U);
}

TEST_F(SkipExisting, DoesNotGoWithWhatItWouldContradict) {
  make_shot(1);
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--watch"}, {"--checkpoint", text("kept")}, {"--reference", "color"}})
    EXPECT_EQ(again(more).code, 2) << more.front();
}

using Plan = Gaps;

TEST_F(Plan, TellsWhatARunWouldDoAndHowLongItWouldTake) {
  make_shot(20);
  const auto plan = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"plan", text("loop.json"), text("shot")};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  const Outcome outcome = plan({"--chunk", "2/2", "-o", text("out")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("would read, for frames 11-20"));
  EXPECT_THAT(outcome.out, HasSubstr("would compute for their history alone: frames 4-10 ('blend' keeps 0.5"));
  EXPECT_THAT(outcome.out, HasSubstr("color.####.exr  (10 files)"));
  EXPECT_THAT(outcome.out, HasSubstr("memory: "));
  EXPECT_THAT(outcome.out, HasSubstr("time: about "));
  EXPECT_TRUE(list("out").empty());
  const Outcome json = plan({"--json", "--no-measure", "--chunk", "2/2"});
  EXPECT_THAT(json.out, HasSubstr(R"("frames":"11-20","frame_count":10,"history_only":"4-10")"));
  EXPECT_THAT(json.out, HasSubstr(R"("files_read":17,"files_written":10)"));
  EXPECT_THAT(json.out, Not(HasSubstr("seconds")));
}

}  // namespace
}  // namespace quell::app::testing
