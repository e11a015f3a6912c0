// Sizes and types of what is computed, also through loops, and passes that answer nonsense.
#include "tests/core/graph/plan_graphs.h"

namespace quell::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const InputShapes kColor64{{"color", image(64, 32)}};

TEST(PlanShapes, FollowTheFirstImageAndTheDeclaredTypes) {
  Builder builder;
  const auto graph = builder.input("camera", QUELL_TYPE_CAMERA)
                         .input("depth", QUELL_TYPE_DEPTH)
                         .node("a", mix(), {{"camera", {"camera"}}, {"color", {"depth"}}}, {{"radius", 7}, {"scratch", 99}})
                         .node("m", meter(), {{"color", {"a.weight"}}})
                         .output("a.color")
                         .output("m.value")
                         .build();
  const Plan plan = make_plan(graph, {{"camera", camera()}, {"depth", image(33, 17, QUELL_TYPE_DEPTH)}});
  EXPECT_EQ(plan.shape(builder.endpoint("a.color")).type, QUELL_TYPE_DEPTH);
  EXPECT_EQ(plan.shape(builder.endpoint("a.color")).size, (Size{33, 17}));
  EXPECT_EQ(plan.shape(builder.endpoint("a.weight")).type, QUELL_TYPE_SCALAR);
  EXPECT_EQ(plan.shape(builder.endpoint("m.value")).value_count, 5u);
  EXPECT_EQ(plan.shape(builder.endpoint("m.value")).size, Size{});
  EXPECT_EQ(plan.shape(builder.endpoint("camera")).type, QUELL_TYPE_CAMERA);
  EXPECT_THAT(planned(plan, "a").radius, ElementsAre(0, 7, 0));
  EXPECT_EQ(planned(plan, "a").scratch_bytes, 99u);
}

TEST(PlanShapes, CountItemsOfAnArrayByTheInputItMirrors) {
  Builder builder;
  const auto graph = builder.input("color")
                         .input("depth", QUELL_TYPE_DEPTH)
                         .node("a", channels(), {{"guide", {"color"}}, {"in", {"color", "depth", "color"}}})
                         .node("b", channels(), {{"guide", {"color"}}})
                         .output("a.out[2]")
                         .output("a.out[1]")
                         .build();
  const Plan plan = make_plan(graph, {{"color", image(64, 32)}, {"depth", image(64, 32, QUELL_TYPE_DEPTH)}});
  ASSERT_EQ(planned(plan, "a").outputs[0].size(), 3u);
  EXPECT_EQ(plan.shape(builder.endpoint("a.out[1]")).type, QUELL_TYPE_DEPTH);
  EXPECT_EQ(plan.shape(builder.endpoint("a.out[2]")).type, QUELL_TYPE_COLOR);
}

