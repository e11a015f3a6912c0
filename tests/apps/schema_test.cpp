// quell schema.
#include <gmock/gmock.h>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class Schema : public RunnerTest {};

// The file that ships knows the passes that ship, and no others.
TEST_F(Schema, ThatShipsIsTheOneOfTheBuiltInPasses) {
  const Outcome outcome = quell({"schema"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(outcome.out == read_file(QUELL_SOURCE_DIR "/graphs/quell-graph.schema.json"))
      << "graphs/quell-graph.schema.json is not that of the passes; `quell schema -o graphs/quell-graph.schema.json` renews it";
}

TEST_F(Schema, KnowsThePassesOfPlugins) {
  EXPECT_THAT(run({"schema"}).out, HasSubstr("\"pass_test_scale\": {"));
  EXPECT_THAT(quell({"schema"}).out, Not(HasSubstr("test_scale")));
}

TEST_F(Schema, IsWrittenToAFileAndReplacesAFormerOne) {
  for (int times = 0; times < 2; ++times) {
    const Outcome outcome = run({"schema", "-o", text("graphs.schema.json")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_EQ(read_file(path("graphs.schema.json")), run({"schema"}).out);
  EXPECT_THAT(list("."), ElementsAre("graphs.schema.json"));
}

TEST_F(Schema, DoesNotReplaceAnythingElse) {
  write_file("notes.json", "{ \"mine\": 1 }");
  const Outcome outcome = run({"schema", "-o", text("notes.json")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err,
            "error: --out: " + text("notes.json") + " is there, and was not written by this option; choose another name\n");
  EXPECT_EQ(read_file(path("notes.json")), "{ \"mine\": 1 }");
}

TEST_F(Schema, IsNotWrittenWhereNothingCanBe) {
  for (const char* place : {"none/graphs.schema.json", ".", ""}) {
    const Outcome outcome = run({"schema", "-o", *place ? text(place) : ""});
    EXPECT_EQ(outcome.code, 2) << place;
    EXPECT_THAT(outcome.err, HasSubstr("error: --out: ")) << place;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST_F(Schema, IsNotWrittenWhenAPluginThatWasAskedForDoesNotLoad) {
  write_file("broken.so", "not a plugin");
  const Outcome outcome = run({"schema", "-o", text("graphs.schema.json"), "--plugin-path", text("broken.so")});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("not an ELF shared object"));
  EXPECT_THAT(list("."), ElementsAre("broken.so"));
}

}  // namespace
}  // namespace quell::app::testing
