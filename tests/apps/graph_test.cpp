// quell graph: the plan, for people.
#include <gmock/gmock.h>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class GraphCommand : public RunnerTest {
 protected:
  std::string make_graph_with_option() {
    write_file("optional.json", R"({ "quell": 1, "inputs": { "color": "color", "extra": { "type": "color", "optional": true } },
  "nodes": { "side": { "pass": "test_scale", "in": { "color": "extra" } },
             "scale": { "pass": "test_scale", "in": { "color": "color", "more": ["side.color"] } } },
  "outputs": { "color": "scale.color" } })");
    return text("optional.json");
  }
};

TEST_F(GraphCommand, ShowsThePlanForFullHd) {
  const Outcome outcome = run({"graph", make_graph()});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("scale: test_scale"));
  EXPECT_THAT(outcome.out, HasSubstr("1920 x 1080"));
}

TEST_F(GraphCommand, ShowsThePlanForASizeOrASequence) {
  make_shot(1);
  EXPECT_THAT(run({"graph", make_graph(), "--size", "64x48"}).out, HasSubstr("64 x 48"));
  EXPECT_THAT(run({"graph", make_graph(), text("shot")}).out, HasSubstr("16 x 8"));
}

TEST_F(GraphCommand, ShowsWhatAnAbsentInputTakesAway) {
  const std::string graph = make_graph_with_option();
  const Outcome all = run({"graph", graph});
  const Outcome less = run({"graph", graph, "--without", "extra"});
  EXPECT_EQ(less.code, 0) << less.err;
  EXPECT_THAT(all.out, HasSubstr("side: test_scale"));
  EXPECT_THAT(less.out, Not(HasSubstr("side: test_scale")));
}

TEST_F(GraphCommand, RefusesSizesThatAreNone) {
  for (const char* size : {"64", "64x", "x48", "0x48", "64x48x2", "-1x5", "70000x1"}) {
    const Outcome outcome = run({"graph", make_graph(), "--size", size});
    EXPECT_EQ(outcome.code, 2) << size;
    EXPECT_THAT(outcome.err, HasSubstr("error: --size: '")) << size;
  }
}

TEST_F(GraphCommand, LeavesOutOptionalInputsAlone) {
  const Outcome outcome = run({"graph", make_graph_with_option(), "--without", "color"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: --without: the graph has no optional input 'color'; it has 'extra'\n");
  EXPECT_THAT(run({"graph", make_graph(), "--without", "color"}).err, HasSubstr("; all its inputs are required"));
}

}  // namespace
}  // namespace quell::app::testing
