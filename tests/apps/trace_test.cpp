// What --trace writes.
#include <gmock/gmock.h>

#include <csignal>
#include <map>
#include <set>

#include "quell/text/json.h"
#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

class TraceOption : public RunnerTest {
 protected:
  std::vector<std::string> arguments(const std::string& params = "{}") {
    return {"run", make_graph(params), text("shot"), "-o", text("out"), "-q", "--trace", text("trace.json")};
  }
  std::vector<Json> events() const {
    Diagnostics errors;
    const auto json = parse_json(read_text(path("trace.json"), Fault::input), errors);
    EXPECT_TRUE(json) << errors.render();
    return json ? json->elements : std::vector<Json>();
  }
  /// Frames of each kind and name: "read color" -> {1, 2}.
  static std::map<std::string, std::multiset<std::int64_t>> frames(const std::vector<Json>& events) {
    std::map<std::string, std::multiset<std::int64_t>> found;
    for (const Json& event : events)
      if (event.find("ph")->string == "X" && event.find("cat")->string != "help")
        found[event.find("cat")->string + " " + event.find("name")->string].insert(event.find("args")->find("frame")->integer);
    return found;
  }
};

TEST_F(TraceOption, HasASliceForEachNodeAndFileOfEachFrame) {
  make_shot(3);
  for (const char* executor : {"serial", "tbb"}) {
    std::vector<std::string> command = arguments();
    command.insert(command.end(), {"--executor", executor});
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::vector<Json> all = events();
    EXPECT_THAT(frames(all),
                UnorderedElementsAre(Pair("read color", ElementsAre(1, 2, 3)), Pair("node scale", ElementsAre(1, 2, 3)),
                                     Pair("write color", ElementsAre(1, 2, 3))));
    std::set<std::string> phases;
    for (const Json& event : all) phases.insert(event.find("ph")->string);
    EXPECT_THAT(phases, Contains("C")) << "memory";
    EXPECT_THAT(phases, Contains("M")) << "names of lanes";
  }
}

TEST_F(TraceOption, IsWholeAlsoWhenInterrupted) {
  make_shot(3);
  std::vector<std::string> command = arguments(R"({ "wait_from": 3 })");
  std::erase(command, "-q");
  command.insert(command.end(), {"--threads", "4", "--plugin-path", TEST_PLUGINS});
  Program program(command);
  ASSERT_TRUE(program.wait_for_error_text("\nwaiting\n"));
  ASSERT_TRUE(program.wait_for_error_text("\nframe 1 (1 of 3)"));
  EXPECT_FALSE(std::filesystem::exists(path("trace.json"))) << "before it is whole";
  program.send(SIGINT);
  EXPECT_EQ(program.finish().code, 75);
  EXPECT_THAT(frames(events())["node scale"], Contains(1));
  EXPECT_THAT(list(""), UnorderedElementsAre("graph.json", "shot", "out", "trace.json"));
}

TEST_F(TraceOption, ThatCannotBeWrittenIsToldBeforeTheFirstFrame) {
  make_shot(1);
  std::vector<std::string> command = arguments();
  const auto outcome_with = [&](const std::string& file) {
    command.back() = file;
    return run(command);
  };
  const Outcome missing = outcome_with(text("none/trace.json"));
  EXPECT_EQ(missing.code, 2);
  EXPECT_EQ(missing.err, "error: --trace: " + text("none/trace.json") + " cannot be written: No such file or directory\n");
  const Outcome folder = outcome_with(text("shot"));
  EXPECT_EQ(folder.code, 2);
  EXPECT_EQ(folder.err, "error: --trace: " + text("shot") + " is not a file; choose another name\n");
  const std::string before = read_file(path("shot/color.0001.exr"));
  const Outcome image = outcome_with(text("shot/color.0001.exr"));
  EXPECT_EQ(image.code, 2);
  EXPECT_THAT(image.err, HasSubstr("was not written by this option; choose another name\n"));
  EXPECT_EQ(read_file(path("shot/color.0001.exr")), before);
  EXPECT_THAT(list("out"), ElementsAre());
}

}  // namespace
}  // namespace quell::app::testing