TEST(PlanShapes, HalveAndDouble) {
  Builder builder;
  const auto graph = builder.input("color")
                         .node("half", resize(), {{"color", {"color"}}})
                         .node("quarter", resize(), {{"color", {"half.color"}}})
                         .node("up", resize(), {{"color", {"quarter.color"}}}, {{"multiply", 4}, {"divide", 1}})
                         .node("end", mix(), {{"color", {"color"}}, {"more", {"up.color"}}})
                         .output("end.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  EXPECT_EQ(plan.shape(builder.endpoint("quarter.color")).size, (Size{16, 8}));
  EXPECT_EQ(plan.shape(builder.endpoint("up.color")).size, (Size{64, 32}));
  EXPECT_EQ(planned(plan, "half").radius[0], QUELL_RADIUS_UNBOUNDED);
}

TEST(PlanShapes, OfANodesImagesAreEqualOrBothEdgesAreNamed) {
  const auto graph = Builder()
                         .input("color")
                         .node("half", resize(), {{"color", {"color"}}})
                         .node("a", mix(), {{"color", {"color"}}, {"more", {"color", "half.color"}}})
                         .node("b", mix(), {{"color", {"half.color"}}, {"more", {"color"}}})
                         .node("end", mix(), {{"color", {"a.color"}}, {"more", {"b.color"}}})
                         .output("end.color")
                         .build();
  const std::string error = error_of(graph, kColor64);
  EXPECT_THAT(error, HasSubstr("error: 'more[1]' of 'a' is 32 x 16 (from 'half.color'), but 'color' is 64 x 32 (from 'color'); a "
                               "node's images have one size\n    a.more <- half.color\n"));
  EXPECT_THAT(error, HasSubstr("'more[0]' of 'b' is 64 x 32 (from 'color'), but 'color' is 32 x 16 (from 'half.color')"));
  EXPECT_THAT(error, Not(HasSubstr("'end'"))) << "it only follows from the others";
}

TEST(PlanShapes, OfAPortOfAnySizeMayBeOthers) {
  Builder builder;
  const auto graph = builder.input("color")
                         .node("half", resize(), {{"color", {"color"}}})
                         .node("up", guided(), {{"guide", {"color"}}, {"color", {"half.color"}}, {"more", {"half.color"}}})
                         .node("bad", guided(), {{"guide", {"half.color"}}, {"color", {"half.color"}}, {"more", {"color"}}})
                         .output("up.color")
                         .output("bad.color")
                         .build();
  EXPECT_THAT(error_of(graph, kColor64), HasSubstr("'more' of 'bad' is 64 x 32 (from 'color'), but 'color' is 32 x 16"))
      << "the others still have one size";
}

TEST(PlanShapes, OfAPortOfAnySizeDoNotTellThatOfTheOutputs) {
  Builder builder;
  const auto graph = builder.input("color")
                         .node("half", resize(), {{"color", {"color"}}})
                         .node("up", guided(), {{"guide", {"color"}}, {"color", {"half.color"}}})
                         .output("up.color")
                         .output("up.weight")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  EXPECT_EQ(plan.shape(builder.endpoint("up.color")).size, (Size{64, 32})) << "as the pass says";
  EXPECT_EQ(plan.shape(builder.endpoint("up.weight")).size, (Size{32, 16})) << "that of its first other image";
}

// A node's history comes first among its inputs, from a node that runs later, at half the size.
TEST(PlanShapes, OfALoopComeFromTheLaterNode) {
  Builder builder;
  const auto graph = builder.input("color")
                         .node("small", resize(), {{"color", {"color"}}})
                         .node("blend", blend(), {{"history", {Wire("end.color", 1)}}, {"color", {"small.color"}}})
                         .node("up", resize(), {{"color", {"blend.color"}}}, {{"multiply", 2}, {"divide", 1}})
                         .node("end", resize(), {{"color", {"up.color"}}})
                         .output("end.color")
                         .build();
  const Plan plan = make_plan(graph, kColor64);
  EXPECT_EQ(plan.shape(builder.endpoint("blend.color")).size, (Size{32, 16}));
  EXPECT_EQ(plan.shape(builder.endpoint("end.color")).size, (Size{32, 16}));
}

TEST(PlanShapes, OfSourcesThatLieBehindASeriesOfLaterNodesAreFound) {
  // Each node reads the next one's result of the frame before, and only the last one reads an image of this frame.
  Builder builder;
  builder.input("color");
  for (int i = 0; i < 9; ++i)
    builder.node("n" + std::to_string(i), mix(), {{"color", {Wire("n" + std::to_string(i + 1) + ".color", 1, "=0")}}});
  const auto graph = builder.node("n9", resize(), {{"color", {"color"}}}).output("n0.color").build();
  const Plan plan = make_plan(graph, kColor64);
  EXPECT_EQ(plan.shape(builder.endpoint("n0.color")).size, (Size{32, 16}));
}

TEST(PlanShapes, OfAnInitialValueAndItsHistoryAgree) {
  const auto graph = Builder()
                         .input("color")
                         .node("half", resize(), {{"color", {"color"}}})
                         .node("blend", blend(), {{"history", {Wire("blend.color", 1, "color")}}, {"color", {"half.color"}}})
                         .output("blend.color")
                         .build();
  EXPECT_THAT(error_of(graph, kColor64),
              HasSubstr("the initial value is 64 x 32 (from 'color'), but what it stands for is 32 x 16 "
                        "(from 'blend.color'); they have one size"));
}

TEST(PlanShapes, ThatDisagreeOnlyAroundALoopAreAnError) {
  const auto graph = Builder()
                         .input("color")
                         .node("blend", blend(), {{"history", {Wire("half.color", 1)}}, {"color", {"color"}}})
                         .node("half", resize(), {{"color", {"blend.color"}}})
                         .output("half.color")
                         .build();
  EXPECT_THAT(error_of(graph, kColor64),
              HasSubstr("error: 'color' of 'blend' is 64 x 32 (from 'color'), but 'history' is 32 x 16 (from 'half.color')"));
}

TEST(PlanShapes, ThatGrowWithEachTurnAreAnError) {
  const auto graph = Builder()
                         .input("color")
                         .node("grow", mix(), {{"color", {Wire("double.color", 1, "=0")}}})
                         .node("double", resize(), {{"color", {"grow.color"}}}, {{"multiply", 2}, {"divide", 1}})
                         .output("grow.color")
                         .build();
  EXPECT_THAT(error_of(graph, kColor64), HasSubstr("graph.json:2:1: error: nothing tells the size of the images of 'grow'"));
}

// One value more than it gets.
quell_status append(const void*, const quell_host*, quell_inference* inference) {
  const quell_port_shape& history = inference->inputs[1];
  inference->outputs[0].items[0].value_count = history.items[0].value_count + 1;
  return QUELL_OK;
}
const quell_pass_desc* appending_meter() {
  static const quell_port_desc ports[] = {
      {sizeof(quell_port_desc), 0, "color", kAnyImage, -1, ""},
      {sizeof(quell_port_desc), QUELL_PORT_OPTIONAL, "history", kValue, -1, ""},
  };
  quell_pass_desc pass = *meter();
  pass.inputs = ports, pass.input_count = 2;
  return with_infer(pass, append);
}

TEST(PlanShapes, ThatNeverSettleAreAnError) {
  const auto graph = Builder()
                         .input("color")
                         .node("a", appending_meter(), {{"color", {"color"}}, {"history", {Wire("a.value", 1)}}})
                         .output("a.value")
                         .build();
  EXPECT_THAT(error_of(graph, kColor64),
              HasSubstr("what 'a' yields never settles: its shape changes with every turn of the loop"));
}

TEST(PlanShapes, ThatAPassRefusesAreToldInItsWords) {
  const auto graph = Builder().input("color").node("half", resize(), {{"color", {"color"}}}).output("half.color").build();
  EXPECT_EQ(error_of(graph, {{"color", image(33, 32)}}),
            "graph.json:2:1: error: 'half': pass 'resize': the width must divide by 2\n    half\n    ^");
}

TEST(PlanShapes, ThatAPassRefusesInALoopAreToldInItsWords) {
  const auto graph =
      Builder().input("color").node("half", resize(), {{"color", {Wire("half.color", 1, "color")}}}).output("half.color").build();
  EXPECT_THAT(error_of(graph, {{"color", image(33, 32)}}), HasSubstr("the width must divide by 2"));
}

using Infer = decltype(quell_pass_desc::infer);
struct Nonsense {
  const char* name;
  Infer infer;
  const char* message;
};
void PrintTo(const Nonsense& nonsense, std::ostream* out) { *out << nonsense.name; }

class PlanOfNonsense : public testing::TestWithParam<Nonsense> {};

TEST_P(PlanOfNonsense, BlamesThePluginAndNamesThePass) {
  const auto graph = Builder()
                         .input("color")
                         .node("a", with_infer(*mix(), GetParam().infer), {{"color", {"color"}}, {"more", {"color", "color"}}})
                         .output("a.color")
                         .build();
  const std::string error = error_of(graph, kColor64, {}, Fault::plugin);
  EXPECT_THAT(error, HasSubstr("graph.json:2:1: error: 'a': pass 'mix': infer breaks the plugin interface: "));
  EXPECT_THAT(error, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Answers, PlanOfNonsense,
    testing::Values(
        Nonsense{"NoSize", [](auto, auto, quell_inference* i) { return i->outputs[0].items[0].width = 0, QUELL_OK; }, "0 x 32"},
        Nonsense{"TooLarge", [](auto, auto, quell_inference* i) { return i->outputs[0].items[0].height = 65537, QUELL_OK; },
                 "64 x 65537"},
        Nonsense{"OtherType",
                 [](auto, auto, quell_inference* i) { return i->outputs[0].items[0].type = QUELL_TYPE_ID, QUELL_OK; }, "type"},
        Nonsense{"Absent", [](auto, auto, quell_inference* i) { return i->outputs[0].items[0].present = 0, QUELL_OK; },
                 "output 'color' changes whether it is there"},
        Nonsense{"Radius", [](auto, auto, quell_inference* i) { return i->radius[1] = -2, QUELL_OK; }, "radius"},
        Nonsense{"NoSuchInput", [](auto, auto, quell_inference* i) { return i->in_place_of[0] = 3, QUELL_OK; }, "does not exist"},
        Nonsense{"InPlaceWithRadius",
                 [](auto, auto, quell_inference* i) { return i->radius[0] = 1, i->in_place_of[0] = 0, QUELL_OK; }, "radius"},
        Nonsense{"InPlaceOfOtherSize", [](auto, auto, quell_inference* i) { return i->in_place_of[1] = 0, QUELL_OK; },
                 "output 'weight' takes the place of input 'color', but they differ in size"},
        Nonsense{"InPlaceOfAnArray", [](auto, auto, quell_inference* i) { return i->in_place_of[0] = 1, QUELL_OK; },
                 "one of them is an array and the other is not"},
        Nonsense{"TwoInOnePlace",
                 [](auto, auto, quell_inference* i) { return i->in_place_of[0] = i->in_place_of[1] = 0, QUELL_OK; },
                 "another output takes the same place"},
        Nonsense{"Scratch", [](auto, auto, quell_inference* i) { return i->scratch_bytes = SIZE_MAX, QUELL_OK; }, "1 TiB"},
        Nonsense{"SlotScratch", [](auto, auto, quell_inference* i) { return i->slot_scratch_bytes = SIZE_MAX, QUELL_OK; },
                 "1 TiB"}),
    [](const auto& nonsense) { return nonsense.param.name; });

}  // namespace
}  // namespace quell::test
