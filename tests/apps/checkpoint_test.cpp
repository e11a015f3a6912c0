// Runs that end, in whatever way, and go on.
#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Checkpoint : public RunnerTest {
 protected:
  Checkpoint() {
    write_file("loop.json", R"({"quell": 1, "name": "loop", "inputs": {"color": "color"},
      "nodes": {"blend": {"pass": "temporal_blend", "params": {"alpha": 0.3},
                "in": {"color": "color", "history": {"from": "blend.color", "delay": 1, "initial": "none"}}}},
      "outputs": {"color": "blend.color"}})");
  }
  std::vector<std::string> command(const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"run", text("loop.json"), text("shot"), "-o", text(out), "--type", "float"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  std::vector<std::string> resumed(const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = command(out, {"--checkpoint", text("kept"), "--every", "3", "--resume"});
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  void compute_whole() { ASSERT_EQ(run(command("whole")).code, 0); }
};

TEST_F(Checkpoint, IsGoneOnWithToTheSameBits) {
  make_shot(9);
  compute_whole();
  for (const char* frames : {"1-2", "3-7", "8-9"}) {
    const Outcome outcome = run(resumed("parts", {"--frames", frames}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  EXPECT_EQ(contents("parts"), contents("whole"));
  const Outcome again = run(resumed("parts", {"--log-json", text("log.jsonl")}));
  EXPECT_EQ(again.code, 0) << "nothing is left to do";
  EXPECT_THAT(read_file(path("log.jsonl")), HasSubstr("\"outcome\":\"done\""));
  EXPECT_EQ(list("kept").size(), 2U) << "the manifest and the latest history";
}

TEST_F(Checkpoint, OutlastsBeingKilledAtAnyMoment) {
  make_shot(60);
  compute_whole();
  int kills = 0;
  for (int delay = 0; kills < 40; ++kills, delay += 7) {
    Program program(resumed("parts"));
    std::this_thread::sleep_for(std::chrono::milliseconds(20 + delay % 90));
    program.send(SIGKILL);
    if (program.finish().code == 0) break;
  }
  EXPECT_GT(kills, 2);
  const Outcome last = run(resumed("parts"));
  ASSERT_EQ(last.code, 0) << last.err;
  for (const auto& [name, bytes] : contents("whole")) EXPECT_EQ(read_file(path("parts/" + name)), bytes) << name;
}

TEST_F(Checkpoint, IsWrittenWhereASignalEndsTheRun) {
  make_shot(400);
  compute_whole();
  Program program(resumed("parts"));
  ASSERT_TRUE(program.wait_for_error_text("frame 5 "));
  program.send(SIGTERM);
  EXPECT_EQ(program.finish().code, 75);
  EXPECT_THAT(read_file(path("kept/checkpoint.json")), HasSubstr("\"frame\""));
  const Outcome last = run(resumed("parts"));
  ASSERT_EQ(last.code, 0) << last.err;
  EXPECT_THAT(last.err, HasSubstr("going on after frame "));
  EXPECT_EQ(contents("parts"), contents("whole"));
}

TEST_F(Checkpoint, OfAnotherRunIsRefusedWithAllThatDiffers) {
  make_shot(4);
  ASSERT_EQ(run(resumed("parts")).code, 0);
  const Outcome outcome = run(resumed("parts", {"--set", "blend.alpha=0.5", "--cut", "3"}));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("the graph's hash: "));
  EXPECT_THAT(outcome.err, HasSubstr("--cut: 3 now, nothing in the checkpoint"));
}

TEST_F(Checkpoint, DoesNotPassFramesThatNobodyComputed) {
  make_shot(9);
  ASSERT_EQ(run(resumed("parts", {"--frames", "4-6"})).code, 0);
  const Outcome outcome = run(resumed("parts"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("of the frames until then 1-3 are not done"));
}

TEST_F(Checkpoint, ThatIsDamagedIsToldWhere) {
  make_shot(3);
  ASSERT_EQ(run(resumed("parts")).code, 0);
  write_file("kept/checkpoint.json", R"({"quell_checkpoint": 1, "frame": 3, "folder": "../.."})");
  const Outcome outcome = run(resumed("parts"));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("checkpoint.json:1:"));
  EXPECT_THAT(outcome.err, HasSubstr("'folder' should be the name of a file beside this one"));
}

TEST_F(Checkpoint, RemembersFramesThatFailed) {
  make_shot(6);
  write_file("shot/" + list("shot").at(1), "no image");
  EXPECT_EQ(run(resumed("parts", {"--frames", "1-3"})).code, 1);
  const Outcome outcome = run(resumed("parts"));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("before the checkpoint, these frames failed: 2"));
}

TEST_F(Checkpoint, OptionsWithoutAFolderAreRefused) {
  make_shot(2);
  EXPECT_THAT(run(command("out", {"--resume"})).err, HasSubstr("--resume: name the folder"));
  EXPECT_THAT(run(command("out", {"--every", "5"})).err, HasSubstr("--every: it is about checkpoints"));
  EXPECT_EQ(run(command("out", {"--checkpoint", text("kept"), "--every", "0"})).code, 2);
  EXPECT_EQ(run(command("out", {"--checkpoint", text("kept"), "--watch"})).code, 2);
  EXPECT_THAT(list("out"), IsEmpty());
}

}  // namespace
}  // namespace quell::app::testing
