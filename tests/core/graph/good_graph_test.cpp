// The graphs in good/ together use everything that the format has; here stands what must come of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "quell/graph/plan.h"
#include "tests/core/graph/graph_text.h"
#include "tests/core/graph/test_passes.h"

namespace quell {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Loads good/NAME.json from within its folder, so that paths in the graph are short.
class GoodGraph : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::current_path(std::filesystem::path(QUELL_SOURCE_DIR) / "tests/core/graph/good"); }
  void load(const std::string& name, const GraphOptions& options = {}) {
    graph = load_graph(name + ".json", test::passes(), options);
  }
  std::string param(std::string_view node, std::string_view name) const { return test::param(*graph, node, name); }
  std::vector<std::string> sources(std::string_view node, std::string_view input) const {
    return test::sources(*graph, node, input);
  }
  std::string type(std::string_view endpoint) const { return std::string(name(graph->type(graph->find(endpoint)))); }
  std::shared_ptr<const Graph> graph;
};

TEST_F(GoodGraph, KeepsNameDocAndInputs) {
  load("games");
  EXPECT_EQ(graph->name, "games202");
  EXPECT_EQ(graph->doc, "Joint bilateral filter, back projection, clamped accumulation.");
  EXPECT_EQ(graph->file, "games.json");
  ASSERT_EQ(graph->inputs.size(), 5u);
  EXPECT_EQ(graph->inputs[2].name, "position");
  EXPECT_EQ(graph->inputs[2].type, QUELL_TYPE_POSITION);
  EXPECT_FALSE(graph->inputs[2].optional);
  EXPECT_EQ(graph->inputs[2].where.line(), 7);
}

TEST_F(GoodGraph, WithoutANameHasThatOfItsFile) {
  load("arrays");
  EXPECT_EQ(graph->name, "arrays");
  EXPECT_EQ(graph->inputs[0].doc, "Radiance over albedo.");
  EXPECT_TRUE(graph->inputs[1].optional);
}

TEST_F(GoodGraph, HasItsNodesInTopologicalOrderAndElseInThatOfTheFile) {
  load("games");
  EXPECT_THAT(test::names(*graph), ElementsAre("filter", "motion", "reproject", "blend"));
  EXPECT_EQ(graph->nodes[0].where.line(), 15);
}

TEST_F(GoodGraph, ConnectsPlainAndDelayedEdges) {
  load("games");
  EXPECT_THAT(sources("filter", "color"), ElementsAre("color"));
  EXPECT_THAT(sources("filter", "id"), IsEmpty());
  EXPECT_THAT(sources("blend", "valid"), ElementsAre("reproject.valid"));
  EXPECT_THAT(sources("reproject", "history"), ElementsAre("blend.color@1 filter.color"));
  EXPECT_THAT(sources("motion", "previous_camera"), ElementsAre("camera@1 none"));
}

TEST_F(GoodGraph, HasOutputsOfNodesAndOfInputs) {
  load("games");
  ASSERT_EQ(graph->outputs.size(), 3u);
  EXPECT_EQ(graph->outputs[1].name, "weight");
  EXPECT_EQ(graph->describe(graph->outputs[1].from), "filter.weight");
  EXPECT_EQ(graph->describe(graph->outputs[2].from), "color");
}

TEST_F(GoodGraph, SetsParametersOfEveryType) {
  load("games");
  EXPECT_EQ(param("filter", "radius"), "16");  // written as 16.0
  EXPECT_EQ(param("filter", "sigma"), "2");    // written as an integer
  EXPECT_EQ(param("filter", "mode"), "\"bicubic\"");
  EXPECT_EQ(param("filter", "clamp"), "false");
  load("parameters");
  EXPECT_EQ(param("one", "seed"), "-9007199254740993");  // 2^53 + 1 is no double
  EXPECT_EQ(param("one", "kernel"), "[0.25, 0.5, 0.25]");
  EXPECT_EQ(param("one", "names"), "[\"a\", \"b\"]");
  EXPECT_EQ(param("one", "label"), "\"12\"");
  EXPECT_EQ(param("two", "label"), "\"größer\"");
  EXPECT_EQ(param("two", "matrix"), "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]");
}

TEST_F(GoodGraph, TakesRelativePathsFromTheFolderOfItsFile) {
  std::filesystem::current_path("..");
  graph = load_graph("good/parameters.json", test::passes());
  EXPECT_EQ(param("one", "lut"), "\"good/luts/film.spi1d\"");
  EXPECT_EQ(param("two", "lut"), "\"/opt/film.spi1d\"");
  EXPECT_EQ(param("three", "lut"), "\"\"");
  graph = load_graph("good/subgraphs.json", test::passes());
  EXPECT_EQ(param("first.filter", "lut"), "\"good/parts/film.lut\"");
}

