// Parts of a sequence, computed as if by a run over all of it.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;
const fs::path kRoom = QUELL_SOURCE_DIR "/../shared/data/room";

class Chunk : public RunnerTest {
 protected:
  Chunk() {
    write_graph("loop.json", 1, R"("params": {"alpha": 0.3, "clamp": "none"}, )");
    write_graph("ahead.json", -1, R"("params": {"alpha": 0.3, "clamp": "none"}, )", "color");
    write_graph("endless.json", 1, R"("params": {"alpha": 0, "clamp": "none"}, )");
  }
  void write_graph(const std::string& name, int delay, const std::string& params, const std::string& from = "blend.color") const {
    write_file(name, R"({"quell": 1, "name": "test", "inputs": {"color": "color"},
      "nodes": {"blend": {"pass": "temporal_blend", )" +
                         params + R"("in": {"color": "color",
                "history": {"from": ")" +
                         from + R"(", "delay": )" + std::to_string(delay) + R"(, "initial": "none"}}},
                "light": {"pass": "gaussian", "params": {"radius": 5}, "in": {"image": "blend.color"}}},
      "outputs": {"color": "light.image"}})");
  }
  Outcome compute(const std::string& graph, const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"run", text(graph), text("shot"), "-o", text(out), "--type", "float"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  // Of all pixels: the largest difference between files of one name, over their largest value.
  double largest_error(const std::string& a, const std::string& b) const {
    double worst = 0;
    for (const std::string& name : list(a)) {
      const std::vector<float> got = pixels_of(path(a) / name), want = pixels_of(path(b) / name);
      double difference = 0, largest = 0;
      for (std::size_t i = 0; i < want.size(); ++i) {
        difference = std::max(difference, std::abs(double{got[i]} - want[i]));
        largest = std::max(largest, std::abs(double{want[i]}));
      }
      worst = std::max(worst, difference / largest);
    }
    return worst;
  }
};

TEST_F(Chunk, DiffersFromTheWholeByNoMoreThanTheTolerance) {
  make_shot(60);
  ASSERT_EQ(compute("loop.json", "whole").code, 0);
  for (const char* chunk : {"1/4", "2/4", "3/4", "4/4"}) {
    const Outcome outcome = compute("loop.json", "parts", {"--chunk", chunk});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    if (chunk[0] != '3') continue;
    EXPECT_THAT(outcome.err, HasSubstr("pre-roll of 13 frames, 18-30 ('blend' keeps 0.7 of its history, of which 13 frames leave "
                                       "0.0097)"));
  }
  EXPECT_EQ(list("parts"), list("whole"));
  const double error = largest_error("parts", "whole");
  EXPECT_GT(error, 1e-6) << "the history of a chunk is shorter";
  EXPECT_LE(error, 0.01);
  RecordProperty("largest_error", std::to_string(error));
  ASSERT_EQ(compute("loop.json", "finer", {"--frames", "31-45", "--preroll", "auto", "--preroll-tolerance", "1e-5"}).code, 0);
  EXPECT_LE(largest_error("finer", "whole"), 1e-5);
  ASSERT_EQ(compute("loop.json", "bare", {"--frames", "31-45"}).code, 0);
  EXPECT_GT(largest_error("bare", "whole"), 0.01) << "without a pre-roll, --frames begins anew";
}

TEST_F(Chunk, SeesTheFramesBehindItsEnd) {
  make_shot(9);
  ASSERT_EQ(compute("ahead.json", "whole").code, 0);
  for (const char* chunk : {"1/3", "2/3", "3/3"}) ASSERT_EQ(compute("ahead.json", "parts", {"--chunk", chunk}).code, 0);
  EXPECT_EQ(contents("parts"), contents("whole"));
}

TEST_F(Chunk, OfAChainOfCheckpointsIsTheWholeBitForBit) {
  make_shot(20);
  ASSERT_EQ(compute("endless.json", "whole").code, 0);
  const std::vector<std::string> chain = {"--checkpoint", text("kept"), "--resume", "--preroll", "0", "--chunk"};
  const auto with = [&](const char* chunk) {
    std::vector<std::string> words = chain;
    words.push_back(chunk);
    return words;
  };
  ASSERT_EQ(compute("endless.json", "parts", with("1/3")).code, 0);
  const Outcome early = compute("endless.json", "parts", with("3/3"));
  EXPECT_EQ(early.code, 2);
  EXPECT_THAT(early.err, HasSubstr("compute the chunks between them first"));
  ASSERT_EQ(compute("endless.json", "parts", with("2/3")).code, 0);
  ASSERT_EQ(compute("endless.json", "parts", with("3/3")).code, 0);
  EXPECT_EQ(contents("parts"), contents("whole"));
}

