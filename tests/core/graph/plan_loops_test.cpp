// Loops and their smallest delays.
#include "tests/core/graph/plan_graphs.h"

namespace quell::test {
namespace {

using testing::ElementsAre;

const InputShapes kColor64{{"color", image(64, 32)}};

TEST(PlanLoops, AreNoneWhereDelaysOnlyLeadForward) {
  const auto graph = Builder()
                         .input("color")
                         .node("a", mix(), {{"color", {"color"}}})
                         .node("b", blend(), {{"color", {"a.color"}}, {"history", {Wire("a.color", 1)}}})
                         .output("b.color")
                         .build();
  EXPECT_TRUE(make_plan(graph, kColor64).loops.empty());
}

TEST(PlanLoops, MayBeASingleNode) {
  const auto graph = Builder()
                         .input("color")
                         .node("a", mix(), {{"color", {"color"}}})
                         .node("b", blend(), {{"color", {"a.color"}}, {"history", {Wire("b.color", 2)}}})
                         .output("b.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  ASSERT_EQ(plan.loops.size(), 1u);
  EXPECT_THAT(plan.loops[0].nodes, ElementsAre(1));
  EXPECT_EQ(plan.loops[0].delay, 2);
}

TEST(PlanLoops, ThatShareANodeAreOneWithTheSmallerDelay) {
  const auto graph = Builder()
                         .input("color")
                         .node("before", mix(), {{"color", {"color"}}})
                         .node("a", mix(), {{"color", {"before.color"}}, {"more", {Wire("b.color", 3), Wire("c.color", 2)}}})
                         .node("b", mix(), {{"color", {"a.color"}}})
                         .node("c", mix(), {{"color", {"a.color"}}})
                         .node("after", mix(), {{"color", {"b.color"}}, {"more", {"c.color"}}})
                         .output("after.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  ASSERT_EQ(plan.loops.size(), 1u);
  EXPECT_THAT(plan.loops[0].nodes, ElementsAre(1, 2, 3));
  EXPECT_EQ(plan.loops[0].delay, 2);
}

TEST(PlanLoops, AddUpTheDelaysAroundThem) {
  const auto graph = Builder()
                         .input("color")
                         .node("a", mix(), {{"color", {"color"}}, {"more", {Wire("b.color", 2)}}})
                         .node("b", mix(), {{"color", {"color"}}, {"more", {Wire("a.color", 5)}}})
                         .output("a.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  ASSERT_EQ(plan.loops.size(), 1u);
  EXPECT_THAT(plan.loops[0].nodes, ElementsAre(0, 1));
  EXPECT_EQ(plan.loops[0].delay, 7);
}

TEST(PlanLoops, ThatShareNothingStandApart) {
  const auto graph = Builder()
                         .input("color")
                         .node("a", blend(), {{"color", {"color"}}, {"history", {Wire("b.color", 1)}}})
                         .node("b", mix(), {{"color", {"a.color"}}})
                         .node("c", blend(), {{"color", {"b.color"}}, {"history", {Wire("c.color", 4)}}})
                         .output("c.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  ASSERT_EQ(plan.loops.size(), 2u);
  EXPECT_THAT(plan.loops[0].nodes, ElementsAre(0, 1));
  EXPECT_EQ(plan.loops[0].delay, 1);
  EXPECT_THAT(plan.loops[1].nodes, ElementsAre(2));
  EXPECT_EQ(plan.loops[1].delay, 4);
}

TEST(PlanLoops, MayCloseThroughAnInitialValue) {
  // b's first value comes from a in the same frame, and a reads b's earlier one.
  const auto graph = Builder()
                         .input("color")
                         .node("a", blend(), {{"color", {"color"}}, {"history", {Wire("b.color", 2)}}})
                         .node("b", mix(), {{"color", {Wire("color", 1, "a.color")}}})
                         .output("b.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  ASSERT_EQ(plan.loops.size(), 1u);
  EXPECT_THAT(plan.loops[0].nodes, ElementsAre(0, 1));
  EXPECT_EQ(plan.loops[0].delay, 2);
}

TEST(PlanLoops, OfNodesThatDoNotRunAreNotTold) {
  const auto graph = Builder()
                         .input("color")
                         .node("idle", blend(), {{"color", {"color"}}, {"history", {Wire("idle.color", 1)}}})
                         .node("b", mix(), {{"color", {"color"}}})
                         .output("b.color")
                         .build();
  EXPECT_TRUE(make_plan(graph, kColor64).loops.empty());
}

TEST(PlanLoops, OfThousandsOfNodesAreFound) {
  constexpr int kNodes = 3000;
  Builder builder;
  builder.input("color").node("n0", blend(), {{"color", {"color"}}, {"history", {Wire("n2999.color", 1)}}});
  for (int i = 1; i < kNodes; ++i)
    builder.node("n" + std::to_string(i), mix(), {{"color", {"n" + std::to_string(i - 1) + ".color"}}});
  const Plan plan = make_plan(builder.output("n2999.color").build(), kColor64);
  ASSERT_EQ(plan.loops.size(), 1u);
  EXPECT_EQ(plan.loops[0].nodes.size(), 3000u);
  EXPECT_EQ(plan.loops[0].delay, 1);
}

}  // namespace
}  // namespace quell::test
