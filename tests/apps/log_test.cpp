// What --log-json writes.
#include <gmock/gmock.h>

#include <csignal>
#include <limits>
#include <sstream>

#include "quell/simd/isa.h"
#include "quell/text/json.h"
#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Log : public RunnerTest {
 protected:
  /// Runs the small graph over shot/ with these options as well.
  Outcome run_logged(const std::vector<std::string>& options = {}, const std::string& params = "{}") {
    std::vector<std::string> arguments = {"run", make_graph(params), text("shot"),   "-o", text("out"),
                                          "-q",  "--log-json",       text("run.log")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  }

  std::vector<Json> events() const {
    std::vector<Json> found;
    std::istringstream log(read_file(path("run.log")));
    for (std::string line; std::getline(log, line);) {
      Diagnostics errors;
      const auto json = parse_json(std::make_shared<SourceText>(SourceText{"run.log", line}), errors);
      EXPECT_TRUE(json) << errors.render();
      found.push_back(json.value_or(Json{}));
    }
    return found;
  }
  static std::vector<std::string> names(const std::vector<Json>& events) {
    std::vector<std::string> all;
    for (const Json& event : events) all.push_back(event.find("event")->string);
    return all;
  }
  static std::string text_of(const Json& event, const char* key) {
    const Json* value = event.find(key);
    return value ? value->string : std::string("no '") + key + "'";
  }
};

TEST_F(Log, TellsARunFromStartToEnd) {
  make_shot(3);
  EXPECT_EQ(run_logged({"--threads", "2", "--memory", "1G", "--format", "exr", "--format", "png"}).err, "");
  const std::vector<Json> all = events();
  ASSERT_THAT(names(all), ElementsAre("start", "frame", "frame", "frame", "end"));
  const Json& start = all.front();
  EXPECT_EQ(text_of(start, "version"), QUELL_VERSION);
  EXPECT_EQ(text_of(start, "graph"), text("graph.json"));
  EXPECT_EQ(text_of(start, "name"), "small");
  EXPECT_THAT(text_of(start, "sequence"), StartsWith(text("shot")));
  EXPECT_EQ(text_of(*start.find("inputs"), "color"), text("shot/color.####.exr"));
  EXPECT_EQ(start.find("outputs")->elements.at(1).string, text("out/color.####.png"));
  EXPECT_EQ(text_of(start, "frames"), "1-3");
  EXPECT_EQ(start.find("frame_count")->integer, 3);
  EXPECT_EQ(text_of(start, "executor"), "tbb");
  EXPECT_EQ(text_of(start, "isa"), current_isa());
  EXPECT_EQ(start.find("threads")->integer, 2);
  EXPECT_GE(start.find("frames_in_flight")->integer, 1);
  EXPECT_EQ(start.find("memory_limit")->integer, 1 << 30);
  EXPECT_EQ(text_of(start, "on_error"), "continue");

  const Json& end = all.back();
  EXPECT_EQ(text_of(end, "outcome"), "done");
  EXPECT_EQ(text_of(end, "done"), "1-3");
  EXPECT_EQ(text_of(end, "failed"), "");
  EXPECT_EQ(text_of(end, "not_computed"), "");
  EXPECT_GT(end.find("seconds")->number, 0);
  EXPECT_GT(end.find("peak_bytes")->integer, 0);
  EXPECT_EQ(end.find("exit_code")->integer, 0);
}

TEST_F(Log, TellsTimesMemoryAndReplacedValuesOfAFrame) {
  make_shot(2);
  add_image("color", 2, std::numeric_limits<float>::quiet_NaN());
  run_logged();
  const std::vector<Json> all = events();
  ASSERT_GE(all.size(), 3U);
  EXPECT_EQ(all[1].find("frame")->integer, 1);
  EXPECT_TRUE(all[1].find("ok")->boolean);
  EXPECT_EQ(all[1].find("error"), nullptr);
  for (const char* key : {"seconds", "read_seconds", "write_seconds"}) EXPECT_GE(all[1].find(key)->number, 0) << key;
  EXPECT_GE(all[1].find("node_seconds")->find("scale")->number, 0);
  for (const char* key : {"in_use", "idle", "peak"}) EXPECT_GE(all[1].find("memory")->find(key)->integer, 0) << key;
  EXPECT_TRUE(all[1].find("replaced")->elements.empty());
  ASSERT_EQ(all[2].find("replaced")->elements.size(), 1U);
  const Json& replaced = all[2].find("replaced")->elements[0];
  EXPECT_EQ(text_of(replaced, "input"), "color");
  EXPECT_EQ(text_of(replaced, "type"), "color");
  EXPECT_EQ(replaced.find("count")->integer, 16 * 8 * 3);
}