TEST_F(Chunk, GoesOnFromItsCheckpointWithoutAPreroll) {
  make_shot(40);
  const std::vector<std::string> chunk = {"--checkpoint", text("kept"), "--resume", "--chunk", "2/2"};
  ASSERT_EQ(compute("loop.json", "straight", {"--chunk", "2/2"}).code, 0);
  std::vector<std::string> part = {"--checkpoint", text("kept"), "--resume", "--frames", "21-30", "--preroll", "auto"};
  ASSERT_EQ(compute("loop.json", "parts", part).code, 0);
  const Outcome rest = compute("loop.json", "parts", chunk);
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_THAT(rest.err, Not(HasSubstr("pre-roll")));
  EXPECT_EQ(contents("parts"), contents("straight"));
}

TEST_F(Chunk, BeginsAtACut) {
  make_shot(40);
  ASSERT_EQ(compute("loop.json", "whole", {"--cut", "18"}).code, 0);
  const Outcome outcome = compute("loop.json", "parts", {"--cut", "18", "--chunk", "2/2"});
  EXPECT_THAT(outcome.err, HasSubstr("pre-roll of 3 frames, 18-20 (since the cut at frame 18)"));
  EXPECT_EQ(largest_error("parts", "whole"), 0);
}

TEST_F(Chunk, LeavesOutNodesThatNoHistoryNeeds) {
  make_shot(20);
  ASSERT_EQ(compute("loop.json", "parts", {"--chunk", "2/2", "--log-json", text("log")}).code, 0);
  const std::string log = read_file(path("log"));
  EXPECT_THAT(log, ::testing::ContainsRegex(R"("frame":9,"ok":true,"history_only":true.*"light":0.000000[,}])"));
}

TEST_F(Chunk, TellsWhatCannotBe) {
  make_shot(4);
  const auto error_of = [&](const std::vector<std::string>& more, const std::string& graph = "loop.json") {
    const Outcome outcome = compute(graph, "out", more);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(error_of({"--chunk", "2"}), HasSubstr("write the second of four as 2/4"));
  EXPECT_THAT(error_of({"--chunk", "3/2"}), HasSubstr("--chunk"));
  EXPECT_THAT(error_of({"--chunk", "1/5"}), HasSubstr("5 chunks of 4 frames"));
  EXPECT_THAT(error_of({"--preroll", "3"}), HasSubstr("nothing lies before the whole sequence"));
  EXPECT_THAT(error_of({"--preroll", "x", "--frames", "3-4"}), HasSubstr("or 'auto'"));
  EXPECT_THAT(error_of({"--chunk", "2/2", "--preroll", "1", "--preroll-tolerance", "0.1"}),
              HasSubstr("a number of frames is given"));
  EXPECT_THAT(error_of({"--preroll-tolerance", "0.1"}), HasSubstr("neither is given"));
  EXPECT_THAT(error_of({"--chunk", "2/2"}, "endless.json"), HasSubstr("give a number with --preroll N"));
  EXPECT_THAT(error_of({"--chunk", "2/2", "--watch"}), HasSubstr("--watch"));
  EXPECT_EQ(list("out").size(), 0U);
}

// A share of 0.5 a frame is gone soon enough for a sequence of twelve frames to show what is left.
TEST_F(Chunk, OfTheRoomDiffersByNoMoreThanTheTolerance) {
  if (!fs::exists(kRoom)) GTEST_SKIP() << "the rendered room is not there: " << kRoom;
  const auto svgf = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words = {
        "run",       "svgf",  kRoom.string(),         "-o",    text(out),           "--type", "float", "--set",
        "alpha=0.5", "--set", "moments.max_length=4", "--set", "blend.max_length=4"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  ASSERT_EQ(svgf("whole", {}).code, 0);
  const Outcome last = svgf("parts", {"--chunk", "4/4"});
  ASSERT_EQ(last.code, 0) << last.err;
  EXPECT_THAT(last.err, HasSubstr("pre-roll of 8 frames, 2-9"));
  const double error = largest_error("parts", "whole");
  RecordProperty("largest_error", std::to_string(error));
  EXPECT_GT(error, 0);
  EXPECT_LE(error, 0.01);
}

}  // namespace
}  // namespace quell::app::testing
