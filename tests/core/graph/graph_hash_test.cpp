// What changes a graph's hash, and what does not.
#include "quell/graph/graph_hash.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "tests/core/graph/test_passes.h"

namespace quell {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

// Every kind of thing that a graph has, except arrays.
const std::string kGraph = R"({
  "quell": 1,
  "name": "small",
  "inputs": { "color": "color", "normal": "normal", "motion": { "type": "motion", "optional": true } },
  "nodes": {
    "first": { "pass": "filter", "in": { "color": "color", "normal": "normal" }, "params": { "radius": 5 } },
    "moved": { "pass": "reproject", "in": {
                 "history": { "from": "mix.color", "delay": 1, "initial": { "from": "first.color" } }, "motion": "motion" } },
    "mix": { "pass": "blend", "in": { "color": "first.color",
               "history": { "from": "color", "delay": 2, "initial": { "constant": [0.1] } } } }
  },
  "outputs": { "color": "mix.color", "before": "first.color" }
})";

std::shared_ptr<const Graph> parse(const std::string& text, const GraphOptions& options = {},
                                   const std::string& file = "graph.json") {
  return parse_graph(std::make_shared<SourceText>(SourceText{file, text}), test::passes(), options);
}
std::string hash(const std::string& text, const GraphOptions& options = {}) { return graph_hash(*parse(text, options)); }

/// kGraph with one text in place of another.
std::string with(const std::string& from, const std::string& to, std::string text = kGraph) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the test's graph has no " + from);
  return text.replace(at, from.size(), to);
}

TEST(GraphHash, DependsOnWhatResetsHistory) {
  const std::string with_cuts =
      with("\"motion\": { \"type\"", "\"cut\": \"value\", \"flash\": \"value\", \"motion\": { \"type\"");
  const std::string reset = with("\"before\": \"first.color\" }", "\"before\": \"first.color\" }, \"reset\": \"cut\"", with_cuts);
  EXPECT_NE(hash(reset), hash(with_cuts));
  EXPECT_NE(hash(reset), hash(with("\"reset\": \"cut\"", "\"reset\": \"flash\"", reset)));
  const std::string text = canonical_text(*parse(reset));
  EXPECT_THAT(text, HasSubstr("reset [\"cut\"]"));
  const auto graph = parse(reset);
  EXPECT_THAT(canonical_text(*graph, {{"color", graph->find("mix.color")}}), HasSubstr("input \"cut\" value"));
  EXPECT_THAT(canonical_text(*graph, {{"color", graph->find("first.color")}}), Not(HasSubstr("cut"))) << "it reads no history";
}

TEST(GraphHash, IsThatOfTheCanonicalTextOnEveryMachine) {
  EXPECT_EQ(canonical_text(*parse(kGraph)), R"(quell graph 1
input "color" color
input "motion" motion optional
input "normal" normal
node "first" "filter" version 4
  param "clamp" true
  param "gain" 1
  param "kernel" [1]
  param "label" ""
  param "lut" [path ""]
  param "matrix" [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
  param "mode" "nearest"
  param "names" []
  param "radius" 5
  param "seed" 0
  param "sigma" 0.8
  in "color" ["color"]
  in "normal" ["normal"]
node "mix" "blend" version 1
  param "alpha" 0.2
  param "gain" 1
  in "color" ["first.color"]
  in "history" ["color" delay 2 initial [0.1]]
node "moved" "reproject" version 1
  in "history" ["mix.color" delay 1 initial "first.color"]
  in "motion" ["motion"]
output "before" "first.color"
output "color" "mix.color"
)");
  EXPECT_EQ(hash(kGraph), "961334464595526a08c5a07276eba7a6") << "what `xxhsum -H2` says of the text above";
}

TEST(GraphHash, DoesNotDependOnHowTheGraphIsWritten) {
  const std::string same = R"({ // another order, other documentation, another layout
    "quell": 1, "name": "other", "doc": "Something else.",
    "outputs": { "before": "first.color", "color": "mix.color", },
    "nodes": {
      "mix": { "doc": "mixes", "in": { "history": { "initial": { "constant": [1e-1] }, "delay": 2, "from": "color" }, "color": "first.color" },
               "pass": "blend", "version": 1 },
      "moved": { "pass": "reproject", "in": { "motion": "motion",
                 "history": { "from": "mix.color", "delay": 1, "initial": { "from": "first.color" } } } },
      "first": { "pass": "filter", "params": { "sigma": 0.80, "mode": "nearest", "radius": 5 },
                 "in": { "normal": "normal", "color": "color" } } },
    "inputs": { "motion": { "optional": true, "type": "motion", "doc": "x" }, "normal": { "type": "normal" }, "color": "color" } })";
  EXPECT_EQ(hash(same), hash(kGraph));
  EXPECT_EQ(graph_hash(*parse(kGraph, {}, "/elsewhere/b.json")), hash(kGraph));
}

