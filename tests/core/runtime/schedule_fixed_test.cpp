// Graphs made by hand, in all settings. Their passes round, so that another order of operations would show, too.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/core/runtime/memory_stream.h"
#include "tests/core/runtime/schedule_run.h"

namespace quell::test {
namespace {

const std::vector<TestInput> kColor = {{"color"}};

Scene scene_of(int frames) {
  Scene scene{.size = {37, 41}};
  for (int frame = 1; frame <= frames; ++frame) scene.frames.push_back(frame);
  return scene;
}

TEST(ScheduleOfTwoLoops, OfDifferentDelayDoesNotShow) {
  const auto graph = test_graph(R"({"quell": 1, "inputs": {"color": "color"},
    "nodes": {
      "soft": {"pass": "mix", "params": {"weight": 0.3},
               "in": {"color": "color", "other": {"from": "slow.color", "delay": 3, "initial": {"constant": [0.1, 0.2, 0.3]}}}},
      "fast": {"pass": "mix", "params": {"weight": 0.7},
               "in": {"color": "soft.color", "other": {"from": "fast.color", "delay": 1, "initial": "none"}}},
      "slow": {"pass": "mix", "params": {"weight": -0.5}, "in": {"color": "fast.color", "other": "soft.color"}},
      "apart": {"pass": "mix", "params": {"weight": 0.9},
                "in": {"color": "color", "other": {"from": "apart.color", "delay": 1, "initial": {"from": "color"}}}},
      "last": {"pass": "accumulate", "in": {"color": "slow.color", "history": "apart.color"}}},
    "outputs": {"color": "last.color", "fast": "fast.color"}})");
  expect_same_in_all_settings(graph, kColor, scene_of(12), {"soft.color", "color"});
}

TEST(ScheduleOfOptionalInputs, ThatArePrunedDoesNotShow) {
  const auto graph = test_graph(R"({"quell": 1,
    "inputs": {"color": "color", "extra": {"type": "color", "optional": true}, "spare": {"type": "color", "optional": true}},
    "nodes": {
      "blurred": {"pass": "mix", "in": {"color": "extra"}},
      "again": {"pass": "mix", "in": {"color": "blurred.color", "other": "spare"}},
      "sum": {"pass": "mix", "params": {"weight": 0.5},
              "in": {"color": "color", "other": {"from": "again.color", "delay": 2, "initial": {"constant": [0.7]}}}},
      "kept": {"pass": "accumulate", "in": {"color": "sum.color", "history": "blurred.color"}},
      "loop": {"pass": "mix", "params": {"weight": 0.6},
               "in": {"color": "kept.color", "other": {"from": "loop.color", "delay": 1, "initial": "none"}}}},
    "outputs": {"color": "loop.color"}})");
  for (const bool extra_absent : {true, false})
    for (const bool spare_absent : {true, false}) {
      SCOPED_TRACE(std::string(extra_absent ? "without" : "with") + " extra, " + (spare_absent ? "without" : "with") + " spare");
      expect_same_in_all_settings(
          graph, {{"color"}, {"extra", QUELL_TYPE_COLOR, true, extra_absent}, {"spare", QUELL_TYPE_COLOR, true, spare_absent}},
          scene_of(6));
    }
}

// Writes graph files into a folder of its own.
class ScheduleOfSubgraphs : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  std::shared_ptr<const Graph> load(const std::string& name) {
    static const Registry registry = test_passes();
    return load_graph(folder_ / name, registry);
  }

 private:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("quell_schedule_of_subgraphs_" + std::to_string(getpid()));
};

TEST_F(ScheduleOfSubgraphs, AndPortArraysDoesNotShow) {
  write("temporal.json", R"({"quell": 1, "inputs": {"color": "color", "guide": {"type": "color", "optional": true}},
    "nodes": {
      "blend": {"pass": "mix", "params": {"weight": 0.8},
                "in": {"color": "color", "other": {"from": "blend.color", "delay": 1, "initial": "none"}}},
      "guided": {"pass": "mix", "in": {"color": "blend.color", "other": {"from": "guide", "delay": 1, "initial": "none"}}}},
    "outputs": {"color": "guided.color", "plain": "blend.color"}})");
  write("pair.json", R"({"quell": 1, "inputs": {"diffuse": "color", "specular": "color"},
    "nodes": {
      "both": {"pass": "parts", "in": {"color": "diffuse", "items": ["diffuse", "specular", "late.color"]}, "params": {"in_place": true}},
      "late": {"graph": "temporal.json", "in": {"color": "specular", "guide": "diffuse"}}},
    "outputs": {"diffuse": "both.items[0]", "specular": "both.items[1]", "late": "both.items[2]"}})");
  write("main.json", R"({"quell": 1, "inputs": {"color": "color", "other": "color"},
    "nodes": {
      "first": {"graph": "pair.json", "in": {"diffuse": "color", "specular": "other"}},
      "second": {"graph": "pair.json", "in": {"diffuse": "first.specular", "specular": "first.late"}},
      "joined": {"pass": "stir", "in": {"color": "second.diffuse", "more": ["second.specular", "second.late",
                 {"from": "first.late", "delay": 2, "initial": "none"}, {"from": "joined.color", "delay": 3, "initial": {"constant": [5]}},
                 {"from": "color", "delay": -1, "initial": "none"}]}}},
    "outputs": {"color": "joined.color", "late": "second.late"}})");
  expect_same_in_all_settings(load("main.json"), {{"color"}, {"other"}}, scene_of(9), {"first.late.blend.color"});
}

}  // namespace
}  // namespace quell::test
