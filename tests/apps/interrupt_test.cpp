// Signals: a run that is stopped leaves whole frames only.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/apps/sample.h"
#include "tests/core/sequence/test_files.h"

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Interrupted : public RunnerTest {
 protected:
  // A thread is left for the files of frames 1 and 2 while the others wait.
  std::vector<std::string> arguments() {
    make_shot(5);
    const std::string graph = make_graph(R"({ "wait_from": 3 })");
    return {"run", graph, text("shot"), "-o", text("out"), "--threads", "4", "--plugin-path", TEST_PLUGINS};
  }
  static bool wait_until_stuck(Program& program) {
    return program.wait_for_error_text("\nwaiting\n") && program.wait_for_error_text("\nframe 2 (2 of 5)");
  }
};

TEST_F(Interrupted, StopsWithNothingPartialAndSaysWhatIsDone) {
  const std::vector<std::string> command = arguments();
  run({"run", make_graph(), text("shot"), "-o", text("whole"), "-q"});
  make_graph(R"({ "wait_from": 3 })");
  for (const int signal : {SIGINT, SIGTERM}) {
    Program program(command);
    ASSERT_TRUE(wait_until_stuck(program));
    program.send(signal);
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.code, 75) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("stopping; give the signal once more to stop at once\n"));
    EXPECT_THAT(outcome.err, HasSubstr("error: interrupted; frames done: 1-2; not computed: 3-5\n"));
    EXPECT_THAT(list("out"), ElementsAre("color.0001.exr", "color.0002.exr"));
    for (const char* name : {"color.0001.exr", "color.0002.exr"})
      EXPECT_EQ(test::load_exr(path("out") / name).pixels, test::load_exr(path("whole") / name).pixels) << name;
  }
}

TEST_F(Interrupted, StopsInTheFirstFrameToo) {
  std::vector<std::string> command = arguments();
  command.insert(command.end(), {"--frames", "4-5"});
  Program program(command);
  ASSERT_TRUE(program.wait_for_error_text("\nwaiting\n"));
  program.send(SIGTERM);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.code, 75) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("frames done: none; not computed: 4-5\n"));
  EXPECT_THAT(list("out"), ElementsAre());
}

TEST_F(Interrupted, StopsAtOnceWhenTheSignalComesTwice) {
  std::vector<std::string> command = arguments();
  command.insert(command.end(), {"--set", "scale.stubborn=true"});
  Program program(command);
  ASSERT_TRUE(wait_until_stuck(program));
  program.send(SIGINT);
  ASSERT_TRUE(program.wait_for_error_text("stopping"));
  program.send(SIGINT);
  EXPECT_EQ(program.finish().code, 75);
  EXPECT_THAT(list("out"), ElementsAre("color.0001.exr", "color.0002.exr"));
}

}  // namespace
}  // namespace quell::app::testing
