// quell run --reference: figures beside the frames, which are those that `quell compare` finds in the files.
#include <cmath>
#include <csignal>
#include <map>
#include <sstream>

#include "tests/apps/compare_fixture.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kSample = QUELL_SOURCE_DIR "/graphs/sample";

class RunReference : public CompareTest {
 protected:
  /// Frames whose color is (1/4, frame, 8); the reference is 1/4 + 1/16 in frame 1, and so on.
  void make_referenced_shot(int count) {
    make_shot(count);
    for (int frame = 1; frame <= count; ++frame) add_image("reference", frame, 0.25F + 0.0625F * static_cast<float>(frame));
  }
  Outcome run_small(std::vector<std::string> options, const std::string& params = "{}") {
    std::vector<std::string> arguments = {"run", make_graph(params), text("shot"), "-o", text("out"), "--type", "float"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  }
  std::vector<Json> events(const char* kind) const {
    std::vector<Json> found;
    std::istringstream log(read_file(path("run.log")));
    for (std::string line; std::getline(log, line);)
      if (Json event = parse(line); event.find("event")->string == kind) found.push_back(std::move(event));
    return found;
  }
};

TEST_F(RunReference, TellsTheFiguresThatCompareFinds) {
  make_referenced_shot(3);
  const std::vector<std::string> metrics = {"--metrics", "all"};
  std::vector<std::string> options = {"--reference", "reference", "--log-json", text("run.log")};
  options.insert(options.end(), metrics.begin(), metrics.end());
  const Outcome outcome = run_small(options, R"({ "gain": 0.5 })");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json all = compare_json({"shot", "out"}, metrics);
  const std::vector<Json> frames = events("frame");
  ASSERT_EQ(frames.size(), 3U);
  for (const char* metric : {"psnr", "ssim", "mse", "relmse", "smape", "flip", "hdrflip", "tpsnr", "warped"}) {
    for (int frame = 0; frame < 3; ++frame) {
      const Json& here = *frames[static_cast<std::size_t>(frame)].find("figures")->find("color")->find(metric);
      const Json& there = figure(all, metric, 0, frame);
      ASSERT_EQ(here.kind == Json::Kind::null, there.kind == Json::Kind::null) << metric << frame;
      EXPECT_NEAR(here.number, there.number, 1e-8 * std::max(1.0, std::abs(there.number))) << metric << frame;
    }
    EXPECT_NEAR(events("end")[0].find("figures")->find("color")->find(metric)->number, figure(all, metric).number,
                1e-8 * std::max(1.0, std::abs(figure(all, metric).number)))
        << metric;
  }
}

TEST_F(RunReference, PrintsThemBesideEachFrameAndAtTheEnd) {
  make_referenced_shot(2);
  // Red alone: green and blue would be clamped by the display.
  for (int frame = 1; frame <= 2; ++frame) add_image("color", frame, 0.5F);
  for (int frame = 1; frame <= 2; ++frame) add_image("reference", frame, 0.25F);
  const Outcome outcome = run_small({"--reference", "reference", "--display", "none", "--metrics", "psnr,mse"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, ::testing::ContainsRegex("\nframe 1 \\(1 of 2\\): [0-9.]+ s  color: psnr 12.04 dB  mse 0.0625\n"));
  EXPECT_THAT(outcome.err, HasSubstr("\ncompared with " + text("shot/reference.####.exr") +
                                     ", frames 1-2\n  color: psnr 12.04 dB  mse 0.0625\n"));
}

TEST_F(RunReference, DoesNotChangeWhatIsWritten) {
  make_referenced_shot(4);
  EXPECT_EQ(run_small({}).code, 0);
  const auto without = contents("out");
  std::map<std::string, std::string> logs;
  for (const char* threads : {"1", "4"}) {
    EXPECT_EQ(run_small({"--reference", "reference", "--threads", threads, "--log-json", text("run.log")}).code, 0);
    EXPECT_EQ(contents("out"), without);
    for (const Json& frame : events("frame"))
      logs[threads] += std::to_string(frame.find("figures")->find("color")->find("flip")->number) + " " +
                       std::to_string(frame.find("figures")->find("color")->find("tpsnr")->number) + "\n";
  }
  EXPECT_EQ(logs["1"], logs["4"]);
}

TEST_F(RunReference, FramesWithoutAReferenceHaveNoFigures) {
  make_referenced_shot(3);
  std::filesystem::remove(path("shot/reference.0002.exr"));
  const Outcome outcome = run_small({"--reference", "reference", "--log-json", text("run.log")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning: --reference: " + text("shot/reference.####.exr") +
                                     " has no file for 2, which will have no figures\n"));
  EXPECT_THAT(outcome.err, HasSubstr(", frames 1,3\n"));
  const std::vector<Json> frames = events("frame");
  EXPECT_NE(frames[0].find("figures"), nullptr);
  EXPECT_EQ(frames[1].find("figures"), nullptr);
}

TEST_F(RunReference, MayLackTheFirstOfTheFramesThatAreAskedFor) {
  make_referenced_shot(3);
  std::filesystem::remove(path("shot/reference.0001.exr"));
  const Outcome outcome = run_small({"--reference", "reference", "--frames", "1-3"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(", frames 2-3\n"));
}

TEST_F(RunReference, OfAFrameThatFailedIsNotCounted) {
  make_referenced_shot(3);
  const Outcome outcome = run_small({"--reference", "reference"}, R"({ "at": [2] })");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr(", frames 1,3\n"));
}

TEST_F(RunReference, WhoseSizeDiffersIsToldOnce) {
  make_shot(2);
  for (int frame = 1; frame <= 2; ++frame) make_flat("big/reference.000" + std::to_string(frame) + ".exr", 0.5, 32, 16);
  const Outcome outcome = run_small({"--reference", text("big/reference.####.exr")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string warning =
      "warning: no figures of color, which has 16 x 8 pixels, while " + text("big/reference.####.exr") + " has 32 x 16 pixels\n";
  EXPECT_THAT(outcome.err, HasSubstr(warning));
  EXPECT_EQ(outcome.err.find(warning), outcome.err.rfind(warning));
}

TEST_F(RunReference, IsToldByADryRun) {
  make_referenced_shot(2);
  const Outcome outcome = run_small({"--reference", "reference", "--dry-run", "-q"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("\nwould compare 'color' with " + text("shot/reference.####.exr") + ": psnr, ssim, flip and tpsnr\n"));
}

TEST_F(RunReference, IsMeasuredAnewWhenTheGraphIsSaved) {
  make_referenced_shot(2);
  Program program({"run", make_graph(R"({ "gain": 0.5 })"), text("shot"), "-o", text("out"), "--watch", "--reference",
                   "reference", "--plugin-path", TEST_PLUGINS});
  ASSERT_TRUE(program.wait_for_error_text("\nwaiting for "));
  make_graph(R"({ "gain": 0.25 })");
  ASSERT_TRUE(program.wait_for_error_text("\nscale: 2 of 2 frames\n"));
  ASSERT_TRUE(program.wait_for_error_text("2 of 2 frames done"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_NE(outcome.err.find("frame 2 (2 of 2)"), outcome.err.rfind("frame 2 (2 of 2)"));
  const auto last = outcome.err.rfind("  color: psnr ");
  EXPECT_NE(outcome.err.substr(last, 23), outcome.err.substr(outcome.err.find("  color: psnr "), 23)) << outcome.err;
}

TEST_F(RunReference, OfASingleFrameMayBeASingleFileOfAnyNumber) {
  make_referenced_shot(2);
  const Outcome outcome = run_small({"--reference", text("shot/reference.0002.exr"), "--frames", "1"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("\ncompared with " + text("shot/reference.0002.exr") + ", frame 1\n"));
}

TEST_F(RunReference, ExplainsWhatCannotBe) {
  make_referenced_shot(3);
  const Outcome name = run_small({"--reference", "refrence"});
  EXPECT_EQ(name.code, 3);
  EXPECT_THAT(name.err, HasSubstr("--reference: the sequence has no input 'refrence'; did you mean 'reference'?"));
  const Outcome alone = run_small({"--metrics", "psnr"});
  EXPECT_EQ(alone.code, 2);
  EXPECT_THAT(alone.err, HasSubstr("--metrics: there is nothing to be measured; add --reference NAME"));
  const Outcome empty = run_small({"--reference", ""});
  EXPECT_EQ(empty.code, 2);
  EXPECT_THAT(empty.err, HasSubstr("--reference: the name is empty; "));
  const Outcome single = run_small({"--reference", text("shot/reference.0002.exr"), "--frames", "1,3"});
  EXPECT_EQ(single.code, 3);
  EXPECT_THAT(single.err, HasSubstr("reference.0002.exr is a single file, of frame 2, and the run has frames 1,3; "));
  EXPECT_EQ(run_small({}).code, 0);
  const Outcome itself = run_small({"--reference", text("out/color.####.exr")});
  EXPECT_EQ(itself.code, 2);
  EXPECT_THAT(itself.err, HasSubstr("which is the reference; choose another folder"));
}

}  // namespace
}  // namespace quell::app::testing