TEST(GraphHash, DoesNotDependOnWhereAParameterWasSet) {
  const std::string seven = hash(with("5", "7"));
  EXPECT_EQ(hash(kGraph, {.set = {"first.radius=7"}, .params = {}}), seven);
  const std::string named = with(R"("nodes")", R"("params": { "size": { "default": 7, "sets": ["first.radius"] } }, "nodes")",
                                 with(R"(, "params": { "radius": 5 })", ""));
  EXPECT_EQ(hash(named), seven);
  EXPECT_EQ(hash(named, {.set = {"size=5"}, .params = {}}), hash(kGraph));
  EXPECT_EQ(hash(kGraph, {.set = {"mix.alpha=0.2"}, .params = {}}), hash(kGraph)) << "the default, spelled out";
}

TEST(GraphHash, ChangesWithWhateverChangesAResult) {
  const std::vector<std::string> changed = {
      kGraph,
      with(R"("radius": 5)", R"("radius": 6)"),
      with(R"("radius": 5)", R"("radius": 5, "sigma": 0.8000000000000002)"),
      with(R"("radius": 5)", R"("radius": 5, "mode": "bilinear")"),
      with(R"("radius": 5)", R"("radius": 5, "clamp": false)"),
      with(R"("radius": 5)", R"("radius": 5, "label": "0")"),
      with(R"("radius": 5)", R"("radius": 5, "kernel": [1, 0])"),
      with(R"("radius": 5)", R"("radius": 5, "names": [""])"),
      with(R"("radius": 5)", R"("radius": 5, "names": ["", ""])"),
      with(R"("radius": 5)", R"("radius": 5, "seed": -9007199254740993)"),
      with(R"("radius": 5)", R"("radius": 5, "seed": -9007199254740992)"),
      with(R"("normal": "normal" }, "params")",
           R"("normal": { "from": "normal", "delay": -1, "initial": { "constant": [0] } } }, "params")"),
      with(R"("delay": 1)", R"("delay": 2)"),
      with(R"("delay": 2)", R"("delay": 1)"),
      with(R"({ "constant": [0.1] })", R"("none")"),
      with("[0.1]", "[0.2]"),
      with("[0.1]", "[0.1, 0.1, 0.2]"),
      with(R"("initial": { "from": "first.color" })", R"("initial": { "from": "color" })"),
      with(R"("in": { "color": "first.color")", R"("in": { "color": "color")"),
      with(R"("before": "first.color")", R"("before": "moved.color")"),
      with(R"("before": "first.color")", R"("after": "first.color")"),
      with(R"(, "before": "first.color")", ""),
      with(R"("color": "color", "normal")", R"("color": "albedo", "normal")"),
      with(R"({ "type": "motion", "optional": true })", R"("motion")"),
      with(R"("inputs": {)", R"("inputs": { "more": "color",)"),
      with(R"("nodes": {)", R"("nodes": { "more": { "pass": "copy", "in": { "image": "color" } },)"),
      with(R"("pass": "blend")", R"("pass": "reproject")", with(R"("color": "first.color",)", R"("motion": "motion",)"))};
  std::set<std::string> texts, hashes;
  for (const std::string& text : changed) {
    const auto graph = parse(text);
    EXPECT_TRUE(texts.insert(canonical_text(*graph)).second) << text;
    const std::string number = graph_hash(*graph);
    EXPECT_THAT(number, MatchesRegex("[0-9a-f]{32}"));
    EXPECT_TRUE(hashes.insert(number).second) << text;
  }
}

