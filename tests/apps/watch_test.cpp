// quell run --watch, as somebody meets it who edits a graph: the file is saved, and what is written and said is looked at.
#include <gmock/gmock.h>

#include <unistd.h>

#include <chrono>
#include <csignal>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

class Watch : public RunnerTest {
 protected:
  // As editors do: into another file, which then takes the name.
  void save_by_renaming(const std::string& name, const std::string& content) const {
    write_file(name + ".new", content);
    fs::rename(path(name + ".new"), path(name));
  }
  std::vector<std::string> watch(const std::string& graph, const std::string& shot, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {
        "run", graph, shot, "-o", text("out"), "--watch", "--log-json", text("run.jsonl"), "--plugin-path", TEST_PLUGINS};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  static int count(const std::string& text, const std::string& part) {
    int found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
    return found;
  }
  // Until so many runs have ended, those that could not start included. A minute is for a program that does nothing.
  bool wait_for_runs(int wanted) const {
    for (int tries = 0; tries < 6000; ++tries) {
      if (count(read_file(path("run.jsonl")), R"("event":"end")") >= wanted) return true;
      usleep(10'000);
    }
    return false;
  }
  static Outcome end(Program& program) {
    program.send(SIGINT);
    return program.finish();
  }
  // A chain of two nodes, with an output behind each.
  static std::string chain(const std::string& first, const std::string& second, const std::string& outputs) {
    return R"({ "quell": 1, "inputs": { "color": "color" }, "nodes": {
      "first": { "pass": "test_scale", "in": { "color": "color" }, "params": { "gain": )" +
           first + R"( } },
      "second": { "pass": "test_scale", "in": { "color": "first.color" }, "params": { "gain": )" +
           second + R"( } } },
    "outputs": { )" +
           outputs + " } }";
  }
};

constexpr const char* kBoth = R"("color": "second.color", "inner": "first.color")";

// The method of the shipped graph, with a node behind its loop.
TEST_F(Watch, ComputesTheLastNodeAloneWhenItsParameterChangesAndALoopWithoutWhatFeedsIt) {
  const std::string shot = fs::path(QUELL_SOURCE_DIR) / "graphs/sample";
  std::string graph = read_file(fs::path(QUELL_SOURCE_DIR) / "graphs/games202.json");
  graph = replaced(graph, "\"radius\": 16", "\"radius\": 2");
  graph = replaced(graph, "\"nodes\": {",
                   "\"nodes\": { \"view\": { \"pass\": \"tonemap\", \"in\": { \"color\": \"blend.color\" }, "
                   "\"params\": { \"exposure\": 0 } },");
  graph = replaced(graph, "\"outputs\": { \"color\": \"blend.color\" }", "\"outputs\": { \"color\": \"view.color\" }");
  write_file("mine.json", graph);
  Program program(watch(text("mine.json"), shot, {"--frames", "1-4"}));
  ASSERT_TRUE(wait_for_runs(1));
  EXPECT_EQ(list("out").size(), 4U);

  graph = replaced(graph, "\"exposure\": 0", "\"exposure\": 1");
  write_file("mine.json", graph);  // in place
  ASSERT_TRUE(program.wait_for_error_text("\nview: 4 of 4 frames; filter, motion, reproject, blend: kept\n"));
  ASSERT_TRUE(wait_for_runs(2));
  const auto brighter = contents("out");
  EXPECT_EQ(run({"run", text("mine.json"), shot, "-o", text("whole"), "--frames", "1-4", "-q"}).code, 0);
  EXPECT_EQ(brighter, contents("whole"));

  graph = replaced(graph, "\"alpha\": 0.2", "\"alpha\": 0.4");
  save_by_renaming("mine.json", graph);
  ASSERT_TRUE(program.wait_for_error_text("\nreproject, blend, view: 4 of 4 frames; filter, motion: kept\n"));
  ASSERT_TRUE(wait_for_runs(3));
  EXPECT_EQ(run({"run", text("mine.json"), shot, "-o", text("whole"), "--frames", "1-4", "-q"}).code, 0);
  EXPECT_EQ(contents("out"), contents("whole"));
  EXPECT_NE(contents("out"), brighter);

  const Outcome outcome = end(program);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

// A file of layers holds all results of a frame, those too that a change cannot affect.
TEST_F(Watch, WritesWholeFilesOfLayers) {
  make_shot(2);
  write_file("graph.json", chain("2", "3", kBoth));
  Program program(watch(text("graph.json"), text("shot"), {"--layers", "all"}));
  ASSERT_TRUE(wait_for_runs(1));
  write_file("graph.json", chain("2", "4", kBoth));
  ASSERT_TRUE(wait_for_runs(2));
  const Outcome outcome = end(program);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("\nsecond: 2 of 2 frames; first: kept\n"));
  EXPECT_EQ(
      run({"run", text("graph.json"), text("shot"), "-o", text("whole"), "--layers", "all", "-q", "--plugin-path", TEST_PLUGINS})
          .code,
      0);
  EXPECT_THAT(list("out"), ElementsAre("all.0001.exr", "all.0002.exr"));
  EXPECT_EQ(contents("out"), contents("whole"));
}

TEST_F(Watch, LeavesTheFolderThatAWholeRunWouldWriteByteForByte) {
  make_shot(2);
  write_file("graph.json", chain("2", "3", kBoth));
  Program program(watch(text("graph.json"), text("shot")));
  ASSERT_TRUE(wait_for_runs(1));
  int runs = 1;
  const auto expect_whole_after = [&](const std::string& graph) {
    write_file("graph.json", graph);
    ASSERT_TRUE(wait_for_runs(++runs));
    EXPECT_EQ(run({"run", text("graph.json"), text("shot"), "-o", text("whole"), "-q", "--plugin-path", TEST_PLUGINS}).code, 0);
    EXPECT_EQ(contents("out"), contents("whole")) << graph;
  };
  expect_whole_after(chain("2", "4", kBoth));  // `inner` stays as it is
  expect_whole_after(replaced(chain("2", "4", kBoth), "\"quell\": 1", "\"quell\": 1, \"name\": \"renamed\""));
  expect_whole_after(
      replaced(chain("2", "4", kBoth), "\"color\": \"color\"", "\"color\": { \"type\": \"color\", \"optional\": true }"));
  const Outcome outcome = end(program);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("\nsecond: 2 of 2 frames; first: kept\n"));
  EXPECT_THAT(outcome.err, HasSubstr("\nfirst, second: kept\n")) << "only headers differ";
}

TEST_F(Watch, TakesALayerThatIsNoLongerAnOutputOutOfItsFile) {
  make_shot(2);
  write_file("graph.json", chain("2", "3", kBoth));
  Program program(watch(text("graph.json"), text("shot"), {"--layers", "all"}));
  ASSERT_TRUE(wait_for_runs(1));
  write_file("graph.json", chain("2", "3", R"("color": "second.color")"));
  ASSERT_TRUE(wait_for_runs(2));
  EXPECT_EQ(end(program).code, 0);
  EXPECT_EQ(
      run({"run", text("graph.json"), text("shot"), "-o", text("whole"), "--layers", "all", "-q", "--plugin-path", TEST_PLUGINS})
          .code,
      0);
  EXPECT_EQ(contents("out"), contents("whole"));
}

TEST_F(Watch, WritesOnlyWhatHasChangedAndLeavesWhatIsNoLongerAnOutput) {
  make_shot(2);
  write_file("graph.json", chain("2", "3", kBoth));
  Program program(watch(text("graph.json"), text("shot")));
  ASSERT_TRUE(wait_for_runs(1));
  const auto long_ago = fs::last_write_time(path("graph.json")) - std::chrono::hours(1);
  for (const std::string& name : list("out")) fs::last_write_time(path("out") / name, long_ago);
  write_file("graph.json", chain("2", "4", kBoth));
  ASSERT_TRUE(wait_for_runs(2));
  for (const std::string& name : list("out"))
    EXPECT_EQ(fs::last_write_time(path("out") / name) == long_ago, name.starts_with("inner")) << name;
  write_file("graph.json", chain("2", "4", R"("color": "second.color")"));
  ASSERT_TRUE(wait_for_runs(3));
  const Outcome outcome = end(program);
  EXPECT_THAT(outcome.err, HasSubstr("\nsecond: 2 of 2 frames; first: kept\n"));
  EXPECT_THAT(outcome.err, HasSubstr("the graph has no 'inner' any more; " + text("out") + "/inner.####.exr is left as it is\n"));
  EXPECT_THAT(outcome.err, HasSubstr("nothing that is written has changed\n"));
  EXPECT_THAT(list("out"), ElementsAre("color.0001.exr", "color.0002.exr", "inner.0001.exr", "inner.0002.exr"));
  EXPECT_EQ(outcome.code, 0);
}

TEST_F(Watch, TellsEveryMistakeAndWaitsForTheNextSaving) {
  make_shot(2);
  write_file("graph.json", chain("2", "3", kBoth));
  Program program(watch(text("graph.json"), text("shot")));
  ASSERT_TRUE(wait_for_runs(1));
  write_file("graph.json", replaced(chain("2", "-3", kBoth), "first.color\" }", "first.colour\" }"));
  ASSERT_TRUE(wait_for_runs(2));
  write_file("graph.json", chain("2", "5", kBoth));
  ASSERT_TRUE(program.wait_for_error_text("\nsecond: 2 of 2 frames; first: kept\n"));
  ASSERT_TRUE(wait_for_runs(3));
  const Outcome outcome = end(program);
  EXPECT_THAT(outcome.err, HasSubstr("has no output 'colour'"));
  EXPECT_THAT(outcome.err, HasSubstr("'second.gain' takes a number from 0"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST_F(Watch, EndsWhenTheFolderOfTheGraphIsRemoved) {
  make_shot(2);
  write_file("graphs/graph.json", chain("2", "3", kBoth));
  Program program(watch(text("graphs/graph.json"), text("shot")));
  ASSERT_TRUE(wait_for_runs(1));
  fs::remove_all(path("graphs"));
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--watch: the folder " + text("graphs") + " was removed; start again when its files are"));
}

TEST_F(Watch, FollowsALinkThatLeadsElsewhere) {
  make_shot(2);
  write_file("a/graph.json", chain("2", "3", kBoth));
  write_file("b/graph.json", "{");
  fs::create_symlink("a/graph.json", path("graph.json"));
  Program program(watch(text("graph.json"), text("shot")));
  ASSERT_TRUE(wait_for_runs(1));
  fs::create_symlink("b/graph.json", path("other.json"));
  fs::rename(path("other.json"), path("graph.json"));
  ASSERT_TRUE(wait_for_runs(2));  // it tells the mistake
  write_file("b/graph.json", chain("2", "5", kBoth));
  ASSERT_TRUE(program.wait_for_error_text("\nsecond: 2 of 2 frames; first: kept\n"));
  EXPECT_EQ(end(program).code, 0);
}

TEST_F(Watch, AMistakeBeforeTheFirstFrameEndsIt) {
  make_shot(2);
  write_file("graph.json", chain("2", "-3", kBoth));
  EXPECT_EQ(quell(watch(text("graph.json"), text("shot"))).code, 2);
  EXPECT_EQ(quell(watch(text("none.json"), text("shot"))).code, 2);
  write_file("graph.json", chain("2", "3", kBoth));
  const Outcome dry = quell(watch(text("graph.json"), text("shot"), {"--dry-run"}));
  EXPECT_EQ(dry.code, 2);
  EXPECT_THAT(dry.err, HasSubstr("--watch: there is nothing to watch with --dry-run; leave one of them out"));
  EXPECT_EQ(quell(watch(text("graph.json"), text("shot"), {"--trace", text("t.json")})).code, 2);
  EXPECT_THAT(list("out"), ElementsAre());
}

TEST_F(Watch, FollowsSubgraphsParametersAndFilesOfPasses) {
  make_shot(2);
  const auto inner = [](const std::string& gain) { return chain(gain, "1", R"("color": "second.color")"); };
  write_file("parts/inner.json", inner("2"));
  write_file("table.txt", "1");
  write_file("graph.json", R"({ "quell": 1, "inputs": { "color": "color" }, "nodes": {
    "sub": { "graph": "parts/inner.json", "in": { "color": "color" } },
    "last": { "pass": "test_scale", "in": { "color": "sub.color" }, "params": { "table": "table.txt" } } },
    "outputs": { "color": "last.color" } })");
  write_file("params.json", R"({ "last.gain": 2 })");
  Program program(watch(text("graph.json"), text("shot"), {"--params", text("params.json"), "--bypass", "sub.second"}));
  ASSERT_TRUE(wait_for_runs(1));
  save_by_renaming("params.json", R"({ "last.gain": 3 })");
  ASSERT_TRUE(program.wait_for_error_text("\nlast: 2 of 2 frames; sub.first: kept\n"));
  save_by_renaming("parts/inner.json", inner("4"));
  ASSERT_TRUE(program.wait_for_error_text("\nsub.first, last: 2 of 2 frames\n"));
  ASSERT_TRUE(wait_for_runs(3));
  write_file("table.txt", "12");
  fs::rename(path("graph.json"), path("aside.json"));
  fs::rename(path("aside.json"), path("graph.json"));  // as it was
  ASSERT_TRUE(wait_for_runs(4));
  const Outcome outcome = end(program);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(count(outcome.err, "\nlast: 2 of 2 frames; sub.first: kept\n"), 2) << outcome.err;
}

TEST_F(Watch, NoticesWhatIsAddedToAFolderThatAParameterNames) {
  make_shot(2);
  fs::create_directories(path("tables"));
  const std::string graph = R"({ "quell": 1, "inputs": { "color": "color" }, "nodes": {
    "only": { "pass": "test_scale", "in": { "color": "color" }, "params": { "table": "tables" } } },
    "outputs": { "color": "only.color" } })";
  write_file("graph.json", graph);
  Program program(watch(text("graph.json"), text("shot")));
  ASSERT_TRUE(wait_for_runs(1));
  write_file("graph.json", graph);
  ASSERT_TRUE(program.wait_for_error_text("\nnothing that is written has changed\n"));
  ASSERT_TRUE(wait_for_runs(2));
  write_file("tables/a.txt", "1");
  write_file("graph.json", graph);
  ASSERT_TRUE(program.wait_for_error_text("\nonly: 2 of 2 frames\n"));
  EXPECT_EQ(end(program).code, 0);
}

TEST_F(Watch, OpensTheSequenceAgainForOtherInputs) {
  make_shot(2);
  for (const int frame : {1, 2}) add_image("albedo", frame, 0.5F);
  write_file("graph.json", chain("2", "3", kBoth));
  Program program(watch(text("graph.json"), text("shot")));
  ASSERT_TRUE(wait_for_runs(1));
  write_file("graph.json", replaced(replaced(chain("2", "3", kBoth), R"("inputs": { "color": "color" })",
                                             R"("inputs": { "color": "color", "albedo": "albedo" })"),
                                    R"("inner": "first.color")", R"("inner": "first.color", "albedo": "albedo")"));
  ASSERT_TRUE(wait_for_runs(2));
  const Outcome outcome = end(program);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("\nfirst, second: kept\n"));
  EXPECT_THAT(list("out"), ::testing::IsSupersetOf({"albedo.0001.exr", "albedo.0002.exr"}));
}

