// Which nodes run, and the errors of inputs and outputs.
#include "tests/core/graph/plan_graphs.h"

namespace quell::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const InputShapes kColor64{{"color", image(64, 32)}};

TEST(Plan, RunsNodesInTheOrderOfTheGraph) {
  const auto graph = Builder()
                         .input("color")
                         .node("a", mix(), {{"color", {"color"}}})
                         .node("b", mix(), {{"color", {"color"}}})
                         .node("c", mix(), {{"color", {"a.color"}}, {"more", {"b.color"}}})
                         .output("c.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  EXPECT_THAT(running(plan), ElementsAre("a", "b", "c"));
  EXPECT_THAT(plan.pruned, ElementsAre());
  EXPECT_THAT(plan.outputs, ElementsAre(0));
  EXPECT_EQ(plan.graph, graph);
}

TEST(Plan, LeavesOutWhatFeedsNothing) {
  const auto graph = Builder()
                         .input("color")
                         .input("other")
                         .node("idle", mix(), {{"color", {"other"}}})
                         .node("idle_too", mix(), {{"color", {"idle.color"}}})
                         .node("used", mix(), {{"color", {"color"}}})
                         .output("used.color")
                         .build();
  const Plan plan = make_plan(graph, {{"color", image(64, 32)}, {"other", image(64, 32)}});
  EXPECT_THAT(running(plan), ElementsAre("used"));
  EXPECT_THAT(plan.pruned, ElementsAre(0, 1));
  EXPECT_THAT(plan.input_used, ElementsAre(true, false));
  EXPECT_FALSE(plan.shape({0, 0, 0}).present);
  EXPECT_EQ(plan.frame_bytes, 2 * bytes(64, 32, 3) + bytes(64, 32, 1)) << "an input that is not used needs no memory";
}

TEST(Plan, KeepsWhatFeedsADumpAlone) {
  const auto graph = Builder()
                         .input("color")
                         .node("a", mix(), {{"color", {"color"}}})
                         .node("b", mix(), {{"color", {"color"}}})
                         .output("b.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64, {"a.weight", "a.weight"});
  EXPECT_THAT(running(plan), ElementsAre("a", "b"));
  EXPECT_THAT(plan.dumps, ElementsAre(Endpoint{0, 1, 0})) << "once, though named twice";
}

TEST(Plan, KeepsWhatFeedsTheHistoryOfWhatRuns) {
  const auto graph = Builder()
                         .input("color")
                         .node("now", mix(), {{"color", {"color"}}})
                         .node("blend", blend(), {{"color", {"color"}}, {"history", {Wire("keeper.color", 1)}}})
                         .node("keeper", mix(), {{"color", {"now.color"}}})
                         .output("blend.color")
                         .build();
  EXPECT_THAT(running(make_plan(graph, kColor64)), ElementsAre("now", "blend", "keeper"));
}

TEST(Plan, KeepsWhatMakesAnInitialValue) {
  const auto graph = Builder()
                         .input("color")
                         .node("first", mix(), {{"color", {"color"}}})
                         .node("blend", blend(), {{"color", {"color"}}, {"history", {Wire("blend.color", 1, "first.color")}}})
                         .output("blend.color")
                         .build();
  EXPECT_THAT(running(make_plan(graph, kColor64)), ElementsAre("first", "blend"));
}

TEST(Plan, LeavesOutANodeThatLacksARequiredInputWhenItsConsumerCanDoWithout) {
  const auto graph = Builder()
                         .input("color")
                         .input("normal", QUELL_TYPE_NORMAL, true)
                         .node("smooth", mix(), {{"color", {"normal"}}})
                         .node("edges", mix(), {{"color", {"smooth.color"}}})
                         .node("filter", mix(), {{"color", {"color"}}, {"more", {"edges.color"}}})
                         .output("filter.color")
                         .build();
  const Plan without = make_plan(graph, kColor64);
  EXPECT_THAT(running(without), ElementsAre("filter"));
  EXPECT_FALSE(without.inputs[1].present);
  EXPECT_FALSE(without.input_used[1]);
  EXPECT_FALSE(make_plan(graph, {{"color", image(64, 32)}, {"normal", std::nullopt}}).inputs[1].present);
  const Plan with = make_plan(graph, {{"color", image(64, 32)}, {"normal", image(64, 32, QUELL_TYPE_NORMAL)}});
  EXPECT_THAT(running(with), ElementsAre("smooth", "edges", "filter"));
}

TEST(Plan, TreatsHistoryOfAnAbsentSourceAsAlwaysAbsent) {
  const auto graph = Builder()
                         .input("color")
                         .input("depth", QUELL_TYPE_DEPTH, true)
                         .node("guide", mix(), {{"color", {"depth"}}})
                         .node("filter", mix(), {{"color", {"color"}}, {"more", {Wire("guide.color", 1), Wire("depth", 2)}}})
                         .output("filter.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  EXPECT_THAT(running(plan), ElementsAre("filter"));
  EXPECT_TRUE(plan.histories.empty());
}

TEST(Plan, TreatsHistoryOfAnAbsentSourceAsAlwaysItsInitialValue) {
  Builder builder;
  const auto graph = builder.input("color")
                         .input("other", QUELL_TYPE_COLOR, true)
                         .node("first", mix(), {{"color", {"color"}}})
                         .node("a", mix(), {{"color", {Wire("other", 1, "first.color")}}})
                         .node("b", mix(), {{"color", {Wire("other", 1, "=0.5")}}, {"more", {"a.color"}}})
                         .output("b.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  EXPECT_THAT(running(plan), ElementsAre("first", "a", "b"));
  EXPECT_EQ(plan.shape(builder.endpoint("b.color")).size, (Size{64, 32})) << "a constant takes the size of the node's images";
  EXPECT_TRUE(plan.histories.empty());
}

TEST(Plan, LeavesOutAnItemOfAnArrayThatMirrorsAnAbsentOne) {
  Builder builder;
  const auto graph = builder.input("color")
                         .input("specular", QUELL_TYPE_COLOR, true)
                         .node("filter", channels(), {{"guide", {"color"}}, {"in", {"color", "specular"}}})
                         .node("sum", mix(), {{"color", {"filter.out[0]"}}, {"more", {"filter.out[1]"}}})
                         .node("lobe", mix(), {{"color", {"filter.out[1]"}}})
                         .node("end", mix(), {{"color", {"sum.color"}}, {"more", {"lobe.color"}}})
                         .output("end.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  EXPECT_THAT(running(plan), ElementsAre("filter", "sum", "end"));
  EXPECT_TRUE(plan.shape(builder.endpoint("filter.out[0]")).present);
  EXPECT_FALSE(plan.shape(builder.endpoint("filter.out[1]")).present);
}

TEST(PlanErrors, TellEveryRequiredInputThatIsMissingAtItsPlace) {
  const auto graph = Builder()
                         .input("color")
                         .input("normal", QUELL_TYPE_NORMAL)
                         .input("depth", QUELL_TYPE_DEPTH)
                         .node("a", mix(), {{"color", {"normal"}}, {"more", {"depth"}}})
                         .output("a.color")
                         .build();
  const std::string error = error_of(graph, {{"color", image(8, 8)}, {"albedo", image(8, 8)}, {"depth", std::nullopt}});
  EXPECT_THAT(error,
              HasSubstr("graph.json:2:1: error: the graph needs the input 'normal' of type normal (world space, unit "
                        "length, 0 where there is no surface), which the source does not have; it has 'albedo' and 'color'\n"
                        "    normal\n    ^"));
  EXPECT_THAT(error, HasSubstr("graph.json:3:1: error: the graph needs the input 'depth'"));
  EXPECT_THAT(error, Not(HasSubstr("output"))) << "what follows from it is not an error of its own";
}

TEST(PlanErrors, TellAnInputOfAnotherTypeOrAnImpossibleSize) {
  const auto graph = Builder()
                         .input("color")
                         .input("depth", QUELL_TYPE_DEPTH)
                         .node("a", mix(), {{"color", {"color"}}})
                         .output("a.color")
                         .build();
  const std::string error = error_of(graph, {{"color", image(0, 8)}, {"depth", image(8, 8)}});
  EXPECT_THAT(error,
              HasSubstr("graph.json:1:1: error: the source gives 'color' the size 0 x 8; sides from 1 to 65536 are possible"));
  EXPECT_THAT(error, HasSubstr("graph.json:2:1: error: the input 'depth' is of type depth, but the source gives color"));
}

TEST(PlanErrors, ExplainWhyAnOutputCannotBeComputed) {
  const auto graph = Builder()
                         .input("color")
                         .input("albedo", QUELL_TYPE_ALBEDO, true)
                         .node("divide", mix(), {{"color", {"albedo"}}})
                         .node("end", mix(), {{"color", {"color"}}, {"more", {"color"}}})
                         .node("multiply", mix(), {{"color", {"divide.weight"}}})
                         .output("multiply.color")
                         .output("albedo")
                         .output("end.color")
                         .build();
  const std::string error = error_of(graph, kColor64);
  EXPECT_THAT(error,
              HasSubstr("error: the output 'out' cannot be computed: 'multiply' needs 'divide.weight' as 'color', 'divide' "
                        "needs 'albedo' as 'color', and the source does not have 'albedo'\n    output multiply.color\n"));
  EXPECT_THAT(error, HasSubstr("cannot be computed: the source does not have 'albedo'\n    output albedo\n"));
  EXPECT_THAT(error, Not(HasSubstr("output end.color")));
}

TEST(PlanErrors, TellAnInitialValueThatIsAbsent) {
  const auto graph = Builder()
                         .input("color")
                         .input("depth", QUELL_TYPE_DEPTH, true)
                         .node("a", mix(), {{"color", {Wire("color", 1, "depth")}}})
                         .output("a.color")
                         .build();
  EXPECT_THAT(error_of(graph, kColor64), HasSubstr("'a' needs 'depth' as 'color', and the source does not have 'depth'"));
}

TEST(PlanErrors, TellEveryDumpThatCannotBe) {
  const auto graph = Builder()
                         .input("color")
                         .input("depth", QUELL_TYPE_DEPTH, true)
                         .node("a", mix(), {{"color", {"color"}}})
                         .node("b", mix(), {{"color", {"depth"}}})
                         .output("a.color")
                         .build();
  const std::string error = error_of(graph, kColor64, {"a.colour", "b.color", "a.weight"});
  EXPECT_THAT(error, HasSubstr("colour"));
  EXPECT_THAT(error, HasSubstr("'b.color' cannot be dumped: 'b' needs 'depth' as 'color', and the source does not have 'depth'"));
}

TEST(PlanErrors, StandWhereTheyAreInAGraphFile) {
  Registry registry;
  const quell_pass_desc* const passes[] = {mix(), resize()};
  registry.add(passes, 2);
  const auto text = std::make_shared<const SourceText>(SourceText{"half.json", R"({
  "quell": 1,
  "inputs": { "color": "color", "depth": "depth" },
  "nodes": {
    "half": { "pass": "resize", "in": { "color": "color" } },
    "join": { "pass": "mix", "in": { "color": "color", "more": ["depth", "half.color"] } }
  },
  "outputs": { "color": "join.color" }
})"});
  const auto graph = parse_graph(text, registry);
  EXPECT_THAT(error_of(graph, kColor64), HasSubstr("half.json:3:33: error: the graph needs the input 'depth'"));
  EXPECT_THAT(error_of(graph, {{"color", image(64, 32)}, {"depth", image(64, 32, QUELL_TYPE_DEPTH)}}),
              HasSubstr("half.json:6:74: error: 'more[1]' of 'join' is 32 x 16 (from 'half.color')"));
}

}  // namespace
}  // namespace quell::test
