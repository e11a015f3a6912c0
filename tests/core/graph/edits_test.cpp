// Variants from outside: --swap and --bypass.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/core/graph/graph_text.h"
#include "tests/core/graph/test_passes.h"

namespace quell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A filter within a loop of delay 1, and a second output of the same.
constexpr const char* kGraph = R"({ "quell": 1,
  "inputs": { "color": "color", "normal": "normal", "motion": "motion", "camera": "camera", "id": "id" },
  "params": { "size": { "default": 9, "sets": ["filter.radius"] } },
  "nodes": {
    "filter": { "pass": "filter", "version": 4, "in": { "color": "color", "normal": "normal" },
                "params": { "sigma": 3.5, "clamp": true, "label": "x" } },
    "warp": { "pass": "reproject", "in": { "motion": "motion",
              "history": { "from": "blend.color", "delay": 1, "initial": { "from": "filter.color" } } } },
    "blend": { "pass": "blend", "in": { "color": "filter.color", "history": "warp.color", "valid": "warp.valid" } },
    "late": { "pass": "copy", "in": { "image": { "from": "blend.color", "delay": 2, "initial": { "constant": [0] } } } }
  },
  "outputs": { "color": "blend.color", "late": "late.image" } })";

std::shared_ptr<const Graph> change(const std::string& text, const GraphOptions& options) {
  return parse_graph(std::make_shared<SourceText>(SourceText{"graph.json", text}), test::passes(), options);
}

std::string refusal(const std::string& text, const GraphOptions& options) {
  try {
    change(text, options);
  } catch (const Error& error) { return error.what(); }
  return "accepted";
}

std::vector<std::string> outputs(const Graph& graph) {
  std::vector<std::string> all;
  for (const GraphOutput& output : graph.outputs) all.push_back(graph.describe(output.from));
  return all;
}

std::string pass(const Graph& graph, std::string_view node) { return test::node(graph, node).pass->id; }

TEST(Swap, KeepsSourcesAndParametersThatBothPassesHaveAndTellsTheRest) {
  const auto graph = change(kGraph, {.swap = {"filter=smooth"}});
  EXPECT_EQ(pass(*graph, "filter"), "smooth");
  EXPECT_THAT(test::sources(*graph, "filter", "color"), ElementsAre("color"));
  EXPECT_THAT(test::sources(*graph, "filter", "guide"), IsEmpty());
  EXPECT_EQ(test::param(*graph, "filter", "radius"), "9");    // by the graph's parameter
  EXPECT_EQ(test::param(*graph, "filter", "clamp"), "true");  // by the node's
  EXPECT_EQ(test::param(*graph, "filter", "sigma"), "1");     // there it is an integer: its default
  EXPECT_THAT(test::sources(*graph, "blend", "color"), ElementsAre("filter.image"));
  EXPECT_THAT(test::sources(*graph, "warp", "history"), ElementsAre("blend.color@1 filter.image"));
  EXPECT_THAT(
      graph->edits,
      ElementsAre("--swap filter=smooth: the input 'normal' of the file is left out, its output 'image' is read where the "
                  "file says 'color', the parameters 'sigma' and 'label' of the file are left out"));
}

TEST(Swap, LeavesAValueOutThatTheOtherPassCannotTake) {
  std::string text = kGraph;
  text.replace(text.find("\"default\": 9"), 12, "\"default\": 11");
  const auto graph = change(text, {.swap = {"filter=smooth"}});
  EXPECT_EQ(test::param(*graph, "filter", "radius"), "2");
  EXPECT_THAT(graph->edits[0], HasSubstr("'sigma', 'label' and 'radius' of the file are left out"));
}

TEST(Swap, SettingsFromOutsideAreThoseOfTheOtherPass) {
  EXPECT_EQ(test::param(*change(kGraph, {.set = {"filter.sigma=7", "size=4"}, .swap = {"filter=smooth"}}), "filter", "sigma"),
            "7");
  EXPECT_THAT(refusal(kGraph, {.set = {"filter.label=x"}, .swap = {"filter=smooth"}}),
              HasSubstr("--set:1:1: error: the pass 'smooth' has no parameter 'label'"));
  EXPECT_THAT(refusal(kGraph, {.set = {"size=11"}, .swap = {"filter=smooth"}}),
              HasSubstr("--set:1:6: error: 'filter.radius' takes an integer from 0 to 10 (px), got 11"));
}

