// Lifetimes, in place, history and sums of bytes, all worked out by hand.
#include "tests/core/graph/plan_graphs.h"

namespace quell::test {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

const InputShapes kColor64{{"color", image(64, 32)}};
// All images are 64 x 32 unless told otherwise; a color has three planes, a node writes a color and a weight of one plane.
const std::size_t kPlane = bytes(64, 32, 1);

// Names of what the node is the last to use.
std::vector<std::string> last_uses(const Plan& plan, const std::string& node, const Builder& builder,
                                   const std::vector<std::string>& candidates) {
  std::vector<std::string> found;
  for (const std::string& name : candidates)
    for (const Endpoint& endpoint : planned(plan, node).last_uses)
      if (endpoint == builder.endpoint(name)) found.push_back(name);
  EXPECT_EQ(found.size(), planned(plan, node).last_uses.size());
  return found;
}

TEST(PlanBuffers, OfAChainLiveFromOneNodeToTheNext) {
  Builder builder;
  const auto graph = builder.input("color")
                         .node("a", mix(), {{"color", {"color"}}})
                         .node("b", mix(), {{"color", {"a.color"}}})
                         .node("c", mix(), {{"color", {"b.color"}}, {"more", {"a.weight"}}})
                         .output("c.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  const std::vector<std::string> all{"color", "a.color", "a.weight", "b.color", "b.weight", "c.color", "c.weight"};
  EXPECT_THAT(last_uses(plan, "a", builder, all), ElementsAre("color"));
  EXPECT_THAT(last_uses(plan, "b", builder, all), ElementsAre("a.color", "b.weight"));
  EXPECT_THAT(last_uses(plan, "c", builder, all), ElementsAre("a.weight", "b.color", "c.weight"));
  // While b runs: a's 4 planes and b's 4. While a runs: 3 + 4. While c runs: 1 + 3 + 4.
  EXPECT_EQ(plan.frame_bytes, 8 * kPlane);
  EXPECT_EQ(plan.unshared_bytes, (3 + 3 * 4) * kPlane);
  EXPECT_EQ(plan.history_bytes, 0u);
}

TEST(PlanBuffers, OfOutputsDumpsAndHistoryLastTheFrame) {
  Builder builder;
  const auto graph = builder.input("color")
                         .node("a", mix(), {{"color", {"color"}}})
                         .node("b", blend(), {{"color", {"a.color"}}, {"history", {Wire("a.color", 1)}}})
                         .node("c", mix(), {{"color", {"b.color"}}})
                         .node("d", mix(), {{"color", {"c.color"}}})
                         .output("b.color")
                         .output("d.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64, {"a.weight"});
  const std::vector<std::string> all{"color", "a.color", "a.weight", "b.color", "c.color", "c.weight", "d.color", "d.weight"};
  EXPECT_THAT(last_uses(plan, "b", builder, all), ElementsAre());
  EXPECT_THAT(last_uses(plan, "c", builder, all), ElementsAre("c.weight"));
  EXPECT_THAT(last_uses(plan, "d", builder, all), ElementsAre("c.color", "d.weight"));
  // While d runs: a's 4, b's 3, c.color 3, d's 4.
  EXPECT_EQ(plan.frame_bytes, 14 * kPlane);
  EXPECT_EQ(plan.history_bytes, 3 * kPlane);
}

TEST(PlanBuffers, CountScratchWhileItsNodeRuns) {
  const auto graph = Builder()
                         .input("color")
                         .node("a", mix(), {{"color", {"color"}}}, {{"scratch", 1000000}})
                         .node("b", mix(), {{"color", {"a.color"}}}, {{"scratch", 500000}})
                         .output("b.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  EXPECT_EQ(plan.frame_bytes, 7 * kPlane + 1000000);
  EXPECT_EQ(plan.unshared_bytes, 11 * kPlane + 1500000);
}

TEST(PlanBuffers, CountSizesOfEachImage) {
  const auto graph = Builder()
                         .input("color")
                         .node("half", resize(), {{"color", {"color"}}})
                         .node("m", meter(), {{"color", {"half.color"}}})
                         .output("m.value")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  EXPECT_EQ(plan.frame_bytes, bytes(64, 32, 3) + bytes(32, 16, 3));
  EXPECT_EQ(plan.unshared_bytes, bytes(64, 32, 3) + bytes(32, 16, 3) + 5 * sizeof(double));
}

// A graph with the node "x", which would like to work in place of 'a.color'.
class InPlace : public testing::Test {
 protected:
  InPlace() { builder_.input("color").input("depth", QUELL_TYPE_DEPTH).node("a", mix(), {{"color", {"color"}}}); }
  Plan plan(const std::vector<std::string>& dumps = {}) {
    if (!graph_) graph_ = builder_.build();
    return make_plan(graph_, {{"color", image(64, 32)}, {"depth", image(64, 32, QUELL_TYPE_DEPTH)}}, dumps);
  }
  static int place(const Plan& plan) { return planned(plan, "x").in_place_of[0]; }
  static constexpr int kColorPort = 0, kNone = -1;
  const std::map<std::string, std::int64_t> in_place_{{"in_place", 1}};
  Builder builder_;
  std::shared_ptr<const Graph> graph_;
};

TEST_F(InPlace, IsGrantedToTheLastReader) {
  builder_.node("x", mix(), {{"color", {"a.color"}}}, in_place_).output("x.color");
  const Plan p = plan();
  EXPECT_EQ(place(p), kColorPort);
  EXPECT_EQ(planned(p, "a").in_place_of[0], kNone) << "a did not ask";
  EXPECT_THAT(planned(p, "x").last_uses, UnorderedElementsAre(builder_.endpoint("a.color"), builder_.endpoint("x.weight")));
  // While a runs: 3 + 4; while x runs: 3, shared, and the weight.
  EXPECT_EQ(p.frame_bytes, 7 * kPlane);
  EXPECT_EQ(p.unshared_bytes, 11 * kPlane);
}

TEST_F(InPlace, SavesABuffer) {
  builder_.node("x", mix(), {{"color", {"a.color"}}, {"more", {"a.weight"}}}, in_place_)
      .node("y", mix(), {{"color", {"x.color"}}, {"more", {"a.weight", "x.weight"}}}, in_place_)
      .output("y.color");
  // a: 3 + 4 = 7. x: 3 (a.color, taken over) + 1 (a.weight) + 1. y: 3 + 1 + 1 + 1.
  EXPECT_EQ(plan().frame_bytes, 7 * kPlane);
}

TEST_F(InPlace, IsGrantedAfterEarlierReaders) {
  builder_.node("early", mix(), {{"color", {"a.color"}}})
      .node("x", mix(), {{"color", {"a.color"}}, {"more", {"early.color"}}}, in_place_)
      .output("x.color");
  EXPECT_EQ(place(plan()), kColorPort);
}

TEST_F(InPlace, IsGrantedOverAGraphInputThatNobodyElseReads) {
  builder_.node("x", mix(), {{"color", {"depth"}}}, in_place_).output("x.color").output("a.color");
  EXPECT_EQ(place(plan()), kColorPort);
}

TEST_F(InPlace, IsRefusedBeforeALaterReader) {
  builder_.node("x", mix(), {{"color", {"a.color"}}}, in_place_)
      .node("later", mix(), {{"color", {"x.color"}}, {"more", {"a.color"}}})
      .output("later.color");
  EXPECT_EQ(place(plan()), kNone);
}

TEST_F(InPlace, IgnoresALaterReaderThatDoesNotRun) {
  builder_.node("x", mix(), {{"color", {"a.color"}}}, in_place_).node("later", mix(), {{"color", {"a.color"}}}).output("x.color");
  EXPECT_EQ(place(plan()), kColorPort);
}

TEST_F(InPlace, IsRefusedOverAnOutput) {
  builder_.node("x", mix(), {{"color", {"a.color"}}}, in_place_).output("x.color").output("a.color");
  EXPECT_EQ(place(plan()), kNone);
}

TEST_F(InPlace, IsRefusedOverADump) {
  builder_.node("x", mix(), {{"color", {"a.color"}}}, in_place_).output("x.color");
  EXPECT_EQ(place(plan({"a.color"})), kNone);
  EXPECT_EQ(place(plan({"a.weight"})), kColorPort);
}

TEST_F(InPlace, IsRefusedOverWhatIsKeptForLaterFrames) {
  builder_.node("before", blend(), {{"color", {"color"}}, {"history", {Wire("a.color", 1)}}})
      .node("x", mix(), {{"color", {"a.color"}}, {"more", {"before.color"}}}, in_place_)
      .output("x.color");
  EXPECT_EQ(place(plan()), kNone);
}

TEST_F(InPlace, IsRefusedOverAnEarlierFrame) {
  builder_.node("x", mix(), {{"color", {Wire("a.color", 1, "=0")}}}, in_place_).output("x.color");
  EXPECT_EQ(place(plan()), kNone);
}

TEST_F(InPlace, IsRefusedOverAGraphInputThatIsKeptOrReadAhead) {
  builder_.node("x", mix(), {{"color", {"depth"}}, {"more", {Wire("depth", -1)}}}, in_place_).output("x.color").output("a.color");
  EXPECT_EQ(place(plan()), kNone);
}

TEST_F(InPlace, IsRefusedOverWhatAnotherInputOfTheNodeReads) {
  builder_.node("x", mix(), {{"color", {"a.color"}}, {"more", {"a.weight", "a.color"}}}, in_place_).output("x.color");
  EXPECT_EQ(place(plan()), kNone);
}

TEST_F(InPlace, IsRefusedOverTheInitialValueOfAnotherInput) {
  builder_.node("x", mix(), {{"color", {"a.color"}}, {"more", {Wire("color", 1, "a.color")}}}, in_place_).output("x.color");
  EXPECT_EQ(place(plan()), kNone);
}

TEST_F(InPlace, IsRefusedOverAnInitialValueOfALaterNode) {
  builder_.node("x", mix(), {{"color", {"a.color"}}}, in_place_)
      .node("later", mix(), {{"color", {"x.color"}}, {"more", {Wire("color", 1, "a.color")}}})
      .output("later.color");
  EXPECT_EQ(place(plan()), kNone);
}

TEST_F(InPlace, HoldsForAllItemsOfAnArrayOrNone) {
  builder_.node("x", channels(), {{"guide", {"color"}}, {"in", {"a.color", "a.weight"}}}, in_place_)
      .node("y", mix(), {{"color", {"x.out[0]"}}, {"more", {"x.out[1]"}}})
      .output("y.color");
  EXPECT_EQ(place(plan()), 1);
}

TEST_F(InPlace, IsRefusedForAnArrayWhenOneItemIsNeededLater) {
  builder_.node("x", channels(), {{"guide", {"color"}}, {"in", {"a.color", "a.weight"}}}, in_place_)
      .node("y", mix(), {{"color", {"x.out[0]"}}, {"more", {"x.out[1]", "a.weight"}}})
      .output("y.color");
  EXPECT_EQ(place(plan()), kNone);
}

TEST_F(InPlace, IsRefusedForAnInputThatIsNotConnected) {
  builder_.node("x", channels(), {{"guide", {"a.color"}}}, in_place_)
      .node("y", mix(), {{"color", {"a.color"}}})
      .output("y.color");
  EXPECT_EQ(running(plan()), (std::vector<std::string>{"a", "y"}));
}

TEST(PlanHistory, IsAsDeepAsTheLargestDelay) {
  Builder builder;
  const auto graph =
      builder.input("color")
          .input("camera", QUELL_TYPE_CAMERA)
          .node("a", mix(), {{"color", {"color"}}, {"camera", {Wire("camera", 2)}}})
          .node("b", mix(), {{"color", {"a.color"}}, {"more", {Wire("a.color", 1), Wire("a.color", 3)}}})
          .node("c", mix(), {{"color", {"b.color"}}, {"more", {Wire("a.color", 2), Wire("color", -2), Wire("color", 1)}}})
          .node("idle", mix(), {{"color", {Wire("b.color", 9)}}})
          .output("c.color")
          .build();
  const Plan plan = make_plan(graph, {{"color", image(64, 32)}, {"camera", camera()}});
  ASSERT_EQ(plan.histories.size(), 3u);
  const auto check = [&](std::size_t i, const std::string& from, int frames, int ahead, std::size_t frame_bytes) {
    EXPECT_EQ(plan.histories[i].from, builder.endpoint(from));
    EXPECT_EQ(plan.histories[i].frames, frames);
    EXPECT_EQ(plan.histories[i].frames_ahead, ahead);
    EXPECT_EQ(plan.histories[i].bytes_per_frame, frame_bytes);
  };
  check(0, "color", 1, 2, 3 * kPlane);
  check(1, "camera", 2, 0, 0);
  check(2, "a.color", 3, 0, 3 * kPlane);
  EXPECT_EQ(plan.history_bytes, (3 + 3) * 3 * kPlane);
}

TEST(PlanHistory, OfAnInputThatIsReadOnlyAheadIsUsed) {
  const auto graph = Builder().input("color").node("a", mix(), {{"color", {Wire("color", -1, "=0")}}}).output("a.color").build();
  const Plan plan = make_plan(graph, kColor64);
  EXPECT_THAT(plan.input_used, ElementsAre(true));
  EXPECT_EQ(plan.histories[0].frames, 0);
  EXPECT_EQ(plan.histories[0].frames_ahead, 1);
}

TEST(PlanHistory, OfAnyDepthIsCountedWithoutOverflow) {
  const auto graph =
      Builder().input("color").node("a", mix(), {{"color", {Wire("color", 2147483647, "=0")}}}).output("a.color").build();
  // 5e10 bytes a frame, 2e9 frames.
  EXPECT_EQ(make_plan(graph, {{"color", image(65536, 65536)}}).history_bytes, SIZE_MAX);
}

}  // namespace
}  // namespace quell::test
