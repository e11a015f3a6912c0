// Which nodes run together, and what of their images is kept.
#include "tests/core/graph/plan_graphs.h"

namespace quell::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const InputShapes kShapes{{"color", image(100, 300)}};

Plan plan_of(Builder& builder, const InputShapes& shapes = kShapes, const std::vector<std::string>& dumps = {},
             bool fuse = true) {
  return make_plan(builder.build(), shapes, dumps, fuse);
}

/// "a+b" for each turn.
std::vector<std::string> turns(const Plan& plan) {
  std::vector<std::string> all;
  for (const PlannedTurn& turn : plan.turns) {
    std::string& text = all.emplace_back();
    for (const int position : turn.nodes)
      text += (text.empty() ? "" : "+") +
              plan.graph->nodes[static_cast<std::size_t>(plan.nodes[static_cast<std::size_t>(position)].node)].name;
  }
  return all;
}
std::vector<std::string> inner(const Plan& plan) {
  std::vector<std::string> all;
  for (const Endpoint& endpoint : plan.inner) all.push_back(plan.graph->describe(endpoint));
  return all;
}

TEST(Fusion, RunsAChainTogetherAndKeepsNothingBetween) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}}).node("b", rows(), {{"color", {"a.color"}}});
  builder.node("c", rows(), {{"color", {"b.color"}}}).output("c.color");
  const Plan plan = plan_of(builder);
  EXPECT_THAT(turns(plan), ElementsAre("a+b+c"));
  EXPECT_THAT(inner(plan), ElementsAre("a.color", "b.color"));
  EXPECT_THAT(plan.turns[0].ahead, ElementsAre(0, 0, 0));
  EXPECT_EQ(plan.turns[0].rows, 8);
  EXPECT_EQ(plan.turns[0].band, 8) << "nothing is computed twice";
  EXPECT_EQ(plan.turns[0].window_bytes, 2 * bytes(100, 8, 3));
  EXPECT_EQ(plan.frame_bytes, 2 * bytes(100, 300, 3)) << "the input and the output";
}

TEST(Fusion, CanBeTurnedOff) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}}).node("b", rows(), {{"color", {"a.color"}}}).output("b.color");
  const Plan plan = plan_of(builder, kShapes, {}, false);
  EXPECT_THAT(turns(plan), ElementsAre("a", "b"));
  EXPECT_THAT(inner(plan), IsEmpty());
  EXPECT_FALSE(plan.turns[0].is_fused());
}

// b needs a row more on each side of its own, and of a two more than that, so that c can do its work.
TEST(Fusion, LetsNodesRunAheadOfThoseThatReadAroundAPixel) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}}).node("b", rows(), {{"color", {"a.color"}}}, {{"radius", 2}});
  builder.node("c", rows(), {{"color", {"b.color"}}}, {{"radius", 1}}).output("c.color");
  const Plan plan = plan_of(builder);
  EXPECT_THAT(turns(plan), ElementsAre("a+b+c"));
  EXPECT_THAT(plan.turns[0].ahead, ElementsAre(3, 1, 0));
  EXPECT_EQ(plan.turns[0].band, 96);
  ASSERT_EQ(plan.turns[0].windows.size(), 2u);
  EXPECT_EQ(plan.turns[0].windows[0].rows, 8 + 2 * 3);
  EXPECT_EQ(plan.turns[0].windows[1].rows, 8 + 2 * 1);
}

TEST(Fusion, KeepsWholeWhatSomebodyElseNeeds) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}}).node("b", rows(), {{"color", {"a.color"}}});
  builder.node("c", rows(), {{"color", {"b.color"}}}).node("far", mix(), {{"color", {"a.color"}}});
  builder.output("c.color").output("far.color");
  const auto graph = builder.build();
  EXPECT_THAT(inner(make_plan(graph, kShapes)), ElementsAre("b.color")) << "'far' reads a.color";
  EXPECT_THAT(inner(make_plan(graph, kShapes, {"b.color"})), IsEmpty()) << "b.color is dumped";
}

TEST(Fusion, KeepsWholeWhatIsHistory) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}, {"more", {Wire("b.color", 1)}}});
  builder.node("b", rows(), {{"color", {"a.color"}}})
      .node("c", rows(), {{"color", {"b.color"}}}, {{"radius", 1}})
      .output("c.color");
  const Plan plan = plan_of(builder);
  EXPECT_THAT(turns(plan), ElementsAre("a+b+c"));
  EXPECT_THAT(inner(plan), ElementsAre("a.color"));
  ASSERT_EQ(plan.turns[0].windows.size(), 2u);
  EXPECT_TRUE(plan.turns[0].windows[1].whole) << "b runs ahead, so that its rows go through a window";
}

TEST(Fusion, StopsWherePixelsFromFarOffAreRead) {
  for (const int radius : {-1, 3}) {
    Builder builder;
    builder.input("color").node("a", rows(), {{"color", {"color"}}});
    builder.node("b", rows(), {{"color", {"a.color"}}}, {{"radius", radius}}).output("b.color");
    EXPECT_THAT(turns(plan_of(builder)), ElementsAre("a", "b")) << radius;
  }
}

