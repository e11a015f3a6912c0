// quell passes, and plugins that do not load.
#include <gmock/gmock.h>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Passes : public RunnerTest {};

TEST_F(Passes, AreListedWithVersionAndSummary) {
  const Outcome outcome = run({"passes"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("\ntest_scale +3  +Multiplies by a number\n"));
}

TEST_F(Passes, AreListedWithTheirPluginsWhenVerbose) {
  EXPECT_THAT(run({"passes", "-v"}).out, HasSubstr(std::string("  ") + TEST_PLUGINS + "/apps_test_passes.so\n    test_"));
}

TEST_F(Passes, AreDescribedInFull) {
  const Outcome outcome = run({"passes", "test_scale"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, R"(test_scale, version 3
  Multiplies by a number

  Every channel is multiplied by the same number. This line is long enough that a terminal of 100
  columns has to break it at least once.

  And there is a second paragraph.

inputs
  color             color, albedo or normal
                    what is multiplied
  more              list of color, optional
                    not used

outputs
  color             what 'color' is
                    the product

parameters
  gain              1 (number, 0 to 1000000000, in 1)
                    Factor of every value.
  at                [] (list of 0 to 10: whole number, -1000 to 1000, in frame)
                    Frames in which something goes wrong.
  wrong             "fail" (one of)
                    What goes wrong.
                      nothing           all is well
                      fail              the pass fails
                      warn              the pass logs a warning and a debug message
  wait_from         1000000 (whole number, -1000000 to 1000000, in frame)
                    From this frame on the pass waits to be cancelled.
  stubborn          false (true or false)
                    The pass does not hear that it is cancelled.
  table             "" (path)
                    Not used.

versions
  Graphs written for version 1 or later are understood.
  version 2         'factor' became 'gain'
  version 3         'wrong': its default was "nothing"

source
  Nobody, "On Multiplication", 1900, equation 1.

plugin
  )" + std::string(TEST_PLUGINS) +
                             "/apps_test_passes.so\n");
}

TEST_F(Passes, ThatDoNotExistAreSuggested) {
  const Outcome outcome = run({"passes", "test_scael"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, StartsWith("error: there is no pass 'test_scael'; did you mean 'test_scale'"));
  EXPECT_THAT(outcome.err, EndsWith("; `quell passes` lists those that were found\n"));
  EXPECT_EQ(outcome.out, "");
}

TEST_F(Passes, AreStillListedWhenAPluginThatWasAskedForDoesNotLoad) {
  write_file("plugins/broken.so", "not a plugin");
  const Outcome outcome = run({"passes", "--plugin-path", text("plugins")});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_EQ(outcome.err,
            "error: plugin " + text("plugins/broken.so") + ": not an ELF shared object: the file has no ELF header\n");
  EXPECT_THAT(outcome.out, HasSubstr("test_scale"));
  EXPECT_THAT(run({"passes", "-v", "--plugin-path", text("plugins")}).out,
              HasSubstr("broken.so\n    no passes\n    not loaded: not an ELF shared object"));
}

class Plugins : public RunnerTest {};

TEST_F(Plugins, ThatWereAskedForAndDoNotLoadEndTheRun) {
  make_shot(1);
  write_file("broken.so", "not a plugin");
  const Outcome outcome = run({"run", make_graph(), text("shot"), "-o", text("out"), "--plugin-path", text("broken.so")});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_EQ(outcome.err, "error: plugin " + text("broken.so") + ": not an ELF shared object: the file has no ELF header\n");
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Plugins, ThatWereAskedForAndAreNotThereEndTheRun) {
  for (const char* name : {"none", "none.so"}) {
    const Outcome outcome = run({"check", make_graph(), "--plugin-path", text(name)});
    EXPECT_EQ(outcome.code, 4) << name;
    EXPECT_THAT(outcome.err, HasSubstr("error: plugin " + text(name) + ": "));
  }
}

TEST_F(Plugins, OfTheEnvironmentThatDoNotLoadAreWarnedOf) {
  make_shot(1);
  write_file("plugins/broken.so", "not a plugin");
  const std::string graph = make_graph();
  const Outcome outcome = Program({"run", graph, text("shot"), "-o", text("out"), "-q", "--plugin-path", TEST_PLUGINS}, false,
                                  {"QUELL_PLUGIN_PATH=" + text("plugins")})
                              .finish();
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err,
            "warning: plugin " + text("plugins/broken.so") + ": not an ELF shared object: the file has no ELF header\n");
}

}  // namespace
}  // namespace quell::app::testing