TEST_F(Log, TellsWhichNodeFailedAndWhy) {
  make_shot(3);
  EXPECT_EQ(run_logged({}, R"({ "at": [2] })").code, 1);
  const std::vector<Json> all = events();
  const auto failed =
      std::find_if(all.begin(), all.end(), [](const Json& event) { return event.find("ok") && !event.find("ok")->boolean; });
  ASSERT_NE(failed, all.end());
  EXPECT_EQ(failed->find("frame")->integer, 2);
  EXPECT_EQ(text_of(*failed, "node"), "scale");
  EXPECT_EQ(text_of(*failed, "error"), "scale: told to fail in frame 2");
  EXPECT_EQ(text_of(all.back(), "outcome"), "failed");
  EXPECT_EQ(text_of(all.back(), "done"), "1,3");
  EXPECT_EQ(text_of(all.back(), "failed"), "2");
  EXPECT_EQ(all.back().find("exit_code")->integer, 1);
}

TEST_F(Log, TellsThatARunStopped) {
  make_shot(4);
  EXPECT_EQ(run_logged({"--on-error", "stop"}, R"({ "at": [2] })").code, 1);
  const Json end = events().back();
  EXPECT_EQ(text_of(end, "outcome"), "stopped");
  EXPECT_EQ(text_of(end, "not_computed"), "3-4");
}

TEST_F(Log, TellsThatARunWasInterrupted) {
  make_shot(3);
  Program program({"run", make_graph(R"({ "wait_from": 3 })"), text("shot"), "-o", text("out"), "--plugin-path", TEST_PLUGINS,
                   "--log-json", text("run.log")});
  ASSERT_TRUE(program.wait_for_error_text("\nwaiting\n"));
  EXPECT_THAT(names(events()), Contains("start")) << "while it runs";
  program.send(SIGINT);
  EXPECT_EQ(program.finish().code, 75);
  const Json end = events().back();
  EXPECT_EQ(text_of(end, "outcome"), "interrupted");
  EXPECT_EQ(end.find("exit_code")->integer, 75);
}

TEST_F(Log, TakesWarningsAndWhatPassesSay) {
  make_shot(2);
  const auto messages = [&](const std::vector<std::string>& options) {
    run_logged(options, R"({ "at": [2], "wrong": "warn" })");
    std::vector<std::string> found;
    for (const Json& event : events())
      if (text_of(event, "event") == "message") found.push_back(text_of(event, "level") + ": " + text_of(event, "text"));
    return found;
  };
  EXPECT_THAT(messages({}), ElementsAre("warning: a warning of the pass"));
  std::vector<std::string> arguments = {"run", text("graph.json"), text("shot"),   "-o", text("out"),
                                        "-v",  "--log-json",       text("run.log")};
  run(arguments);
  EXPECT_THAT(read_file(path("run.log")), HasSubstr(R"("level":"debug","text":"a detail of the pass")"));
}

TEST_F(Log, TellsWhyARunDidNotStart) {
  make_shot(1);
  EXPECT_EQ(run_logged({"--frames", "7"}).code, 3);
  const std::vector<Json> all = events();
  ASSERT_THAT(names(all), ElementsAre("end"));
  EXPECT_EQ(text_of(all[0], "outcome"), "failed");
  EXPECT_THAT(text_of(all[0], "error"), HasSubstr("files of the frames asked for are missing"));
  EXPECT_EQ(all[0].find("exit_code")->integer, 3);
}

TEST_F(Log, ReplacesAFormerLogButNothingElse) {
  make_shot(1);
  EXPECT_EQ(run_logged().code, 0);
  EXPECT_EQ(run_logged().code, 0);
  EXPECT_EQ(names(events()).size(), 3U) << "of the second run alone";
  const std::string graph = make_graph();
  const std::string before = read_file(graph);
  const Outcome outcome = run({"run", graph, text("shot"), "-o", text("out"), "--log-json", graph});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: --log-json: " + graph + " is there, and was not written by this option; choose another name\n");
  EXPECT_EQ(read_file(graph), before);
}

TEST_F(Log, ThatCannotBeWrittenIsAnError) {
  make_shot(1);
  const std::string graph = make_graph();
  const Outcome missing = run({"run", graph, text("shot"), "-o", text("out"), "--log-json", text("none/run.log")});
  EXPECT_EQ(missing.code, 2);
  EXPECT_EQ(missing.err, "error: --log-json: " + text("none/run.log") + " cannot be written: No such file or directory\n");
  const Outcome full = run({"run", graph, text("shot"), "-o", text("out"), "-q", "--log-json", "/dev/full"});
  EXPECT_EQ(full.code, 70);
  EXPECT_EQ(full.err, "error: --log-json: /dev/full could not be written\n");
}

TEST_F(Log, IsNotWrittenByADryRun) {
  make_shot(1);
  EXPECT_EQ(run_logged({"--dry-run"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("run.log")));
}

}  // namespace
}  // namespace quell::app::testing
