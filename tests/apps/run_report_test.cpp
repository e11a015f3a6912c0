// What --report writes.
#include <gmock/gmock.h>

#include <csignal>
#include <limits>

#include "quell/simd/isa.h"
#include "quell/text/json.h"
#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class RunReportTest : public RunnerTest {
 protected:
  std::vector<std::string> command(const std::vector<std::string>& options = {}, const std::string& params = "{}") {
    std::vector<std::string> arguments = {"run", make_graph(params), text("shot"),       "-o", text("out"),
                                          "-q",  "--report",         text("report.json")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return arguments;
  }

  Json report() const {
    Diagnostics errors;
    const auto json = parse_json(std::make_shared<SourceText>(SourceText{"report.json", read_file(path("report.json"))}), errors);
    EXPECT_TRUE(json) << errors.render();
    return json.value_or(Json{});
  }
  static std::string text_of(const Json& object, const char* key) {
    const Json* value = object.find(key);
    return value ? value->string : std::string("no '") + key + "'";
  }
  static std::int64_t exit_code(const Json& report) { return report.find("exit_code")->integer; }
};

TEST_F(RunReportTest, TellsAWholeRun) {
  make_shot(3);
  add_image("color", 2, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(run(command({"--threads", "2", "--format", "exr", "--format", "png"})).code, 0);
  const Json all = report();
  EXPECT_EQ(all.find("quell_run")->integer, 1);
  EXPECT_EQ(text_of(all, "version"), QUELL_VERSION);
  EXPECT_EQ(all.find("command")->elements.at(1).string, "run");
  EXPECT_EQ(text_of(all, "folder"), std::filesystem::current_path());
  EXPECT_EQ(text_of(*all.find("machine"), "isa"), current_isa());
  EXPECT_LE(text_of(all, "started"), text_of(all, "ended"));
  EXPECT_EQ(text_of(all, "outcome"), "done");
  EXPECT_EQ(text_of(all, "done"), "1-3");
  EXPECT_EQ(exit_code(all), 0);
  EXPECT_EQ(text_of(*all.find("run"), "graph"), text("graph.json"));
  EXPECT_EQ(all.find("run")->find("threads")->integer, 2);
  const Json& totals = *all.find("totals");
  EXPECT_EQ(totals.find("frames")->integer, 3);
  EXPECT_EQ(totals.find("replaced")->find("color")->integer, 16 * 8 * 3);
  EXPECT_GT(totals.find("node_seconds")->find("scale")->number, 0);
  EXPECT_GT(totals.find("peak_resident_bytes")->integer, 1 << 20);

  ASSERT_EQ(all.find("frames")->elements.size(), 3U);
  const Json& second = all.find("frames")->elements[1];
  EXPECT_EQ(second.find("frame")->integer, 2);
  EXPECT_TRUE(second.find("ok")->boolean);
  EXPECT_EQ(second.find("replaced")->elements.at(0).find("count")->integer, 16 * 8 * 3);
  for (const char* images : {"inputs", "results"}) {
    EXPECT_EQ(second.find(images)->find("color")->find("width")->integer, 16) << images;
    EXPECT_EQ(second.find(images)->find("color")->find("height")->integer, 8) << images;
  }
  const std::vector<Json>& files = second.find("files")->elements;
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].string, text("out/color.0002.exr"));
  EXPECT_EQ(files[1].string, text("out/color.0002.png"));
}

