// quell batch: lists, shots side by side, and what becomes of them.
#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <regex>
#include <sstream>
#include <thread>

#include "batch_run.h"
#include "quell/text/error.h"
#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

class BatchTest : public RunnerTest {
 protected:
  /// A list of shots that run the small graph on shot/. `shots` is JSON.
  void make_list(const std::string& shots, const std::string& params = "{}", const std::string& defaults = "") {
    make_graph(params);
    write_file("list.json", R"({ "quell_batch": 1,
  "defaults": { "graph": "graph.json", "sequence": "shot", "out": "out/{shot}", "plugin-path": ")" TEST_PLUGINS R"(")" +
                                defaults + R"( },
  "shots": )" + shots + " }\n");
  }
  Outcome batch(const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words = {"batch", text("list.json")};
    words.insert(words.end(), options.begin(), options.end());
    return quell(words);
  }
  /// Until a file of the logs holds the text; a minute is for a busy machine.
  void wait_for(const std::string& log, const std::string& text) const {
    for (int i = 0; i < 12'000; ++i) {
      if (read_file(path("list.logs/" + log)).find(text) != std::string::npos) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    FAIL() << log << " never held " << text;
  }
  /// The line of the table that begins with the name.
  static std::string line_of(const Outcome& outcome, const std::string& name) {
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with(name + " ")) return line;
    return "no line of " + name + " in\n" + outcome.out;
  }
};

TEST_F(BatchTest, ComputesWhatRunsOfTheirOwnCompute) {
  make_shot(4);
  make_list(
      R"({ "a": {}, "b": { "set": "scale.gain=2", "frames": "2-3" }, "c": { "set": ["scale.gain=0.5"], "format": ["exr", "png"] } })");
  const Outcome outcome = batch({"--threads", "2", "--jobs", "2"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(line_of(outcome, "a"), MatchesRegex("a +4/4 +0 +[0-9.]+ s +[0-9]+ MiB  done"));
  EXPECT_THAT(line_of(outcome, "b"), MatchesRegex("b +2/2 +0 .*  done"));
  EXPECT_THAT(line_of(outcome, "all"), MatchesRegex("all +10/10 +0 .*  3 of 3 shots done"));
  run({"run", text("graph.json"), text("shot"), "-o", text("alone"), "--set", "scale.gain=2", "--frames", "2-3"});
  EXPECT_EQ(contents("out/b"), contents("alone"));
  EXPECT_EQ(list("out/c").size(), 8U) << "both formats";
  EXPECT_THAT(list("list.logs"),
              ElementsAre("a.json", "a.jsonl", "a.log", "b.json", "b.jsonl", "b.log", "c.json", "c.jsonl", "c.log"));
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("a: begun with 1 thread and "), HasSubstr("a: frame 4 (4 of 4): "),
                                 HasSubstr("3 of 3 shots through, 10 frames")));
}

TEST_F(BatchTest, TellsEveryMistakeOfAListAtOnce) {
  make_shot(1);
  make_graph();
  write_file("list.json", R"({ "quell_batch": 2,
  "defaults": { "graph": "graph.json", "threads": 4, "report": "x" },
  "shot": {},
  "shots": {
    "a": { "fames": "1-2", "sequence": ["shot"], "out": "a" },
    "b/c": { "out": "b", "frames": "9-1", "plugin-path": ")" TEST_PLUGINS R"(" },
    "d": { "out": "d", "set": "scale.gian=2", "on-error": "halt", "plugin-path": ")" TEST_PLUGINS R"(" },
    "e": {},
    "f": { "out": "./a/", "keep-channels": "yes" }
  }
})");
  const Outcome outcome = batch();
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  const auto says = [&](int line, const std::string& what) {
    const std::string place = text("list.json") + ":" + std::to_string(line) + ":";
    std::istringstream lines(outcome.err);
    for (std::string text; std::getline(lines, text);)
      if (text.starts_with(place) && text.find(what) != std::string::npos) return true;
    return false;
  };
  EXPECT_TRUE(says(1, "lists with \"quell_batch\": 1, not 2"));
  EXPECT_TRUE(says(2, "'threads' is not for a list: the batch shares them out"));
  EXPECT_TRUE(says(2, "'report' is not for a list: the batch keeps a log"));
  EXPECT_TRUE(says(3, "unknown key 'shot'; did you mean 'shots'?"));
  EXPECT_TRUE(says(5, "quell run has no option 'fames'; did you mean 'frames'?"));
  EXPECT_TRUE(says(5, "'sequence' must be a text or a number, not"));
  EXPECT_TRUE(says(6, "'b/c' cannot be the name of a shot"));
  EXPECT_TRUE(says(6, "--frames"));
  EXPECT_TRUE(says(7, "'gian'"));
  EXPECT_TRUE(says(7, "--on-error: 'halt' is not possible"));
  EXPECT_TRUE(says(8, "the shot 'e' has no 'out'"));
  EXPECT_TRUE(says(9, "the shots 'a' and 'f' would write to the same place"));
  EXPECT_TRUE(says(9, "'keep-channels' must be"));
  EXPECT_FALSE(std::filesystem::exists(path("list.logs"))) << outcome.err;
}

