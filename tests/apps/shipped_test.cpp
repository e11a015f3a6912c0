// The graph and the sequence that ship, and the course's own data.
#include <gmock/gmock.h>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

namespace fs = std::filesystem;

class Shipped : public RunnerTest {};

TEST_F(Shipped, GraphRunsOnTheShippedSample) {
  const fs::path sample = fs::path(QUELL_SOURCE_DIR) / "graphs/sample";
  const Outcome outcome = quell({"run", "games202", sample.string(), "-o", text("out"), "--frames", "1-2", "-q"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(list("out"), ::testing::ElementsAre("color.0001.exr", "color.0002.exr"));
}

TEST_F(Shipped, GraphGivesTheSameBytesHoweverTheCourseDataIsNamed) {
  const fs::path box = fs::path(QUELL_SOURCE_DIR) / "../shared/data/games202-box";
  if (!fs::exists(box)) GTEST_SKIP() << "the course's data is not there: " << box;
  const auto run_with = [&](const std::string& out, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"run", "games202"});
    arguments.insert(arguments.end(), {"-o", text(out), "--frames", "0-1", "--set", "filter.radius=3", "-q"});
    const Outcome outcome = quell(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return contents(out);
  };
  const std::string base = fs::canonical(box).string() + "/";
  write_file("sequence.json", R"({ "quell_sequence": 1, "inputs": {
  "color": ")" + base + R"(beauty_%d.exr", "normal": ")" +
                                  base + R"(normal_%d.exr", "position": ")" + base + R"(position_%d.exr",
  "id": { "file": ")" + base + R"(ID_%d.exr", "background": -1 }, "camera": ")" +
                                  base + R"(matrix_%d.mat" } })");
  const auto by_folder = run_with("folder", {box.string(), "--threads", "1"});
  EXPECT_EQ(by_folder.size(), 2U);
  EXPECT_EQ(by_folder, run_with("file", {text("sequence.json"), "--threads", "2"}));
  EXPECT_EQ(by_folder,
            run_with("options", {"--in", "color=" + base + "beauty_%d.exr", "--in", "normal=" + base + "normal_%d.exr", "--in",
                                 "position=" + base + "position_%d.exr", "--in", "id=" + base + "ID_%d.exr:background=-1", "--in",
                                 "camera=" + base + "matrix_%d.mat"}));
}

}  // namespace
}  // namespace quell::app::testing