TEST(Swap, StillTellsWhatIsWrongWithTheParametersOfTheFile) {
  std::string text = kGraph;
  text.replace(text.find("\"sigma\": 3.5"), 12, "\"sigmo\": 3.5, \"gain\": \"much\"");
  const std::string errors = refusal(text, {.swap = {"filter=smooth"}});
  EXPECT_THAT(errors, HasSubstr("the pass 'filter' has no parameter 'sigmo'"));
  EXPECT_THAT(errors, HasSubstr("\nnote: this is the graph as changed by --swap filter=smooth"));
}

TEST(Swap, DoesNotAskForAnOutputThatOnlyAnInputLeftOutReads) {
  const auto graph = change(R"({ "quell": 1, "inputs": { "color": "color" },
    "nodes": { "a": { "pass": "blend", "in": { "color": "color",
                      "history": { "from": "a.color", "delay": 1, "initial": "none" } } },
               "b": { "pass": "copy", "in": { "image": "color" } } },
    "outputs": { "b": "b.image" } })",
                            {.swap = {"a=meter"}});
  EXPECT_EQ(pass(*graph, "a"), "meter");
  EXPECT_THAT(graph->edits, ElementsAre("--swap a=meter: the input 'history' of the file is left out"));
}

TEST(Swap, ReachesIntoOneUseOfASubgraphAlone) {
  std::filesystem::current_path(std::filesystem::path(QUELL_SOURCE_DIR) / "tests/core/graph/good");
  const auto graph = load_graph("subgraphs.json", test::passes(), {.swap = {"second.blur.filter=smooth"}});
  EXPECT_EQ(pass(*graph, "second.blur.filter"), "smooth");
  EXPECT_EQ(pass(*graph, "first.blur.filter"), "filter");
  EXPECT_EQ(pass(*graph, "late.filter"), "filter");
  EXPECT_EQ(test::param(*graph, "second.blur.filter", "radius"), "6");  // from three files above
  EXPECT_THAT(test::sources(*graph, "second.blur.tint", "color"), ElementsAre("second.blur.filter.image"));
  EXPECT_THAT(test::sources(*graph, "first.blur.tint", "color"), ElementsAre("first.blur.filter.color"));
}

TEST(Swap, IsRefusedWhereThePortsDoNotAllowIt) {
  EXPECT_THAT(refusal(kGraph, {.swap = {"late=filter"}}),
              HasSubstr("--swap:1:1: error: the pass 'filter' needs an input 'color' (color or albedo), for which 'late' has no "
                        "source of that name; it has 'image' (color)\n    late=filter\n    ^"));
  EXPECT_THAT(refusal(kGraph, {.swap = {"warp=copy"}}), HasSubstr("the pass 'copy' needs an input 'image' (any image)"));
  EXPECT_THAT(refusal(kGraph, {.swap = {"warp=copy"}}), HasSubstr("it has 'motion' (motion), 'history' (color)"));
  EXPECT_THAT(
      refusal(kGraph, {.swap = {"filter=meter"}}),
      HasSubstr("the pass 'meter' has no output 'color' (color), which the input 'history' of 'warp' reads; it has 'value' "
                "(value)"));
  EXPECT_THAT(refusal(R"({ "quell": 1, "inputs": { "a": "albedo", "n": "normal" },
                           "nodes": { "x": { "pass": "filter", "in": { "color": "a", "normal": "n" } } },
                           "outputs": { "o": "x.color" } })",
                      {.swap = {"x=smooth"}}),
              HasSubstr("the pass 'smooth' takes color as its input 'color'; 'x' has albedo there"));
  EXPECT_THAT(refusal(R"({ "quell": 1, "inputs": { "a": "color" },
                           "nodes": { "x": { "pass": "merge", "in": { "colors": ["a"] } },
                                      "y": { "pass": "copy", "in": { "image": "x.parts[0]" } } },
                           "outputs": { "o": "y.image" } })",
                      {.swap = {"y=merge"}}),
              HasSubstr("the pass 'merge' needs an input 'colors' (color or albedo)"));
}