// An output's hash must not move with what another one needs, nor stay with what it needs itself.
TEST(GraphHash, OfAResultIsThatOfWhatFeedsIt) {
  const auto of = [](const std::string& text, const std::string& result) {
    const auto graph = parse(text);
    return graph_hash(*graph, {{result, graph->find(result)}});
  };
  const std::string mix = of(kGraph, "mix.color"), moved = of(kGraph, "moved.color"), first = of(kGraph, "first.color");
  struct Case {
    std::string text;
    bool mix, moved, first;  // whether it differs
  };
  const std::vector<Case> cases = {
      {with(R"("radius": 5)", R"("radius": 6)"), true, true, true},
      {with("[0.1]", "[0.2]"), true, true, false},
      {with(R"("delay": 1)", R"("delay": 2)"), false, true, false},
      {with(R"("initial": { "from": "first.color" })", R"("initial": { "from": "color" })"), false, true, false},
      {with(R"({ "type": "motion", "optional": true })", R"("motion")"), false, true, false},
      {with(R"(, "before": "first.color")", ""), false, false, false},
      {with(R"("inputs": {)", R"("inputs": { "more": "color",)"), false, false, false},
      {with(R"("nodes": {)", R"("nodes": { "more": { "pass": "copy", "in": { "image": "first.color" } },)"), false, false, false},
  };
  for (const Case& now : cases) {
    EXPECT_EQ(of(now.text, "mix.color") != mix, now.mix) << now.text;
    EXPECT_EQ(of(now.text, "moved.color") != moved, now.moved) << now.text;
    EXPECT_EQ(of(now.text, "first.color") != first, now.first) << now.text;
  }
  const auto graph = parse(kGraph);
  EXPECT_EQ(canonical_text(*graph, {{"moved.color", graph->find("moved.color")}}),
            with("output \"before\" \"first.color\"\noutput \"color\" \"mix.color\"\n",
                 "output \"moved.color\" \"moved.color\"\n", canonical_text(*graph)))
      << "it needs everything";
}

TEST(GraphHash, ChangesWithANodesNameBecauseDumpsGoByIt) {
  std::string swapped = kGraph;
  for (std::size_t at = 0; (at = swapped.find("moved", at)) != std::string::npos;) swapped.replace(at, 5, "other");
  EXPECT_NE(hash(swapped), hash(kGraph));
}

TEST(GraphHash, ChangesWithTheOrderOfAnArray) {
  const std::string merge = R"({ "quell": 1, "inputs": { "a": "color", "b": "color" },
    "nodes": { "merge": { "pass": "merge", "in": { "colors": ["a", "b"] } } }, "outputs": { "color": "merge.parts[0]" } })";
  EXPECT_NE(hash(with(R"(["a", "b"])", R"(["b", "a"])", merge)), hash(merge));
  EXPECT_NE(hash(with("parts[0]", "parts[1]", merge)), hash(merge));
  EXPECT_NE(hash(with(R"(["a", "b"])", R"(["a", "b", "b"])", merge)), hash(merge));
}

TEST(GraphHash, ReachesIntoSubgraphs) {
  const fs::path file = fs::path(QUELL_SOURCE_DIR) / "tests/core/graph/good/subgraphs.json";
  const auto hash_with = [&](const std::vector<std::string>& set) {
    return graph_hash(*load_graph(file, test::passes(), {.set = set, .params = {}}));
  };
  EXPECT_NE(hash_with({"second.blur.filter.radius=12"}), hash_with({}));
  EXPECT_EQ(hash_with({"first.size=9"}), hash_with({})) << "what the file says already";
}

TEST(GraphHash, TakesAFileByItsContent) {
  const fs::path folder = fs::path(testing::TempDir()) / "quell_graph_hash_test";
  fs::create_directories(folder / "a");
  fs::create_directories(folder / "b");
  const auto hash_of = [&](const std::string& file) {
    return hash(kGraph, {.set = {"first.lut=" + (folder / file).string()}, .params = {}});
  };
  std::ofstream(folder / "a/film.lut") << std::string(200'000, 'x');
  std::ofstream(folder / "b/other.lut") << std::string(200'000, 'x');
  std::ofstream(folder / "b/film.lut") << std::string(199'999, 'x') << 'y';
  EXPECT_EQ(hash_of("a/film.lut"), hash_of("b/other.lut"));
  EXPECT_NE(hash_of("a/film.lut"), hash_of("b/film.lut"));
  EXPECT_NE(hash_of("a/film.lut"), hash(kGraph));
  EXPECT_NE(hash_of("a/missing"), hash_of("b/missing")) << "by the path, where there is no file";
  const auto there = parse(kGraph, {.set = {"first.lut=" + (folder / "a/film.lut").string()}, .params = {}});
  EXPECT_THAT(canonical_text(*there), Not(HasSubstr(folder.string())));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace quell
