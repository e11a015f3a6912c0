// quell check: the whole truth about a graph and a sequence, and nothing computed.
#include <gmock/gmock.h>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;

class Check : public RunnerTest {};

TEST_F(Check, SaysThatAGraphIsRight) {
  const std::string graph = make_graph();
  const Outcome outcome = run({"check", graph});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, graph + ": ok: 1 node, 1 input, 1 output\n");
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Check, SaysThatASequenceFits) {
  make_shot(3);
  const Outcome outcome = run({"check", make_graph(), text("shot"), "-q"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("\n" + text("shot") + ": ok: 3 frames (1-3), 16 x 8, "));
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Check, ShowsEveryMistakeWithItsPlace) {
  write_file("wrong.json",
             "{ \"quell\": 1,\n  \"inputs\": { \"color\": \"colour\" },\n"
             "  \"nodes\": { \"a\": { \"pass\": \"test_scal\", \"in\": { \"color\": \"color\" } } },\n"
             "  \"outputs\": { \"color\": \"a.color\" } }\n");
  const Outcome outcome = run({"check", text("wrong.json")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err.rfind(text("wrong.json") + ":2:", 0), 0U) << "no label before the place: " << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(text("wrong.json") + ":3:"));
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'test_scale'"));
}

TEST_F(Check, RefusesParametersThatDoNotExist) {
  const Outcome outcome = run({"check", make_graph(), "--set", "scale.gian=2"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("gain"));
}

TEST_F(Check, RefusesAGraphThatDoesNotExist) {
  const Outcome path = run({"check", text("none.json")});
  EXPECT_EQ(path.code, 2);
  EXPECT_THAT(path.err, HasSubstr("error: " + text("none.json") + ": there is no such graph file; quell ships with "));
  const Outcome name = run({"check", "game202"});
  EXPECT_EQ(name.code, 2);
  EXPECT_THAT(name.err, HasSubstr("error: game202: there is no such graph file; did you mean 'games202'?"));
  make_graph();
  EXPECT_THAT(run({"check", text("graph")}).err, HasSubstr("; did you mean '" + text("graph.json") + "'?"));
  const Outcome folder = run({"check", text("")});
  EXPECT_EQ(folder.code, 2);
  EXPECT_THAT(folder.err, HasSubstr(": this is a folder, not a graph file"));
}

TEST_F(Check, TellsThatAPassBreaksTheInterface) {
  make_shot(1);
  write_file("liar.json", R"({ "quell": 1, "inputs": { "color": "color" },
  "nodes": { "liar": { "pass": "test_liar", "in": { "color": "color" } } }, "outputs": { "color": "liar.color" } })");
  const Outcome outcome = run({"check", text("liar.json"), text("shot"), "-q"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_THAT(outcome.err,
              HasSubstr("'liar': pass 'test_liar': infer breaks the plugin interface: output 'color' is given the size -1 x 7"));
}

TEST_F(Check, NamesInputsThatAreMissing) {
  write_file("shot/normal.0001.exr", "");
  const Outcome outcome = run({"check", make_graph(), text("shot"), "-q"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("inputs of the graph 'small' are missing:\n  color (color)\nthe sequence has: normal\n"));
}

}  // namespace
}  // namespace quell::app::testing