TEST(Swap, TakesOneSourceForAListButNoListForOneSource) {
  const auto text = [](const std::string& pass, const std::string& sources) {
    return R"({ "quell": 1, "inputs": { "color": "color" },
                "nodes": { "x": { "pass": ")" +
           pass + R"(", "in": { "image": )" + sources + R"( } } },
                "outputs": { "o": "x.image" } })";
  };
  const auto graph = change(text("copy", "\"color\""), {.swap = {"x=copies"}});
  EXPECT_THAT(test::sources(*graph, "x", "image"), ElementsAre("color"));
  EXPECT_THAT(outputs(*graph), ElementsAre("x.image[0]"));
  EXPECT_THAT(outputs(*change(text("copies", "\"color\""), {.swap = {"x=copy"}})), ElementsAre("x.image"));
  EXPECT_THAT(refusal(text("copies", "[\"color\"]"), {.swap = {"x=copy"}}),
              HasSubstr("the pass 'copy' takes one source as its input 'image'; 'x' has a list there"));
}

TEST(Swap, RefusesWhatItDoesNotKnow) {
  EXPECT_THAT(refusal(kGraph, {.swap = {"filtr=smooth"}}),
              HasSubstr("--swap:1:1: error: the graph has no node 'filtr'; did you mean 'filter'?"));
  EXPECT_THAT(refusal(kGraph, {.swap = {"filter=smoth"}}),
              HasSubstr("--swap:1:8: error: unknown pass 'smoth'; did you mean 'smooth'?"));
  EXPECT_THAT(refusal(kGraph, {.swap = {"filter"}}), HasSubstr("--swap:1:1: error: expected a node and the pass"));
  EXPECT_THAT(refusal(kGraph, {.swap = {"filter.x=smooth"}}),
              HasSubstr("the node 'filter' runs a pass, and has no nodes in it; expected 'filter'"));
  EXPECT_THAT(refusal(kGraph, {.swap = {"filter=smooth", "filter=filter"}}), HasSubstr("'filter' is swapped twice"));
  EXPECT_THAT(refusal(kGraph, {.swap = {"filter=smooth"}, .bypass = {"filter"}}), HasSubstr("swapped and bypassed"));
  // Both options and the file are told in one go.
  std::string text = kGraph;
  text.replace(text.find("late.image"), 10, "late.imago");
  const std::string both = refusal(text, {.swap = {"filtr=smooth", "filter=smoth"}});
  for (const char* part : {"'filtr'", "'smoth'", "'imago'"}) EXPECT_THAT(both, HasSubstr(part));
}

TEST(Bypass, ReadsTheInputThatTheOutputIsTheSameAs) {
  const auto graph = change(kGraph, {.bypass = {"blend"}});
  EXPECT_THAT(outputs(*graph), ElementsAre("filter.color", "late.image"));
  EXPECT_THAT(test::sources(*graph, "warp", "history"), ElementsAre("filter.color@1 filter.color"));
  EXPECT_THAT(test::sources(*graph, "late", "image"), ElementsAre("filter.color@2 [0]"));
  EXPECT_THAT(graph->edits, ElementsAre("--bypass blend: 'filter.color' is read instead of 'blend.color'"));
}

TEST(Bypass, GoesOnThroughSeveralNodesInAnyOrder) {
  for (const std::vector<std::string>& order : {std::vector<std::string>{"blend", "filter"}, {"filter", "blend"}}) {
    const auto graph = change(kGraph, {.bypass = order});
    EXPECT_THAT(outputs(*graph), ElementsAre("color", "late.image"));
    EXPECT_THAT(test::sources(*graph, "late", "image"), ElementsAre("color@2 [0]"));
  }
}