TEST_F(GoodGraph, SetsSeveralNodesByOneParameterOfItsOwn) {
  load("parameters");
  EXPECT_EQ(param("one", "radius"), "4");
  EXPECT_EQ(param("two", "radius"), "4");
  EXPECT_EQ(param("three", "radius"), "8");
  EXPECT_EQ(param("one", "sigma"), "7");  // 'softness' has no default of its own
}

TEST_F(GoodGraph, KeepsTheMeaningOfEarlierVersionsOfAPass) {
  load("versions");
  EXPECT_EQ(param("v2", "sigma"), "0.5");
  EXPECT_EQ(param("v2", "mode"), "\"bilinear\"");
  EXPECT_EQ(param("v2_set", "sigma"), "3");  // was called 'strength'
  EXPECT_EQ(param("v2_set", "mode"), "\"bicubic\"");
  EXPECT_EQ(param("v3", "sigma"), "0.5");
  EXPECT_EQ(param("v3", "mode"), "\"nearest\"");
  EXPECT_EQ(param("v4", "sigma"), "0.8");
  EXPECT_EQ(param("now", "sigma"), "0.8");
}

TEST_F(GoodGraph, ConnectsPortArrays) {
  load("arrays");
  EXPECT_THAT(sources("merge", "colors"), ElementsAre("diffuse", "albedo@2 [1, 0.5, 0]", "diffuse"));
  EXPECT_THAT(sources("merge", "extra"), ElementsAre("merge_before.sum", "merge.parts[1]@1 none"));
  EXPECT_THAT(sources("second", "image"), ElementsAre("merge.parts[1]"));
  EXPECT_EQ(type("merge.parts[0]"), "color");
  EXPECT_EQ(type("merge.parts[1]"), "albedo");
  EXPECT_EQ(type("second.image"), "albedo");
}

TEST_F(GoodGraph, TakesOneSourceForAListAndAListOfOneWithoutAnIndex) {
  load("lists_of_one");
  EXPECT_THAT(sources("merge", "colors"), ElementsAre("color"));
  EXPECT_THAT(sources("merge", "extra"), ElementsAre("merge.parts[0]@1 none"));
  EXPECT_THAT(sources("indexed", "image"), ElementsAre("merge.parts[0]"));
  EXPECT_THAT(sources("plain", "image"), ElementsAre("merge.parts[0]"));
  EXPECT_THAT(sources("late", "items"), ElementsAre("plain.image@2 merge.parts[0]"));
  EXPECT_THAT(sources("absent", "items"), ElementsAre("albedo"));
  EXPECT_EQ(type("plain.image"), "color");
  EXPECT_EQ(graph->describe(graph->outputs[0].from), "late.parts[0]");
  EXPECT_EQ(graph->find("merge.parts"), graph->find("merge.parts[0]"));
}

// Elements of the output that mirrors the list keep their places, too.
TEST_F(GoodGraph, LeavesOutTheElementsOfAListThatAreNotConnectedAndNoOthers) {
  load("absent_elements");
  EXPECT_THAT(sources("inner.split", "items"), ElementsAre("nothing@1 none", "nothing@1 none", "color"));
  EXPECT_EQ(type("inner.split.parts[0]"), "albedo");
  EXPECT_EQ(type("inner.split.parts[2]"), "color");
  const Plan plan = make_plan(graph, {{"color", Shape{.type = QUELL_TYPE_COLOR, .size = {8, 8}}}});
  EXPECT_FALSE(plan.shape(graph->find("inner.split.parts[0]")).present);
  EXPECT_FALSE(plan.shape(graph->find("inner.split.parts[1]")).present);
  EXPECT_TRUE(plan.shape(graph->find("inner.split.parts[2]")).present);
  EXPECT_THAT(describe(plan), testing::HasSubstr("items[0]  <-  nothing"));
}

