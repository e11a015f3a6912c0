// --swap and --bypass: the same as another file would do, for run, check and graph.
#include <gmock/gmock.h>

#include <map>

#include "tests/apps/sample.h"
#include "tests/core/sequence/test_files.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;

class Variants : public RunnerTest {
 protected:
  // A node `one` that multiplies by 1, in a loop of delay 1, and a reader with a delay of its own.
  std::string make_loop(const std::string& name, const std::string& in_between) const {
    write_file(name, R"({ "quell": 1, "inputs": { "color": "color" }, "nodes": {
      "one": { "pass": "test_scale", "in": { "color": { "from": "half.color", "delay": 1, "initial": { "constant": [7] } } } },
      "half": { "pass": "test_scale", "in": { "color": ")" +
                         in_between + R"(" }, "params": { "gain": 0.5 } },
      "late": { "pass": "test_scale", "in": { "color": { "from": "one.color", "delay": 2, "initial": { "constant": [7] } } },
                "params": { "gain": 3 } } },
    "outputs": { "color": "half.color", "late": "late.color" } })");
    return text(name);
  }

  /// Channels and pixels of all files in a folder. Their headers differ: they tell the graph's name and hash.
  std::map<std::string, std::pair<std::vector<std::string>, std::vector<float>>> pictures(const std::string& folder) const {
    std::map<std::string, std::pair<std::vector<std::string>, std::vector<float>>> found;
    for (const std::string& name : list(folder)) {
      const quell::test::ExrRead file = quell::test::load_exr(path(folder) / name);
      found[name] = {file.channels, file.pixels};
    }
    return found;
  }
};

TEST_F(Variants, ABypassedNodeThatChangedNothingChangesNothing) {
  make_shot(6);
  const std::string graph = make_loop("loop.json", "color");
  EXPECT_EQ(run({"run", graph, text("shot"), "-o", text("whole"), "-q"}).code, 0);
  const Outcome outcome = run({"run", graph, text("shot"), "-o", text("short"), "--bypass", "one"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("--bypass one: 'half.color' (with its delay of 1) is read instead of 'one.color'\n"));
  EXPECT_EQ(pictures("short"), pictures("whole"));
  EXPECT_EQ(pictures("short").size(), 12U);
}

TEST_F(Variants, AGraphWhoseOnlyNodeIsBypassedHandsItsInputOn) {
  make_shot(2);
  const Outcome outcome =
      run({"run", make_graph(R"({ "gain": 2 })"), text("shot"), "-o", text("out"), "--bypass", "scale", "--type", "float"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  make_graph(R"({ "gain": 1 })");
  EXPECT_EQ(run({"run", text("graph.json"), text("shot"), "-o", text("same"), "--type", "float", "-q"}).code, 0);
  EXPECT_EQ(pictures("out"), pictures("same"));
  EXPECT_EQ(pictures("out").size(), 2U);
}

TEST_F(Variants, ASwappedPassDoesWhatItDoesInAFile) {
  make_shot(2);
  const std::string graph = make_graph(R"({ "gain": 2 })");
  const Outcome outcome =
      run({"run", graph, text("shot"), "-o", text("swapped"), "--swap", "scale=tonemap", "--set", "scale.exposure=-2"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("--swap scale=tonemap: the parameter 'gain' of the file is left out\n"));
  write_file("other.json",
             R"({ "quell": 1, "name": "small", "inputs": { "color": "color" }, "nodes": { "scale": { "pass": "tonemap",
    "in": { "color": "color" }, "params": { "exposure": -2 } } }, "outputs": { "color": "scale.color" } })");
  EXPECT_EQ(run({"run", text("other.json"), text("shot"), "-o", text("written"), "-q"}).code, 0);
  EXPECT_EQ(contents("swapped"), contents("written")) << "to the hash in the header";
}

TEST_F(Variants, CheckAndGraphKnowThemToo) {
  const std::string graph = make_graph();
  const Outcome checked = run({"check", graph, "--swap", "scale=tonemap"});
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr(": ok: 1 node, "));
  const Outcome shown = run({"graph", graph, "--swap", "scale=tonemap"});
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("tonemap"));
  EXPECT_EQ(run({"graph", graph, "--bypass", "scale"}).code, 0);
}

TEST_F(Variants, WhatIsNotPossibleIsRefusedWithTheReason) {
  const std::string graph = make_graph();
  const Outcome refused = run({"check", graph, "--swap", "scale=reproject", "--bypass", "scaled"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err,
              HasSubstr("--swap:1:1: error: the pass 'reproject' needs an input 'motion' (motion), for which 'scale' "
                        "has no source of that name; it has 'color' (color)\n"));
  EXPECT_THAT(refused.err, HasSubstr("--bypass:1:1: error: the graph has no node 'scaled'; did you mean 'scale'?\n"));
}

}  // namespace
}  // namespace quell::app::testing
