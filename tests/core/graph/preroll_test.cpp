// How many frames before a frame its results depend on.
#include "quell/graph/preroll.h"

#include "tests/core/graph/plan_graphs.h"

namespace quell::test {
namespace {

using testing::HasSubstr;

struct FadeParams {
  int percent = 80;
  int settles = 0;
  void describe(auto&& field) {
    field("percent", percent, Range<int>{-1, 200}, "%", "Of the history that is kept.");
    field("settles", settles, Range<int>{-1, 1000}, "frames", "");
  }
};
class Fade : public Idle {
 public:
  explicit Fade(const FadeParams& params) : params_(params) {}
  void infer(Inference& inference) const override { inference.set_fading(params_.percent / 100.0, params_.settles); }

 private:
  FadeParams params_;
};
const quell_pass_desc* fade() {
  return detail::Descriptor::make<Fade, FadeParams>(
             {.id = "fade",
              .inputs = {{.name = "history", .types = kAnyImage, .optional = true}, {"color", kAnyImage}},
              .outputs = {{.name = "color", .same_as = "color"}}})
      .get();
}

const InputShapes kColor64{{"color", image(64, 32)}};

Preroll preroll_of(Builder& builder, double tolerance = 0.01) {
  return find_preroll(make_plan(builder.build(), kColor64), tolerance);
}

// A loop of one node, or of two where the history comes back through another.
Preroll of_loop(int percent, int settles, int delay, double tolerance) {
  Builder builder;
  builder.input("color")
      .node("average", fade(), {{"color", {"color"}}, {"history", {Wire("average.color", delay)}}},
            {{"percent", percent}, {"settles", settles}})
      .output("average.color");
  return preroll_of(builder, tolerance);
}

TEST(Preroll, IsNothingWhereEveryFrameStandsForItself) {
  Builder builder;
  builder.input("color").node("a", mix(), {{"color", {"color"}}}).output("a.color");
  EXPECT_EQ(preroll_of(builder).frames, 0);
}

TEST(Preroll, IsTheLongestWayBackWhereThereIsNoLoop) {
  Builder builder;
  builder.input("color")
      .node("a", mix(), {{"color", {"color"}}, {"more", {Wire("color", 2)}}})
      .node("b", blend(), {{"color", {"a.color"}}, {"history", {Wire("a.color", 3)}}})
      .node("c", blend(), {{"color", {"color"}}, {"history", {Wire("color", 4)}}})
      .node("d", mix(), {{"color", {"b.color"}}, {"more", {"c.color"}}})
      .output("d.color");
  const Preroll preroll = preroll_of(builder, 0);
  EXPECT_EQ(preroll.frames, 5) << preroll.reason;
  EXPECT_THAT(preroll.reason, HasSubstr("'a' looks 2 frames back; 'b' looks 3 frames back"));
}

TEST(Preroll, LeavesNoMoreOfALoopThanTheTolerance) {
  EXPECT_EQ(of_loop(80, 0, 1, 0.01).frames, 21);  // 0.8^20 is 0.0115, 0.8^21 is 0.0092
  EXPECT_EQ(of_loop(50, 0, 1, 0.25).frames, 2);   // exactly
  EXPECT_EQ(of_loop(50, 0, 1, 0.24).frames, 3);
  EXPECT_EQ(of_loop(0, 0, 1, 0.01).frames, 1);
  EXPECT_EQ(of_loop(80, 0, 3, 0.01).frames, 63) << "three frames a turn";
  EXPECT_THAT(of_loop(80, 0, 1, 0.01).reason, HasSubstr("'average' keeps 0.8 of its history, of which 21 frames leave 0.0092"));
}

TEST(Preroll, WaitsForWhatIsCounted) {
  EXPECT_EQ(of_loop(80, 32, 1, 0.01).frames, 32);
  EXPECT_EQ(of_loop(80, 5, 1, 0.01).frames, 21);
  EXPECT_EQ(of_loop(0, 32, 2, 0).frames, 64) << "what does not fade away but ends, ends";
  EXPECT_THAT(of_loop(80, 32, 1, 0.01).reason, HasSubstr("'average' counts up to 32 frames"));
}

TEST(Preroll, IsEndlessWhereALoopNeverForgets) {
  EXPECT_EQ(of_loop(100, 0, 1, 0.01).frames, std::nullopt);
  EXPECT_EQ(of_loop(80, 0, 1, 0).frames, std::nullopt) << "a share of every frame is left";
  EXPECT_THAT(of_loop(100, 0, 1, 0.01).reason, HasSubstr("'average'"));
}

TEST(Preroll, IsEndlessWhereOneWayAroundALoopNeverForgets) {
  Builder builder;
  builder.input("color")
      .node("a", mix(), {{"color", {"color"}}, {"more", {Wire("b.color", 1), Wire("c.color", 1)}}})
      .node("b", fade(), {{"color", {"a.color"}}})
      .node("c", blend(), {{"color", {"a.color"}}})
      .output("c.color");
  const Preroll preroll = preroll_of(builder);
  EXPECT_EQ(preroll.frames, std::nullopt);
  EXPECT_THAT(preroll.reason, HasSubstr("no pass on their way says how fast they fade"));
}

TEST(Preroll, TakesTheLongestWayBetweenTwoThatForget) {
  Builder builder;
  builder.input("color")
      .node("a", mix(), {{"color", {"color"}}, {"more", {Wire("b.color", 1), Wire("b.color", 4)}}})
      .node("b", fade(), {{"color", {"a.color"}}}, {{"percent", 50}})
      .output("b.color");
  EXPECT_EQ(preroll_of(builder, 0.25).frames, 8);
}

TEST(Preroll, AddsUpLoopsBehindEachOther) {
  Builder builder;
  builder.input("color")
      .node("a", fade(), {{"color", {"color"}}, {"history", {Wire("a.color", 1)}}}, {{"percent", 50}})
      .node("b", fade(), {{"color", {"a.color"}}, {"history", {Wire("b.color", 1)}}}, {{"percent", 50}})
      .output("b.color");
  EXPECT_EQ(preroll_of(builder, 0.25).frames, 4);
}

TEST(Preroll, DoesNotHeedWhatNoResultNeeds) {
  Builder builder;
  builder.input("color")
      .node("a", mix(), {{"color", {"color"}}})
      .node("b", blend(), {{"color", {"a.color"}}, {"history", {Wire("b.color", 1)}}})
      .output("a.color");
  EXPECT_EQ(preroll_of(builder).frames, 0);
}

TEST(Fading, IsRefusedWhereItCannotBe) {
  const auto error_with = [](int percent, int settles) {
    Builder builder;
    builder.input("color")
        .node("a", fade(), {{"color", {"color"}}}, {{"percent", percent}, {"settles", settles}})
        .output("a.color");
    return error_of(builder.build(), kColor64, {}, Fault::plugin);
  };
  EXPECT_THAT(error_with(101, 0), HasSubstr("keeps 1.01"));
  EXPECT_THAT(error_with(-1, 0), HasSubstr("0 to 1"));
  EXPECT_THAT(error_with(50, -1), HasSubstr("settles after -1"));
}

}  // namespace
}  // namespace quell::test
