// Drawings of plans: what stands in them, and that Graphviz draws them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "quell/graph/plan_dot.h"
#include "quell/text/json.h"
#include "tests/core/graph/test_passes.h"

namespace quell::test {
namespace {

using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

Plan plan_of(const std::shared_ptr<const Graph>& graph, const std::vector<std::string>& without = {}) {
  InputShapes shapes;
  for (const GraphInput& input : graph->inputs)
    shapes[input.name] = Shape{.type = input.type,
                               .size = is_image(input.type) ? Size{64, 48} : Size{},
                               .value_count = input.type == QUELL_TYPE_VALUE ? 1u : 0u};
  for (const std::string& name : without) shapes[name] = std::nullopt;
  return make_plan(graph, shapes);
}

std::string draw(const std::string& text, const std::vector<std::string>& without = {}) {
  return to_dot(plan_of(parse_graph(std::make_shared<SourceText>(SourceText{"drawn.json", text}), passes()), without));
}

// What Graphviz makes of a drawing, as SVG that an XML parser accepts.
std::string draw_svg(const std::string& dot) {
  const std::string base = (fs::path(testing::TempDir()) / ("quell_drawing_" + std::to_string(getpid()))).string();
  std::ofstream(base + ".dot") << dot;
  const std::string draws = "dot -Tsvg '" + base + ".dot' -o '" + base + ".svg' 2> '" + base + ".txt'";
  EXPECT_EQ(std::system(draws.c_str()), 0) << "the package graphviz is needed\n" << dot;
  EXPECT_EQ(read_text(base + ".txt", Fault::input)->text, "");
  const std::string parses =
      QUELL_PYTHON " -c 'import sys, xml.etree.ElementTree as tree; tree.parse(sys.argv[1])' '" + base + ".svg'";
  EXPECT_EQ(std::system(parses.c_str()), 0);
  std::string svg = read_text(base + ".svg", Fault::input)->text;
  for (const char* ending : {".dot", ".svg", ".txt"}) fs::remove(base + ending);
  return svg;
}

constexpr const char* kAverage = R"({ "quell": 1, "name": "average", "doc": "A mean over time.",
  "inputs": { "color": "color", "mask": { "type": "mask", "optional": true } },
  "nodes": { "mean": { "pass": "blend", "doc": "Slow.", "in": { "color": "color", "valid": "mask",
             "history": { "from": "mean.color", "delay": 1, "initial": "none" } } } },
  "outputs": { "result": "mean.color" } })";

TEST(PlanDot, DrawsNodesPortsEdgesAndALegend) {
  EXPECT_EQ(draw(kAverage), read_text(QUELL_SOURCE_DIR "/tests/core/graph/average.dot", Fault::input)->text);
}

TEST(PlanDot, DashesEdgesWithADelayAndSaysWhatStandsThereAtFirst) {
  const std::string dot = draw(R"({ "quell": 1, "inputs": { "color": "color" }, "nodes": {
    "a": { "pass": "blend", "in": { "color": "color", "history": { "from": "color", "delay": 3, "initial": { "constant": [1, 0.5, 0] } } } },
    "b": { "pass": "blend", "in": { "color": "a.color", "history": { "from": "color", "delay": -1, "initial": { "from": "a.color" } } } } },
    "outputs": { "color": "b.color" } })");
  EXPECT_THAT(dot, HasSubstr(R"("input color" -> "a":i0_0:w [color="#d55e00", edgetooltip="color -> a.color: color")"));
  EXPECT_THAT(dot, HasSubstr(R"(style=dashed, fontcolor="#1a1a1a", label=" 3 frames back \n else 1 0.5 0 ")"));
  EXPECT_THAT(dot, HasSubstr(R"(label=" 1 frame ahead \n else a.color ")"));
}

TEST(PlanDot, DotsWhatResetsHistoryWhichTheTextNamesToo) {
  const std::string text = R"({ "quell": 1, "inputs": { "color": "color" }, "nodes": {
    "average": { "pass": "blend", "in": { "color": "color", "history": { "from": "average.color", "delay": 1, "initial": "none" } } },
    "meter": { "pass": "meter", "in": { "color": "color" } },
    "copy": { "pass": "copy", "in": { "image": "average.color" } } },
    "outputs": { "color": "copy.image" }, "reset": "meter.value" })";
  const std::string dot = draw(text);
  EXPECT_THAT(dot, HasSubstr(R"("meter":o0_0:e -> "average" [color=)"));
  EXPECT_THAT(dot, HasSubstr(R"(style=dotted)"));
  EXPECT_THAT(dot, Not(HasSubstr(R"("meter":o0_0:e -> "copy")")));
  EXPECT_FALSE(draw_svg(dot).empty());
  const Plan plan = plan_of(parse_graph(std::make_shared<SourceText>(SourceText{"reset.json", text}), passes()));
  EXPECT_THAT(describe(plan), HasSubstr("reset where meter.value is not 0, for average\n"));
  EXPECT_EQ(plan.graph->nodes[static_cast<std::size_t>(plan.nodes[0].node)].name, "meter") << "before what reads history";
}

