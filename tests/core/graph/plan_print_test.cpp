// The plan as a person reads it.
#include "quell/graph/plan_text.h"
#include "tests/core/graph/plan_graphs.h"

namespace quell::test {
namespace {

using planning::format_bytes;
using planning::format_size;
using planning::Table;
using planning::wrap;
using testing::HasSubstr;

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

TEST(PlanPrint, ShowsOrderReadsWritesMemoryHistoryAndLoops) {
  Builder builder;
  builder.input("color")
      .input("normal", QUELL_TYPE_NORMAL, true)
      .input("depth", QUELL_TYPE_DEPTH)
      .input("camera", QUELL_TYPE_CAMERA)
      .node("filter", mix(), {{"color", {"color"}}, {"more", {"depth", "normal"}}, {"camera", {Wire("camera", 1)}}},
            {{"radius", 16}, {"scratch", 2048}})
      .node("edges", mix(), {{"color", {"normal"}}})
      .node("fetch", mix(), {{"color", {"filter.color"}}, {"more", {Wire("tone.color", 2, "=0.5"), Wire("normal", 1, "color")}}},
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
  EXPECT_EQ(describe(plan), "");
}

}  // namespace
}  // namespace quell::test
