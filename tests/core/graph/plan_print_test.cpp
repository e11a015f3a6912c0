// The plan as a person reads it.
#include "quell/graph/plan_text.h"
#include "tests/core/graph/plan_graphs.h"

namespace quell::test {
namespace {

using planning::format_bytes;
using planning::format_size;
using planning::Table;
using planning::wrap;

TEST(PlanText, NamesSizesInUnitsThatPeopleRead) {
  EXPECT_EQ(format_bytes(0), "0 B");
  EXPECT_EQ(format_bytes(1023), "1023 B");
  EXPECT_EQ(format_bytes(1536), "1.5 KiB");
  EXPECT_EQ(format_bytes(std::size_t{10} << 20), "10.0 MiB");
  EXPECT_EQ(format_bytes(std::size_t{5} << 29), "2.50 GiB");
  EXPECT_EQ(format_size({.type = QUELL_TYPE_VALUE, .value_count = 1}), "1 value");
  EXPECT_EQ(format_size(camera()), "");
}

TEST(PlanText, AlignsColumnsAndEndsLinesWithoutBlanks) {
  Table table(2);
  table.add_row({"a", "long", ""});
  table.add_heading("this is longer than all");
  table.add_row({"abc", "", "x"});
  EXPECT_EQ(table.render(), "  a    long\nthis is longer than all\n  abc        x\n");
}

TEST(PlanText, BreaksLinesBetweenWords) {
  EXPECT_EQ(wrap("a  b\nc", 2), "  a b c\n");
  const std::string word(60, 'x');
  EXPECT_EQ(wrap(word + " " + word, 1), " " + word + "\n " + word + "\n");
  EXPECT_EQ(wrap("", 2), "");
}

// 1280 x 720 floats in rows of 1296 are 3.56 MiB.
constexpr const char* kAllKinds = R"(all_kinds  (graphs/all_kinds.json)
A bit of everything.

inputs
  color   color   1280 x 720   10.7 MiB
  normal  normal  absent
  depth   depth   1280 x 720    3.6 MiB
  camera  camera

nodes, in the order in which they run
  1  filter: mix     28.5 MiB alive, 2.0 KiB scratch
      color    <-  color            1280 x 720
      more[0]  <-  depth            1280 x 720  16 px around
      more[1]  <-  normal           absent
      camera   <-  camera                       1 frame back, else none
      color    ->  color            1280 x 720   10.7 MiB
      weight   ->  scalar           1280 x 720    3.6 MiB
  2  fetch: mix      39.2 MiB alive
      color    <-  filter.color     1280 x 720
      more[0]  <-  blend.color      1280 x 720  pixels anywhere, 2 frames back, else 0.5
      more[1]  <-  normal           absent      always color
      camera   <-  (not connected)
      color    ->  color            1280 x 720   10.7 MiB
      weight   ->  scalar           1280 x 720    3.6 MiB
  3  blend: blend    35.6 MiB alive
      history  <-  blend.color      1280 x 720  1 frame back, else none
      color    <-  fetch.color      1280 x 720
      color    ->  color            1280 x 720   10.7 MiB
  4  tone: mix       49.8 MiB alive
      color    <-  blend.color      1280 x 720
      more     <-  (not connected)
      camera   <-  (not connected)
      color    ->  color            1280 x 720   10.7 MiB
      weight   ->  scalar           1280 x 720    3.6 MiB
  5  preview: mix    49.8 MiB alive
      color    <-  tone.color       1280 x 720
      more[0]  <-  color            1280 x 720  1 frame ahead, else none
      camera   <-  (not connected)
      color    ->  color            1280 x 720  in place of color
      weight   ->  scalar           1280 x 720    3.6 MiB
  6  small: resize   49.0 MiB alive
      color    <-  preview.color    1280 x 720  pixels anywhere
      color    ->  color            640 x 360     2.7 MiB

outputs
  out            <-  small.color    color   640 x 360
  out            <-  fetch.color    color   1280 x 720
  filter.weight  <-  filter.weight  scalar  1280 x 720  dumped

left out
  edges: needs 'normal' as 'color', and the source does not have 'normal'
  idle: nothing that runs needs it

history
  color        1 frame ahead   10.7 MiB
  camera       1 frame back
  blend.color  2 frames back   21.4 MiB

loops
  fetch, blend: 1 frame around, so that at most 1 frame can be inside at a time

memory
  one frame   49.8 MiB  while 'tone' runs; 84.6 MiB if no buffer were used twice
  history     32.0 MiB
)";

TEST(PlanPrint, ShowsOrderReadsWritesMemoryHistoryAndLoops) {
  Builder builder;
  builder.input("color")
      .input("normal", QUELL_TYPE_NORMAL, true)
      .input("depth", QUELL_TYPE_DEPTH)
      .input("camera", QUELL_TYPE_CAMERA)
      .node("filter", mix(), {{"color", {"color"}}, {"more", {"depth", "normal"}}, {"camera", {Wire("camera", 1)}}},
            {{"radius", 16}, {"scratch", 2048}})
      .node("edges", mix(), {{"color", {"normal"}}})
      .node("fetch", mix(), {{"color", {"filter.color"}}, {"more", {Wire("blend.color", 2, "=0.5"), Wire("normal", 1, "color")}}},
            {{"radius", -1}})
      .node("blend", blend(), {{"color", {"fetch.color"}}, {"history", {Wire("blend.color", 1)}}})
      .node("tone", mix(), {{"color", {"blend.color"}}}, {{"in_place", 1}})
      .node("preview", mix(), {{"color", {"tone.color"}}, {"more", {Wire("color", -1)}}}, {{"in_place", 1}})
      .node("small", resize(), {{"color", {"preview.color"}}}, {{"divide", 2}})
      .node("idle", mix(), {{"color", {"color"}}})
      .output("small.color")
      .output("fetch.color");
  const std::shared_ptr<Graph> graph = builder.build();
  graph->name = "all_kinds";
  graph->file = "graphs/all_kinds.json";
  graph->doc = "A bit of everything.";
  const Plan plan =
      make_plan(graph, {{"color", image(1280, 720)}, {"depth", image(1280, 720, QUELL_TYPE_DEPTH)}, {"camera", camera()}},
                {"filter.weight"});
  EXPECT_EQ(describe(plan), kAllKinds);
}

TEST(PlanPrint, SaysNothingOfWhatThereIsNot) {
  const auto graph = Builder().input("color").output("color").build();
  EXPECT_EQ(describe(make_plan(graph, {{"color", image(8, 8)}})),
            "\ninputs\n  color  color  8 x 8    3.0 KiB\n"
            "\noutputs\n  out  <-  color  color  8 x 8\n"
            "\nmemory\n  one frame    3.0 KiB  3.0 KiB if no buffer were used twice\n  history          0 B\n");
}

}  // namespace
}  // namespace quell::test