TEST(PlanDot, GraysWhatDoesNotRunAndNamesIt) {
  const std::string text = R"({ "quell": 1, "inputs": { "color": "color", "extra": { "type": "color", "optional": true } },
    "nodes": { "side": { "pass": "copy", "in": { "image": "extra" } },
               "main": { "pass": "blend", "in": { "color": "color", "history": "side.image" } } },
    "outputs": { "color": "main.color" } })";
  EXPECT_THAT(draw(text), Not(HasSubstr("left out")));
  const std::string dot = draw(text, {"extra"});
  EXPECT_THAT(dot, HasSubstr("left out: input extra, side<"));
  EXPECT_THAT(dot, HasSubstr(R"("side":o0_0:e -> "main":i1_0:w [color="#c4c4c4")"));
  EXPECT_THAT(dot, HasSubstr("left out: needs 'extra' as 'image'"));
  EXPECT_THAT(dot, HasSubstr(R"("input color" -> "main":i0_0:w [color="#d55e00")"));
}

TEST(PlanDot, ShowsNamesAndDocsAsTheyAreWhateverTheirCharacters) {
  const std::string odd = R"(a \"quoted\" <b>bold</b> & \\N ä €\n- second line)";
  const std::string dot = draw(R"({ "quell": 1, "name": ")" + odd + R"(", "doc": ")" + odd + R"(", "inputs": { "color":
    { "type": "color", "doc": ")" +
                               odd + R"(" } }, "nodes": { "node": { "pass": "copy", "doc": ")" + odd +
                               R"(", "in": { "image": "color" } }, "graph": { "pass": "copy", "in": { "image": "node.image" } } },
    "outputs": { "subgraph": "graph.image" } })");
  const std::string svg = draw_svg(dot);
  EXPECT_THAT(svg, HasSubstr("bold&lt;/b&gt; &amp; \\N ä €"));
  EXPECT_THAT(svg, HasSubstr("node: copy"));
}

class DrawnGraph : public testing::TestWithParam<const char*> {};

// Arrays, delays of 1, 2 and 3 frames, reading ahead, subgraphs in subgraphs, elements that are not connected.
TEST_P(DrawnGraph, IsAcceptedByGraphviz) {
  const auto graph =
      load_graph(fs::path(QUELL_SOURCE_DIR) / "tests/core/graph/good" / (std::string(GetParam()) + ".json"), passes());
  const std::string svg = draw_svg(to_dot(plan_of(graph)));
  for (const Node& node : graph->nodes) EXPECT_THAT(svg, HasSubstr("<title>" + node.name + "</title>"));
  for (const GraphInput& input : graph->inputs) EXPECT_THAT(svg, HasSubstr("<title>input " + input.name + "</title>"));
  for (const GraphOutput& output : graph->outputs) EXPECT_THAT(svg, HasSubstr("<title>output " + output.name + "</title>"));
}

INSTANTIATE_TEST_SUITE_P(Good, DrawnGraph,
                         testing::Values("absent_elements", "arrays", "games", "parameters", "subgraphs", "versions"),
                         [](const auto& test) { return std::string(test.param); });

TEST(PlanDot, FramesSubgraphsWithinSubgraphs) {
  const auto graph = load_graph(fs::path(QUELL_SOURCE_DIR) / "tests/core/graph/good/subgraphs.json", passes());
  const std::string dot = to_dot(plan_of(graph));
  EXPECT_THAT(dot, HasSubstr("  subgraph \"cluster second.\" {\n"));
  EXPECT_THAT(dot, HasSubstr("    subgraph \"cluster second.blur.\" {\n"));
  EXPECT_EQ(dot, to_dot(plan_of(graph)));
}

}  // namespace
}  // namespace quell::test