// `a` reads the input with a delay, `b` reads `a`, and all of them but `a` are outputs.
std::string delays(const std::string& inner, const std::string& outer) {
  return R"({ "quell": 1, "inputs": { "color": "color" },
  "nodes": {
    "a": { "pass": "copy", "in": { "image": { "from": "color", )" +
         inner + R"( } } },
    "b": { "pass": "copy", "in": { "image": )" +
         outer + R"( } } },
  "outputs": { "b": "b.image" } })";
}

TEST(Bypass, TakesADelayAlongAndAddsDelaysOfOneMeaning) {
  const auto same = change(delays(R"("delay": 1, "initial": { "constant": [3] })", R"("a.image")"), {.bypass = {"a"}});
  EXPECT_THAT(test::sources(*same, "b", "image"), ElementsAre("color@1 [3]"));
  EXPECT_THAT(same->edits, ElementsAre("--bypass a: 'color' (with its delay of 1) is read instead of 'a.image'"));
  const auto sum = change(delays(R"("delay": 1, "initial": { "constant": [3] })",
                                 R"({ "from": "a.image", "delay": 2, "initial": { "constant": [3] } })"),
                          {.bypass = {"a"}});
  EXPECT_THAT(test::sources(*sum, "b", "image"), ElementsAre("color@3 [3]"));
  const auto ahead = change(delays(R"("delay": -1, "initial": { "constant": [3] })", R"("a.image")"), {.bypass = {"a"}});
  EXPECT_THAT(test::sources(*ahead, "b", "image"), ElementsAre("color@-1 [3]"));
}

TEST(Bypass, RefusesDelaysThatDoNotAddUp) {
  for (const char* outer : {R"({ "from": "a.image", "delay": 2, "initial": { "constant": [4] } })",
                            R"({ "from": "a.image", "delay": 2, "initial": { "from": "color" } })",
                            R"({ "from": "a.image", "delay": 9999, "initial": { "constant": [3] } })"})
    EXPECT_THAT(
        refusal(delays(R"("delay": 2, "initial": { "constant": [3] })", outer), {.bypass = {"a"}}),
        HasSubstr("--bypass:1:1: error: 'a.image' cannot be bypassed: its input 'image' has a delay, and so has the input "
                  "'image' of 'b'; delays add up where both"))
        << outer;
  EXPECT_THAT(refusal(delays(R"("delay": -1, "initial": { "constant": [3] })",
                             R"({ "from": "a.image", "delay": 2, "initial": { "constant": [3] } })"),
                      {.bypass = {"a"}}),
              HasSubstr("both have the same sign"));
  EXPECT_THAT(refusal(delays(R"("delay": 1, "initial": { "constant": [3] })",
                             R"({ "from": "color", "delay": 1, "initial": { "from": "a.image" } })"),
                      {.bypass = {"a"}}),
              HasSubstr("an initial value of the input 'image' of 'b' needs a value of the same frame"));
  EXPECT_THAT(
      refusal(kGraph, {.bypass = {"late"}}),
      HasSubstr("'late.image' cannot be bypassed: its input 'image' has a delay, and the output 'late' of the graph needs a "
                "value of the same frame"));
}

TEST(Bypass, AStartWithNothingIsAnErrorWhereThePortNeedsAValue) {
  const std::string text = R"({ "quell": 1, "inputs": { "color": "color", "normal": "normal" },
    "nodes": {
      "a": { "pass": "split", "in": { "items": [{ "from": "color", "delay": 1, "initial": "none" }] } },
      "b": { "pass": "filter", "in": { "color": "a.parts[0]", "normal": "normal" } } },
    "outputs": { "b": "b.color" } })";
  EXPECT_THAT(refusal(text, {.bypass = {"a"}}),
              HasSubstr("--bypass:1:1: error: the input 'color' of the pass 'filter' is not optional, so it cannot start with "
                        "\"none\""));
}