TEST_F(BatchTest, RefusesAListThatIsNone) {
  write_file("list.json", "{ \"quell_batch\": 1, \"shots\": {} }");
  EXPECT_THAT(batch().err, HasSubstr("list.json:1:30: error: there is no shot"));
  write_file("list.json", "[]");
  EXPECT_THAT(batch().err, HasSubstr("a list of shots must be an object, not []"));
  write_file("list.json", "{ \"quell_batch\": 1, }}");
  EXPECT_EQ(batch().code, 2);
  EXPECT_EQ(quell({"batch", text("nothing.json")}).code, 2);
}

TEST_F(BatchTest, GoesOnAfterAShotThatFails) {
  make_shot(3);
  make_list(R"({ "bad": { "set": "scale.at=[2]" }, "gone": { "sequence": "nowhere" }, "good": {} })");
  const Outcome outcome = batch({"--threads", "1"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(line_of(outcome, "bad"), MatchesRegex("bad +2/3 +1 .*  failed"));
  EXPECT_THAT(line_of(outcome, "gone"), MatchesRegex("gone +0/0 +0 .*  failed \\(exit code 3\\)"));
  EXPECT_THAT(line_of(outcome, "good"), MatchesRegex("good +3/3 +0 .*  done"));
  EXPECT_THAT(line_of(outcome, "all"), HasSubstr("1 of 3 shots done"));
  EXPECT_THAT(outcome.err, HasSubstr("error: bad: frame 2 (2 of 3) failed: scale: told to fail in frame 2"));
  EXPECT_THAT(outcome.err, HasSubstr("error: gone: failed (exit code 3)"));
  EXPECT_THAT(read_file(path("list.logs/gone.log")), AllOf(StartsWith("quell batch: quell run "), HasSubstr("nowhere")));
}

TEST_F(BatchTest, BeginsNoOtherShotWhenToldToStop) {
  make_shot(1);
  make_list(R"({ "bad": { "set": "scale.at=[1]" }, "good": {} })");
  const Outcome outcome = batch({"--threads", "1", "--stop-on-error", "-q"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(line_of(outcome, "good"), MatchesRegex("good +- +- +- +-  not begun"));
  EXPECT_THAT(list("out"), Not(Contains("good")));
}

TEST_F(BatchTest, ACrashHarmsNoOtherShot) {
  make_shot(2);
  make_list(R"({ "crash": { "set": "scale.wait_from=2" }, "good": {} })");
  Program program({"batch", text("list.json"), "--threads", "4", "--jobs", "2"});
  ASSERT_TRUE(program.wait_for_error_text("good: done"));
  ASSERT_TRUE(program.wait_for_error_text("crash: frame 1 "));
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {  // where its words tell it apart
    const std::string words = read_file(entry.path() / "cmdline");
    if (words.find(text("list.logs/crash.json")) != std::string::npos) kill(std::stoi(entry.path().filename()), SIGSEGV);
  }
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(line_of(outcome, "crash"), HasSubstr("killed by signal 11 (Segmentation fault)"));
  EXPECT_THAT(line_of(outcome, "good"), HasSubstr("done"));
}

TEST_F(BatchTest, ASignalIsPassedOn) {
  make_shot(3);
  make_list(R"({ "a": { "set": "scale.wait_from=3" }, "b": {}, "c": {} })");
  for (const int signal : {SIGINT, SIGTERM}) {
    Program program({"batch", text("list.json"), "--threads", "1"});
    ASSERT_TRUE(program.wait_for_error_text("a: begun"));
    wait_for("a.log", "waiting");
    program.send(signal);
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.code, 75);
    EXPECT_THAT(outcome.err, HasSubstr("stopping; give the signal once more to stop at once"));
    EXPECT_THAT(line_of(outcome, "a"), HasSubstr("interrupted"));
    EXPECT_THAT(line_of(outcome, "b"), HasSubstr("not begun"));
    EXPECT_THAT(read_file(path("list.logs/a.json")), HasSubstr(R"("outcome":"interrupted")"));
  }
}

TEST_F(BatchTest, ASecondSignalKills) {
  make_shot(2);
  make_list(R"({ "a": { "set": ["scale.wait_from=1", "scale.stubborn=true"] } })");
  Program program({"batch", text("list.json"), "--threads", "1"});
  ASSERT_TRUE(program.wait_for_error_text("a: begun"));
  wait_for("a.log", "waiting");
  program.send(SIGINT);
  ASSERT_TRUE(program.wait_for_error_text("stopping"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.code, 75);
  EXPECT_THAT(line_of(outcome, "a"), HasSubstr("killed by signal 9"));
}

TEST_F(BatchTest, ItsShotsEndWithItWhenItIsKilled) {
  make_shot(2);
  make_list(R"({ "a": { "set": "scale.wait_from=1" } })");
  Program program({"batch", text("list.json"), "--threads", "1"});
  ASSERT_TRUE(program.wait_for_error_text("a: begun"));
  wait_for("a.log", "waiting");
  program.send(SIGKILL);
  EXPECT_EQ(program.finish().code, 128 + SIGKILL);
  wait_for("a.json", R"("outcome":"interrupted")");
}

TEST_F(BatchTest, ResumesWithWhatIsNotDone) {
  make_shot(3);
  make_list(R"({ "a": {}, "b": { "set": "scale.at=[2]" }, "c": {}, "d": {} })");
  EXPECT_EQ(batch({"--threads", "1"}).code, 1);
  std::filesystem::remove(path("out/d/color.0002.exr"));
  make_list(R"({ "a": {}, "b": {}, "c": { "set": "scale.gain=2" }, "d": {} })");
  const Outcome outcome = batch({"--threads", "2", "--memory", "1G", "--resume"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(line_of(outcome, "a"), MatchesRegex("a +3/3 +0 +- +-  done before"));
  for (const char* name : {"b", "c", "d"})
    EXPECT_THAT(line_of(outcome, name), MatchesRegex(std::string(name) + " +3/3 +0 .*B  done")) << "failed, changed, removed";
  EXPECT_THAT(outcome.err, HasSubstr("1 shot done before, 3 left"));
  EXPECT_THAT(line_of(batch({"--resume"}), "all"), HasSubstr("4 of 4 shots done"));
}

TEST_F(BatchTest, RunsAShotAloneForWhichItsShareIsTooSmall) {
  make_shot(2);
  make_list(R"({ "a": {}, "b": {} })");
  const Outcome least = run({"run", text("graph.json"), text("shot"), "-o", text("x"), "--memory", "1K", "--threads", "1"});
  ASSERT_EQ(least.code, 33);
  std::smatch needed;
  ASSERT_TRUE(std::regex_search(least.err, needed, std::regex("at least ([0-9]+) MiB are needed"))) << least.err;
  const std::string enough = std::to_string(std::stoi(needed[1]) + 40);  // but not half of it
  const Outcome outcome = batch({"--threads", "2", "--jobs", "2", "--memory", enough + "M"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("it is run alone, when the others are through"));
  EXPECT_THAT(outcome.err, HasSubstr("a: begun with 2 threads and " + enough + " MiB"));
  EXPECT_THAT(line_of(outcome, "all"), HasSubstr("2 of 2 shots done"));
}

TEST_F(BatchTest, ShowsTheCommandsInADryRun) {
  make_shot(1);
  make_list(R"({ "a": { "set": "scale.gain=2" }, "b": { "frames": "-1-1", "fps": null } })");
  const Outcome outcome = batch({"--dry-run", "--threads", "4", "--jobs", "2", "--memory", "2M", "--logs", text("my logs")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("cd " + path("").parent_path().string() + "\nquell run graph.json shot "));
  EXPECT_THAT(outcome.out, HasSubstr("--set scale.gain=2"));
  EXPECT_THAT(outcome.out, HasSubstr(" --frames=-1-1 "));
  EXPECT_THAT(outcome.out, HasSubstr("--out out/b"));
  EXPECT_THAT(outcome.out, HasSubstr("--threads 2 --memory 1048576 --log-json '" + text("my logs/a.jsonl") + "' --report '" +
                                     text("my logs/a.json") + "' > '" + text("my logs/a.log") + "' 2>&1\n"));
  EXPECT_FALSE(std::filesystem::exists(path("my logs")));
}

TEST_F(BatchTest, ReplacesNoFileOfOthers) {
  make_shot(1);
  make_list(R"({ "a": {} })");
  write_file("list.logs/a.json", "{ \"mine\": 1 }");
  const Outcome outcome = batch();
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("error: --logs: " + text("list.logs/a.json") + " is there, and was not written by this option"));
}

TEST_F(BatchTest, RefusesOptionsThatCannotBe) {
  make_shot(1);
  make_list(R"({ "a": {} })");
  EXPECT_THAT(batch({"--threads", "2", "--jobs", "3"}).err,
              HasSubstr("error: --jobs: each shot needs a thread, and there are 2"));
  EXPECT_THAT(batch({"--keep-going", "--stop-on-error"}).err, HasSubstr("error: --keep-going: it does not go with"));
}

TEST(BatchJobs, AreAsManyAsTheBudgetKeepsBusy) {
  constexpr std::size_t kGibi = std::size_t{1} << 30;
  EXPECT_EQ(choose_jobs(0, 100, 2, 64 * kGibi), 1);
  EXPECT_EQ(choose_jobs(0, 100, 16, 64 * kGibi), 4);
  EXPECT_EQ(choose_jobs(0, 100, 64, 6 * kGibi), 3);
  EXPECT_EQ(choose_jobs(0, 3, 64, 64 * kGibi), 3);
  EXPECT_EQ(choose_jobs(6, 100, 6, kGibi), 6);
  EXPECT_THROW(choose_jobs(7, 100, 6, kGibi), Error);
}

}  // namespace
}  // namespace quell::app::testing
