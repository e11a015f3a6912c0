// quell compare: bars that figures must keep, files, maps and pictures, and signals.
#include <csignal>

#include "comparison_run.h"
#include "tests/apps/compare_fixture.h"
#include "tests/core/sequence/test_files.h"

namespace quell::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class CompareBars : public CompareTest {
 protected:
  /// Frames 1 and 2 have the errors 0.1 and 0.2, so that the PSNR is 20 and 13.98 dB, and 16.02 in all.
  Outcome judge(std::vector<std::string> bars) const {
    for (int frame = 1; frame <= 2; ++frame) {
      make_flat("r.000" + std::to_string(frame) + ".exr", 0.5);
      make_flat("a.000" + std::to_string(frame) + ".exr", 0.5 + 0.1 * frame);
    }
    bars.insert(bars.end(), {"-q", "--display", "none"});
    return compare({"r.####.exr", "a.####.exr"}, bars);
  }
};

TEST_F(CompareBars, AreForTheFiguresOfAllFrames) {
  EXPECT_EQ(judge({"--fail-below", "psnr=16"}).code, 0);
  const Outcome outcome = judge({"--fail-below", "psnr=17", "--fail-above", "mse=0.02", "--fail-above", "smape=0.9"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.err,
            "error: a: mse is 0.025, above 0.02 (--fail-above mse=0.02)\n"
            "error: a: psnr is 16.0206, below 17 (--fail-below psnr=17)\n");
  EXPECT_THAT(outcome.out, HasSubstr(" mse")) << "what has a bar is measured, and shown";
}

TEST_F(CompareBars, AreForEachFrameWhenAsked) {
  EXPECT_EQ(judge({"--fail-below", "psnr=15"}).code, 0);
  const Outcome outcome = judge({"--fail-below", "psnr=15", "--each-frame"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.err, "error: a, frame 2: psnr is 13.9794, below 15 (--fail-below psnr=15)\n");
  EXPECT_EQ(judge({"--fail-below", "tpsnr=19", "--each-frame"}).code, 0) << "the first frame has nothing before it";
  EXPECT_THAT(judge({"--each-frame"}).err, HasSubstr("--each-frame: there is no bar to be kept"));
}

TEST_F(CompareBars, AreNotKeptByFiguresThatCannotBeTold) {
  make_flat("r.exr", 0.5);
  const Outcome outcome = compare({"r.exr", "r.exr"}, {"--fail-below", "tpsnr=1", "-q"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.err, "error: r: tpsnr could not be told (--fail-below tpsnr=1)\n");
  EXPECT_EQ(compare({"r.exr", "r.exr"}, {"--fail-below", "psnr=100", "-q"}).code, 0) << "infinite is above every bar";
}

TEST_F(CompareBars, CountPixelsThatAreNotFinite) {
  make_flat("r.exr", 0.5);
  std::vector<double> values(kWidth * kHeight, 0.5);
  values[7] = std::numeric_limits<double>::infinity();
  make_image("a.exr", values);
  const Outcome outcome = compare({"r.exr", "a.exr"}, {"--fail-above", "nonfinite=0"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("error: a: nonfinite is 1, above 0 (--fail-above nonfinite=0)\n"));
  EXPECT_EQ(compare({"r.exr", "r.exr"}, {"--fail-above", "nonfinite=0"}).code, 0);
}

TEST_F(CompareBars, InTheOddDirectionAreDoubted) {
  const Outcome outcome = judge({"--fail-above", "psnr=10"});
  EXPECT_EQ(outcome.code, 1) << "what was asked for is done";
  EXPECT_THAT(outcome.err, StartsWith("warning: --fail-above psnr=10: of psnr, higher is better, so that good images fail; "
                                      "--fail-below fails the others\n"));
}

TEST_F(CompareBars, AreExplainedWhenTheyAreWrong) {
  EXPECT_THAT(judge({"--fail-above", "flip"}).err, HasSubstr("--fail-above: 'flip' is not NAME=VALUE, such as flip=0.1"));
  EXPECT_THAT(judge({"--fail-above", "flop=1"}).err, HasSubstr("--fail-above: there is no metric 'flop'"));
  EXPECT_THAT(judge({"--fail-below", "psnr=high"}).err, HasSubstr("--fail-below: 'high' is not a number\n"));
  EXPECT_EQ(judge({"--fail-below", "psnr=nan"}).code, 2);
}

class CompareFiles : public CompareTest {
 protected:
  void make_pair() const {
    make_flat("r.0004.exr", 0);
    make_flat("white.0004.exr", 1);
    make_flat("black.0004.exr", 0);
  }
};

TEST_F(CompareFiles, HoldTheSameFiguresAsText) {
  make_pair();
  const Outcome outcome =
      compare({"r.####.exr", "white.####.exr", "a,b=black.####.exr"},
              {"--metrics", "mse", "--display", "none", "--json", text("all.json"), "--csv", text("all.csv"), "-q"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(
      read_file(path("all.csv")),
      "frame,image,mse,nonfinite,nonfinite_in_reference\n4,white,1,0,0\n4,\"a,b\",0,0,0\nall,white,1,0,0\nall,\"a,b\",0,0,0\n");
  const Json all = parse(read_file(path("all.json")));
  EXPECT_EQ(all.find("quell_compare")->integer, 1);
  EXPECT_EQ(all.find("images")->elements.at(1).find("label")->string, "a,b");
  EXPECT_EQ(all.find("settings")->find("display")->string, "none");
  EXPECT_EQ(all.find("frames")->elements.at(0).find("frame")->integer, 4);
  EXPECT_EQ(figure(all, "mse", 0).number, 1);
  EXPECT_EQ(compare({"r.####.exr", "white.####.exr"}, {"--json", text("all.json"), "--csv", text("all.csv"), "-q"}).code, 0)
      << "replaces its own";
}

TEST_F(CompareFiles, ReplaceNothingElse) {
  make_pair();
  write_file("mine.txt", "mine");
  for (const char* option : {"--json", "--csv"}) {
    const Outcome outcome = compare({"r.####.exr", "white.####.exr"}, {option, text("mine.txt")});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(std::string(option) + ": " + text("mine.txt") + " is there, and was not written by this"));
  }
  EXPECT_EQ(read_file(path("mine.txt")), "mine");
  EXPECT_EQ(compare({"r.####.exr", "white.####.exr"}, {"--json", "-", "--csv", "-"}).code, 2);
  EXPECT_EQ(compare({"r.####.exr", "white.####.exr"}, {"--json", text("nowhere/all.json")}).code, 2);
}

TEST_F(CompareFiles, MapsShowErrorsInTheColorsOfFlip) {
  make_pair();
  const Outcome outcome = compare({"r.####.exr", "white.####.exr", "black.####.exr"},
                                  {"--display", "none", "--metrics", "flip,hdrflip", "--maps", text("maps"), "-q"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(list("maps"),
              ElementsAre("black.flip.0004.png", "black.hdrflip.0004.png", "white.flip.0004.png", "white.hdrflip.0004.png"));
  const test::ExrRead same = test::load_exr(path("maps/black.flip.0004.png"));
  EXPECT_EQ(same.width, kWidth);
  for (const float value : same.pixels) EXPECT_LE(value, 4.5F / 255) << "the map's color of no error is nearly black";
  // Black and white have the error 0.97: the map's last colors are a pale yellow.
  const test::ExrRead different = test::load_exr(path("maps/white.flip.0004.png"));
  for (std::size_t i = 0; i < different.pixels.size(); i += 3) {
    ASSERT_GT(different.pixels[i], 0.95F);
    ASSERT_GT(different.pixels[i + 1], 0.85F);
    ASSERT_NEAR(different.pixels[i + 2], 0.67F, 0.08F);
  }
}

TEST_F(CompareFiles, MapsReplaceNoImageAndNeedErrors) {
  make_pair();
  make_png("white.flip.0004.png", 1);
  const std::string before = read_file(path("white.flip.0004.png"));
  const Outcome outcome = compare({"white.flip.####.png", "white.####.exr"}, {"--maps", text(".")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--maps: would replace "));
  EXPECT_EQ(read_file(path("white.flip.0004.png")), before);
  EXPECT_THAT(compare({"r.####.exr", "white.####.exr"}, {"--metrics", "psnr", "--maps", text("maps")}).err,
              HasSubstr("--maps: draws the errors of flip or hdrflip; add one of them to --metrics"));
  EXPECT_FALSE(fs::exists(path("maps")));
}

TEST_F(CompareFiles, ReplaceNoFrameThatIsNotCompared) {
  for (const char* name : {"r.0001.png", "r.0002.png", "a.0001.png", "a.0002.png"}) make_png(name, 0.5);
  const std::string before = read_file(path("a.0002.png"));
  const Outcome outcome = compare({"r.####.png", "a.####.png"}, {"--frames", "1", "--picture", text("a.0002.png")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--picture: would replace " + text("a.0002.png") + ", which is one of the images"));
  EXPECT_EQ(read_file(path("a.0002.png")), before);
}

TEST_F(CompareFiles, ReplaceNotEachOther) {
  make_pair();
  const auto error_of = [&](const std::vector<std::string>& options) {
    const Outcome outcome = compare({"r.####.exr", "white.####.exr"}, options);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "") << "nothing was measured";
    return outcome.err;
  };
  const std::string map = "maps/white.flip.0004.png";
  EXPECT_THAT(error_of({"--json", text("all.txt"), "--csv", text("./all.txt")}),
              HasSubstr("--csv: " + text("./all.txt") + " is written by --json, too; choose another name"));
  EXPECT_THAT(error_of({"--maps", text("maps"), "--picture", text(map)}), HasSubstr("is written by --maps, too"));
  EXPECT_THAT(error_of({"--picture", text("a.png"), "--json", text("a.png")}), HasSubstr("is written by --json, too"));
}

TEST_F(CompareFiles, HaveAPlaceBeforeAnythingIsMeasured) {
  make_pair();
  for (const char* option : {"--json", "--csv", "--picture"}) {
    const Outcome nowhere = compare({"r.####.exr", "white.####.exr"}, {option, text("nowhere/a.png")});
    EXPECT_EQ(nowhere.code, 2);
    EXPECT_EQ(nowhere.err, "error: " + std::string(option) + ": there is no folder " + text("nowhere") + "; make it first\n");
  }
  fs::create_directory(path("folder.png"));
  EXPECT_THAT(compare({"r.####.exr", "white.####.exr"}, {"--picture", text("folder.png")}).err,
              HasSubstr("--picture: " + text("folder.png") + " is not a file; choose another name"));
  EXPECT_THAT(compare({"r.####.exr", "white.####.exr"}, {"--maps", ""}).err, HasSubstr("--maps: the name is empty"));
}

TEST_F(CompareFiles, APictureShowsTheWorstFrame) {
  make_pair();
  make_flat("r.0005.exr", 0);
  make_flat("white.0005.exr", 0);
  EXPECT_EQ(compare({"r.####.exr", "white.####.exr"}, {"--picture", text("worst.png"), "-q"}).code, 0);
  EXPECT_THAT(read_file(path("worst.png")), StartsWith("\x89PNG"));
  const test::ExrRead sheet = test::load_exr(path("worst.png"));
  std::size_t white = 0;
  for (std::size_t i = 0; i < sheet.pixels.size(); i += 3) white += sheet.pixels[i] > 0.7F && sheet.pixels[i + 2] > 0.7F ? 1 : 0;
  EXPECT_GT(white, 400U * 300U / 2) << "frame 4, whose image is white";
  EXPECT_EQ(compare({"r.####.exr", "white.####.exr"}, {"--picture", text("worst.txt")}).code, 2);
  make_png("r.png", 0.5);
  EXPECT_THAT(compare({"r.png", "r.png"}, {"--picture", text("r.png")}).err, HasSubstr("--picture: would replace "));
}

TEST_F(CompareFiles, AreNotLeftHalfWritten) {
  make_pair();
  compare({"r.####.exr", "white.####.exr"}, {"--maps", text("out"), "--picture", text("out/p.png"), "--json", text("out/a.json"),
                                             "--csv", text("out/a.csv"), "-q"});
  EXPECT_THAT(list("out"), ElementsAre("a.csv", "a.json", "p.png", "white.flip.0004.png"));
}

class CompareInterrupted : public CompareTest {};

TEST_F(CompareInterrupted, EndsAfterTheFrameInWork) {
  for (int frame = 1; frame <= 5; ++frame) {
    make_flat("r.000" + std::to_string(frame) + ".exr", 0.5);
    make_flat("a.000" + std::to_string(frame) + ".exr", 0.6);
  }
  ComparisonJob job{ImageSeries::open(text("r.####.exr"), SeriesRole::reference),
                    {ImageSeries::open(text("a.####.exr"), SeriesRole::image)},
                    {"a"},
                    {},
                    {1, 2, 3, 4, 5},
                    {.metrics = {Metric::psnr}, .display = DisplayTransform::none}};
  for (const int threads : {1, 3}) {
    Executor executor(threads);
    int told = 0;
    ComparisonHooks hooks;
    hooks.cancelled = [&] { return told == 2; };
    hooks.on_frame = [&](const ComparedFrame&, const FramePictures*) { ++told; };
    const std::vector<ComparedFrame> frames = run_comparison(job, executor, hooks);
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_NEAR(value(Metric::psnr, add_up(frames, 1, 1)[0].scores[0]), 20, 1e-5);
  }
}

TEST_F(CompareInterrupted, TellsWhatWasCompared) {
  make_flat("image.exr", 0.5, 256, 256);
  constexpr int kFrames = 2000;
  for (int frame = 1; frame <= kFrames; ++frame) {
    std::string number = std::to_string(frame);
    number.insert(0, 4 - number.size(), '0');
    for (const char* name : {"r.", "a."}) fs::create_hard_link(path("image.exr"), path(name + number + ".exr"));
  }
  Program program({"compare", text("r.####.exr"), text("a.####.exr"), "--json", text("all.json")});
  ASSERT_TRUE(program.wait_for_error_text("\nframe 2 (2 of 2000)"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.code, 75);
  EXPECT_THAT(outcome.err, HasSubstr("error: interrupted; frames compared: 1-"));
  EXPECT_THAT(outcome.err, HasSubstr("-2000\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  all "));
  EXPECT_THAT(parse(read_file(path("all.json"))).find("not_reached")->string, HasSubstr("-2000"));
}

}  // namespace
}  // namespace quell::app::testing
