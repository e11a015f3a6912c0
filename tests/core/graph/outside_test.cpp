// Parameters from outside: --set and --params.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/core/graph/graph_text.h"
#include "tests/core/graph/test_passes.h"

namespace quell {
namespace {

class FromOutside : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::current_path(std::filesystem::path(QUELL_SOURCE_DIR) / "tests/core/graph/good"); }
  void load(const std::string& name, const GraphOptions& options) { graph = load_graph(name + ".json", test::passes(), options); }
  std::string param(std::string_view node, std::string_view name) const { return test::param(*graph, node, name); }
  // A file of parameters in a folder of its own.
  static std::filesystem::path write(const std::string& name, const std::string& text) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "quell_outside_test";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / name) << text;
    return folder / name;
  }
  std::shared_ptr<const Graph> graph;
};

TEST_F(FromOutside, ASettingWinsOverTheFile) {
  load("parameters", {.set = {"one.sigma=3.5", "three.radius=1"}, .params = {}});
  EXPECT_EQ(param("one", "sigma"), "3.5");
  EXPECT_EQ(param("three", "radius"), "1");
}

TEST_F(FromOutside, LaterSettingsWin) {
  load("parameters", {.set = {"one.radius=3", "size=5", "two.radius=6"}, .params = {}});
  EXPECT_EQ(param("one", "radius"), "5");
  EXPECT_EQ(param("two", "radius"), "6");
}

TEST_F(FromOutside, AValueIsJsonOrElseText) {
  load("parameters", {.set = {"one.mode=bilinear", "two.mode=\"bicubic\"", "one.clamp=false", "one.kernel=[0.5, 0.25,]",
                              "one.names=[\"x\"]", "one.label=1e3", "two.label=a=b", "three.label="},
                      .params = {}});
  EXPECT_EQ(param("one", "mode"), "\"bilinear\"");
  EXPECT_EQ(param("two", "mode"), "\"bicubic\"");
  EXPECT_EQ(param("one", "clamp"), "false");
  EXPECT_EQ(param("one", "kernel"), "[0.5, 0.25]");
  EXPECT_EQ(param("one", "names"), "[\"x\"]");
  EXPECT_EQ(param("one", "label"), "\"1e3\"");  // a number, but the parameter is text
  EXPECT_EQ(param("two", "label"), "\"a=b\"");
  EXPECT_EQ(param("three", "label"), "\"\"");
}

TEST_F(FromOutside, PathsAreTakenFromTheCurrentFolder) {
  load("parameters", {.set = {"one.lut=there/x.lut"}, .params = {}});
  EXPECT_EQ(param("one", "lut"), "\"there/x.lut\"");
}

TEST_F(FromOutside, SubgraphsAreReachedByQualifiedNames) {
  load("subgraphs", {.set = {"first.size=11", "second.blur.filter.radius=12", "late.size=13"}, .params = {}});
  EXPECT_EQ(param("first.filter", "radius"), "11");
  EXPECT_EQ(param("first.blur.filter", "radius"), "11");
  EXPECT_EQ(param("second.filter", "radius"), "6");
  EXPECT_EQ(param("second.blur.filter", "radius"), "12");
  EXPECT_EQ(param("late.filter", "radius"), "13");
}

TEST_F(FromOutside, AFileSaysTheSameInThreeWays) {
  const auto file = write("params.json", R"({ "size": 21, // of the graph
    "one.sigma": 22, "two": { "sigma": 23, "lut": "x.lut" }, "three": { "label": "three" }, })");
  load("parameters", {.set = {}, .params = {file}});
  EXPECT_EQ(param("one", "radius"), "21");
  EXPECT_EQ(param("one", "sigma"), "22");
  EXPECT_EQ(param("two", "sigma"), "23");
  EXPECT_EQ(param("two", "lut"), "\"" + (file.parent_path() / "x.lut").string() + "\"");
  EXPECT_EQ(param("three", "label"), "\"three\"");
}

TEST_F(FromOutside, AFileReachesIntoSubgraphs) {
  const auto file = write("inner.json", R"({ "second": { "blur": { "filter": { "radius": 31 } }, "filter.radius": 32 } })");
  load("subgraphs", {.set = {}, .params = {file}});
  EXPECT_EQ(param("second.blur.filter", "radius"), "31");
  EXPECT_EQ(param("second.filter", "radius"), "32");
}

TEST_F(FromOutside, SettingsWinOverFilesAndLaterFilesOverEarlierOnes) {
  const auto first = write("first.json", R"({ "one.sigma": 1, "two.sigma": 1, "three.sigma": 1 })");
  const auto second = write("second.json", R"({ "two.sigma": 2, "three.sigma": 2 })");
  load("parameters", {.set = {"three.sigma=3"}, .params = {first, second}});
  EXPECT_EQ(param("one", "sigma"), "1");
  EXPECT_EQ(param("two", "sigma"), "2");
  EXPECT_EQ(param("three", "sigma"), "3");
}

TEST_F(FromOutside, NamesOfAnEarlierVersionHoldForANodeThatNamesIt) {
  load("versions", {.set = {"v2.strength=9", "v3.sigma=8"}, .params = {}});
  EXPECT_EQ(param("v2", "sigma"), "9");
  EXPECT_EQ(param("v3", "sigma"), "8");
}

}  // namespace
}  // namespace quell