TEST_F(Watch, ASignalInTheMiddleOfARunEndsItAsEver) {
  make_shot(4);
  make_graph();
  Program program(watch(text("graph.json"), text("shot"), {"--threads", "4"}));
  ASSERT_TRUE(wait_for_runs(1));
  make_graph(R"({ "wait_from": 3 })");
  ASSERT_TRUE(program.wait_for_error_text("\nwaiting\n"));
  const Outcome outcome = end(program);
  EXPECT_EQ(outcome.code, 75) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("error: interrupted; frames done: "));
  EXPECT_THAT(list("out").size(), 4U);
}

TEST_F(Watch, LogsEachRun) {
  make_shot(2);
  write_file("graph.json", chain("2", "3", kBoth));
  Program program(watch(text("graph.json"), text("shot"), {"-q"}));
  ASSERT_TRUE(wait_for_runs(1));
  write_file("graph.json", chain("2", "4", kBoth));
  ASSERT_TRUE(wait_for_runs(2));
  write_file("graph.json", "{");
  ASSERT_TRUE(wait_for_runs(3));
  EXPECT_EQ(end(program).code, 0);
  const std::string log = read_file(path("run.jsonl"));
  EXPECT_THAT(log, HasSubstr(R"("outcome":"failed","error":)"));
  EXPECT_THAT(log, HasSubstr(R"("node_seconds":{"first":0.000000,)")) << log;
}

}  // namespace
}  // namespace quell::app::testing