TEST(Bypass, TakesListsOfOneWithAndWithoutAnIndex) {
  const std::string text = R"({ "quell": 1, "inputs": { "color": "color" },
    "nodes": { "m": { "pass": "merge", "in": { "colors": "color" } },
               "x": { "pass": "merge", "in": { "colors": ["m.parts", "m.parts[0]"] } } },
    "outputs": { "x": "x.sum", "y": "m.parts" } })";
  const auto graph = change(text, {.bypass = {"m"}});
  EXPECT_THAT(test::sources(*graph, "x", "colors"), ElementsAre("color", "color"));
  EXPECT_THAT(outputs(*graph), ElementsAre("x.sum", "color"));
}

TEST(Bypass, TakesElementsOfListsForTheirOwn) {
  const std::string text = R"({ "quell": 1, "inputs": { "color": "color", "albedo": "albedo" },
    "nodes": { "m": { "pass": "merge", "in": { "colors": ["albedo", "color"] } },
               "x": { "pass": "merge", "in": { "colors": ["m.parts[1]", "m.parts[0]"] } } },
    "outputs": { "x": "x.sum", "y": "m.parts[0]" } })";
  const auto graph = change(text, {.bypass = {"m"}});
  EXPECT_THAT(test::sources(*graph, "x", "colors"), ElementsAre("color", "albedo"));
  EXPECT_THAT(outputs(*graph), ElementsAre("x.sum", "albedo"));
  // By type: `sum` is a color, and so is one element.
  EXPECT_THAT(outputs(*change(text, {.bypass = {"x"}})), ElementsAre("m.parts[1]", "m.parts[0]"));
}

TEST(Bypass, IsRefusedWithoutAnInputOfTheType) {
  EXPECT_THAT(
      refusal(kGraph, {.bypass = {"warp"}}),
      HasSubstr("'warp.valid' cannot be bypassed: the input 'valid' of 'blend' reads it, and no input of 'warp' is of its "
                "type, mask; there are 'motion' (motion), 'history' (color)"));
  const std::string twice = R"({ "quell": 1, "inputs": { "color": "color" },
    "nodes": { "m": { "pass": "merge", "in": { "colors": ["color", "color"] } } }, "outputs": { "o": "m.sum" } })";
  EXPECT_THAT(refusal(twice, {.bypass = {"m"}}), HasSubstr("several inputs of 'm' are of its type, color: 'colors', 'colors'"));
  const std::string own = R"({ "quell": 1, "inputs": { "color": "color" },
    "nodes": { "c": { "pass": "copy", "in": { "image": { "from": "c.image", "delay": 1, "initial": { "from": "color" } } } } },
    "outputs": { "o": "c.image" } })";
  EXPECT_THAT(refusal(own, {.bypass = {"c"}}), HasSubstr("it is the same as the input 'image', which comes from 'c' itself"));
}

TEST(Bypass, OnlyWhatIsReadNeedsAnInput) {
  const auto graph = change(kGraph, {.bypass = {"filter"}});  // nobody reads its weight
  EXPECT_THAT(test::sources(*graph, "blend", "color"), ElementsAre("color"));
  EXPECT_EQ(test::param(*graph, "filter", "radius"), "9");  // it stays, for --dump, with what is set
}

TEST(Bypass, ReachesIntoSubgraphsAndOverThem) {
  std::filesystem::current_path(std::filesystem::path(QUELL_SOURCE_DIR) / "tests/core/graph/good");
  const auto inner = load_graph("subgraphs.json", test::passes(), {.bypass = {"second.blur.tint"}});
  EXPECT_THAT(test::sources(*inner, "second.filter", "color"), ElementsAre("second.blur.filter.color"));
  EXPECT_THAT(test::sources(*inner, "first.filter", "color"), ElementsAre("first.blur.tint.color"));
  const auto whole = load_graph("subgraphs.json", test::passes(), {.bypass = {"second"}});
  EXPECT_EQ(outputs(*whole)[0], "first.blend.color");
  EXPECT_THAT(refusal(kGraph, {.bypass = {"blender"}}),
              HasSubstr("--bypass:1:1: error: the graph has no node 'blender'; did you mean 'blend'?"));
}

}  // namespace
}  // namespace quell