TEST_F(RunReportTest, TellsWhichFrameFailedAndWhy) {
  make_shot(3);
  EXPECT_EQ(run(command({}, R"({ "at": [2] })")).code, 1);
  const Json all = report();
  EXPECT_EQ(text_of(all, "outcome"), "failed");
  EXPECT_EQ(text_of(all, "failed"), "2");
  EXPECT_EQ(exit_code(all), 1);
  const Json& failed = all.find("frames")->elements.at(1);
  EXPECT_EQ(text_of(failed, "node"), "scale");
  EXPECT_EQ(text_of(failed, "error"), "scale: told to fail in frame 2");
  EXPECT_TRUE(failed.find("files")->elements.empty());
  EXPECT_THAT(read_file(path("report.json")), HasSubstr(R"({"level":"error","text":"frame 2 (2 of 3) failed: scale: told)"));
}

TEST_F(RunReportTest, IsWrittenWhenARunIsInterrupted) {
  make_shot(3);
  Program program({"run", make_graph(R"({ "wait_from": 3 })"), text("shot"), "-o", text("out"), "--plugin-path", TEST_PLUGINS,
                   "--report", text("report.json")});
  ASSERT_TRUE(program.wait_for_error_text("\nwaiting\n"));
  EXPECT_THAT(list(""), Not(Contains("report.json"))) << "while it runs";
  program.send(SIGTERM);
  EXPECT_EQ(program.finish().code, 75);
  const Json all = report();
  EXPECT_EQ(text_of(all, "outcome"), "interrupted");
  EXPECT_THAT(text_of(all, "not_computed"), HasSubstr("3"));
  EXPECT_EQ(exit_code(all), 75);
}

TEST_F(RunReportTest, TellsWhyARunDidNotStart) {
  make_shot(1);
  EXPECT_EQ(run(command({"--frames", "7"})).code, 3);
  const Json all = report();
  EXPECT_EQ(text_of(all, "outcome"), "failed");
  EXPECT_THAT(text_of(all, "error"), HasSubstr("files of the frames asked for are missing"));
  EXPECT_EQ(exit_code(all), 3);
  EXPECT_EQ(all.find("run"), nullptr);
  EXPECT_TRUE(all.find("frames")->elements.empty());
}

TEST_F(RunReportTest, TellsWhatWasDoneBeforeARunWentOn) {
  make_shot(3);
  EXPECT_EQ(run(command({"--checkpoint", text("kept"), "--frames", "1-2"})).code, 0);
  EXPECT_EQ(report().find("before")->find("done")->string, "");
  EXPECT_EQ(run(command({"--checkpoint", text("kept"), "--resume"})).code, 0);
  EXPECT_EQ(report().find("before")->find("done")->string, "1-2");
  EXPECT_EQ(text_of(report(), "done"), "3");
  EXPECT_EQ(run(command({"--checkpoint", text("kept"), "--resume"})).code, 0) << "nothing is left";
  EXPECT_EQ(report().find("before")->find("done")->string, "1-3");
  EXPECT_EQ(text_of(report(), "outcome"), "done");
}

TEST_F(RunReportTest, ReplacesAFormerReportButNothingElse) {
  make_shot(2);
  EXPECT_EQ(run(command()).code, 0);
  EXPECT_EQ(run(command({"--frames", "2"})).code, 0);
  EXPECT_EQ(report().find("frames")->elements.size(), 1U) << "of the second run alone";
  EXPECT_THAT(list(""), ElementsAre("graph.json", "out", "report.json", "shot")) << "and nothing is left beside it";

  const std::string graph = make_graph(), before = read_file(graph);
  const Outcome outcome = run({"run", graph, text("shot"), "-o", text("out"), "--report", graph});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("error: --report: " + graph + " is there, and was not written by this option"));
  EXPECT_EQ(read_file(graph), before);
}

TEST_F(RunReportTest, IsNoOtherOptionsFile) {
  make_shot(1);
  const Outcome outcome = run(command({"--log-json", text("./report.json")}));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("is the file of --log-json, too; choose another name"));
}

TEST_F(RunReportTest, StaysAwayFromADryRun) {
  make_shot(1);
  EXPECT_EQ(run(command({"--dry-run"})).code, 0);
  EXPECT_THAT(list(""), Not(Contains("report.json")));
}

}  // namespace
}  // namespace quell::app::testing