// What runs ahead is computed twice around each band, and is kept meanwhile.
TEST(Fusion, CutsAChainBeforeItsNodesRunFarAhead) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}});
  for (const char* name : {"b", "c", "d", "e", "f"})
    builder.node(name, rows(), {{"color", {std::string(1, static_cast<char>(*name - 1)) + ".color"}}}, {{"radius", 2}});
  const Plan plan = plan_of(builder.output("f.color"));
  EXPECT_THAT(turns(plan), ElementsAre("a+b+c+d", "e+f"));
  EXPECT_THAT(plan.turns[0].ahead, ElementsAre(6, 4, 2, 0));
}

TEST(Fusion, StopsAtPassesThatDoNotWorkRowByRow) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}}).node("far", mix(), {{"color", {"a.color"}}});
  builder.node("b", rows(), {{"color", {"a.color"}}, {"more", {"far.color"}}}).output("b.color");
  EXPECT_THAT(turns(plan_of(builder)), ElementsAre("a", "far", "b")) << "'far' needs a, and b needs 'far'";
}

TEST(Fusion, MakesWayForWhatLiesBetweenTwoGroups) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}}).node("b", rows(), {{"color", {"a.color"}}});
  builder.node("far", mix(), {{"color", {"color"}}}).node("c", rows(), {{"color", {"b.color"}}, {"more", {"far.color"}}});
  builder.output("c.color");
  EXPECT_THAT(turns(plan_of(builder)), ElementsAre("far", "a+b+c")) << "'far' needs none of them, and runs first";
}

TEST(Fusion, StopsAtAnInitialValue) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}});
  builder.node("b", rows(), {{"color", {"a.color"}}, {"more", {Wire("b.color", 1, "a.color")}}}).output("b.color");
  EXPECT_THAT(turns(plan_of(builder)), ElementsAre("a", "b")) << "which is needed whole";
}

TEST(Fusion, StopsAtAnotherHeight) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}}).node("half", resize(), {{"color", {"a.color"}}});
  builder.node("b", rows(), {{"color", {"half.color"}}}).output("b.color");
  EXPECT_THAT(turns(plan_of(builder)), ElementsAre("a", "half", "b"));
}

TEST(Fusion, WritesOverAnInputThatNobodyElseReads) {
  Builder builder;
  builder.input("color").node("far", mix(), {{"color", {"color"}}});
  builder.node("a", rows(), {{"color", {"far.color"}}}, {{"in_place", 1}})
      .node("b", rows(), {{"color", {"a.color"}}}, {{"in_place", 1}});
  builder.output("a.color").output("b.color");
  const Plan plan = plan_of(builder);
  EXPECT_EQ(planned(plan, "a").in_place_of, std::vector<int>{0});
  EXPECT_EQ(planned(plan, "b").in_place_of, std::vector<int>{-1}) << "what fused nodes yield stays as it is";
}

// What passes row by row has no buffer that could take the place of another one.
TEST(Fusion, CountsAnInputThatIsReadIntoAWindowUntilItIsReleased) {
  Builder builder;
  builder.input("color").node("far", mix(), {{"color", {"color"}}});
  builder.node("a", rows(), {{"color", {"far.color"}}}, {{"in_place", 1}}).node("b", rows(), {{"color", {"a.color"}}});
  builder.node("last", mix(), {{"color", {"b.color"}}}).output("last.color");
  const Plan plan = plan_of(builder);
  EXPECT_THAT(turns(plan), ElementsAre("far", "a+b", "last"));
  EXPECT_EQ(plan.alive_bytes[3], 2 * bytes(100, 300, 3) + bytes(100, 300, 1)) << "far.color is gone";
}

TEST(Fusion, LeavesAnInputAsItIsThatAnotherOneReads) {
  Builder builder;
  builder.input("color").node("far", mix(), {{"color", {"color"}}});
  builder.node("a", rows(), {{"color", {"far.color"}}}, {{"in_place", 1}});
  builder.node("b", rows(), {{"color", {"a.color"}}, {"more", {"far.color"}}}).output("b.color");
  EXPECT_EQ(planned(plan_of(builder), "a").in_place_of, std::vector<int>{-1});
}

TEST(Fusion, TakesFewerRowsOfWideImages) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}}).node("b", rows(), {{"color", {"a.color"}}}).output("b.color");
  const Plan plan = plan_of(builder, {{"color", image(16384, 100)}});
  EXPECT_EQ(plan.turns[0].rows, 1);
}

TEST(Fusion, RefusesAPromiseThatCannotBeKept) {
  const auto with_scratch = [](const void*, const quell_host*, quell_inference* inference) {
    inference->by_rows = 1, inference->scratch_bytes = 64;
    return QUELL_OK;
  };
  Builder builder;
  builder.input("color").node("a", with_infer(*rows(), with_scratch), {{"color", {"color"}}}).output("a.color");
  EXPECT_THAT(error_of(builder.build(), kShapes, {}, Fault::plugin),
              ::testing::HasSubstr("it works row by row, but asks for scratch memory for the whole frame"));
}

TEST(Fusion, IsTold) {
  Builder builder;
  builder.input("color").node("a", rows(), {{"color", {"color"}}}).node("b", rows(), {{"color", {"a.color"}}}).output("b.color");
  const std::string text = describe(plan_of(builder));
  EXPECT_THAT(text, ::testing::HasSubstr("\n fused: a, b; 8 rows at a time, 12.0 KiB a thread\n"));
  EXPECT_THAT(text, ::testing::HasSubstr("row by row\n"));
}

}  // namespace
}  // namespace quell::test