TEST_F(GoodGraph, TellsThatAnElementWhichIsNotConnectedCannotBeDumped) {
  load("absent_elements");
  try {
    make_plan(graph, {{"color", Shape{.type = QUELL_TYPE_COLOR, .size = {8, 8}}}}, {"inner.split.parts[1]"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "error: 'inner.split.parts[1]' cannot be dumped: 'inner.split' needs 'nothing' as 'items[1]', and that optional "
                 "input of a subgraph is not connected");
  }
}

TEST_F(GoodGraph, LooksAheadOnItsInputs) {
  load("arrays");
  EXPECT_THAT(sources("ahead", "history"), ElementsAre("diffuse@-3 none"));
}

TEST_F(GoodGraph, FollowsTypesThroughLoops) {
  load("types_in_loops");
  EXPECT_EQ(type("mix.color"), "normal");
  EXPECT_EQ(type("warp.color"), "normal");
  EXPECT_EQ(type("a.image"), "normal");  // the loop of a and b comes from nothing but an initial value
  EXPECT_EQ(type("b.image"), "normal");
  EXPECT_EQ(type("c.image"), "color");  // the first that copy accepts
  EXPECT_EQ(type("meter.value"), "value");
}

TEST_F(GoodGraph, UnfoldsSubgraphs) {
  load("subgraphs");
  // 'second' stands first in the file, and a delayed edge lets it run before 'first'.
  EXPECT_THAT(test::names(*graph), ElementsAre("second.guide", "second.blur.filter", "second.blur.tint", "second.filter",
                                               "second.warp", "second.blend", "first.blur.filter", "first.blur.tint",
                                               "first.filter", "first.blend", "late.filter", "late.tint"));
  EXPECT_THAT(sources("second.filter", "color"), ElementsAre("second.blur.tint.color"));
  EXPECT_THAT(sources("second.blur.tint", "history"), ElementsAre("second.guide.image"));
  EXPECT_THAT(sources("second.guide", "image"), ElementsAre("albedo"));
  EXPECT_THAT(sources("second.blur.filter", "color"), ElementsAre("first.blend.color@1 [0]"));
  EXPECT_THAT(sources("first.blur.filter", "color"), ElementsAre("color@1 [0]"));
}

TEST_F(GoodGraph, AddsDelaysAcrossTheBorderOfASubgraph) {
  load("subgraphs");
  EXPECT_THAT(sources("late.filter", "color"), ElementsAre("color@3 [0]"));
}

TEST_F(GoodGraph, LeavesOutWhatOnlyServesAnUnconnectedOptionalInput) {
  load("subgraphs");
  EXPECT_THAT(sources("first.blur.tint", "history"), IsEmpty());
  EXPECT_THAT(sources("first.blend", "history"), IsEmpty());  // warp needs motion
  EXPECT_THAT(sources("second.blend", "history"), ElementsAre("second.warp.color"));
}

TEST_F(GoodGraph, PassesParametersDownThroughSubgraphs) {
  load("subgraphs");
  EXPECT_EQ(param("first.filter", "radius"), "9");
  EXPECT_EQ(param("first.blur.filter", "radius"), "9");
  EXPECT_EQ(param("second.blur.filter", "radius"), "6");
  EXPECT_EQ(param("late.filter", "radius"), "2");
}

TEST_F(GoodGraph, FindsEndpointsByName) {
  load("subgraphs");
  for (const std::string name : {"color", "first.blur.tint.color", "second.warp.valid"})
    EXPECT_EQ(graph->describe(graph->find(name)), name);
  EXPECT_EQ(graph->describe(graph->find("second.color")), "second.blend.color");
  EXPECT_EQ(graph->describe(graph->find("first.before")), "first.blur.tint.color");
  EXPECT_EQ(graph->describe(graph->find("first.through")), "color");
  load("arrays");
  EXPECT_EQ(graph->find("merge.parts[2]"), (Endpoint{graph->find("merge.sum").node, 0, 2}));
}

TEST_F(GoodGraph, SaysWhatIsNearANameThatItDoesNotFind) {
  load("arrays");
  try {
    graph->find("merge.sun");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "'merge.sun': the graph 'arrays' has nothing of that name; did you mean 'merge.sum'?");
  }
  EXPECT_THROW(graph->find("merge.parts[3]"), Error);
  EXPECT_THROW(graph->find("merge.parts"), Error);
  EXPECT_THROW(graph->find(""), Error);
}

TEST_F(GoodGraph, IsTheSameFromAText) {
  const auto source = std::make_shared<SourceText>(SourceText{"there/memory.json", R"({ "quell": 1,
      "inputs": { "color": "color", "normal": "normal" },
      "nodes": { "filter": { "pass": "filter", "in": { "color": "color", "normal": "normal" }, "params": { "lut": "a" } } },
      "outputs": { "color": "filter.color" } })"});
  graph = parse_graph(source, test::passes());
  EXPECT_EQ(graph->name, "memory");
  EXPECT_EQ(param("filter", "lut"), "\"there/a\"");
}

}  // namespace
}  // namespace quell
