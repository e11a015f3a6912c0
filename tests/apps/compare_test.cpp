// quell compare: figures of images whose difference is known, the table, what is compared with what, and what cannot be.
#include <cmath>
#include <limits>

#include "tests/apps/compare_fixture.h"
#include "tests/core/sequence/test_files.h"

namespace quell::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::string kSample = QUELL_SOURCE_DIR "/graphs/sample";
const std::vector<std::string> kPlain = {"--display", "none"};

class Compare : public CompareTest {
 protected:
  /// Frames 1 and 2: the reference is 0.5, a is 0.6 and 0.7, b 0.4 and 0.5.
  void make_frames() const {
    for (int frame = 1; frame <= 2; ++frame) {
      const std::string end = ".000" + std::to_string(frame) + ".exr";
      make_flat("reference" + end, 0.5);
      make_flat("a" + end, 0.5 + 0.1 * frame);
      make_flat("b" + end, 0.3 + 0.1 * frame);
    }
  }
};

TEST_F(Compare, MeasuresFlatImagesAsTheFormulasSay) {
  make_frames();
  const Json all = compare_json({"reference.####.exr", "a.####.exr"}, {"--display", "none", "--metrics", "all"});
  // Frame 1 differs by 0.1, frame 2 by 0.2; single precision knows 0.6 to 3e-8.
  EXPECT_NEAR(figure(all, "psnr", 0, 0).number, 20, 1e-5);
  EXPECT_NEAR(figure(all, "mse", 0, 0).number, 0.01, 1e-7);
  EXPECT_NEAR(figure(all, "relmse", 0, 0).number, 0.01 / (0.25 + 0.01), 1e-6);
  EXPECT_NEAR(figure(all, "smape", 0, 0).number, 0.1 / (1.1 + 0.01), 1e-6);
  EXPECT_NEAR(figure(all, "mse", 0, 1).number, 0.04, 1e-7);
  EXPECT_NEAR(figure(all, "tpsnr", 0, 1).number, 20, 1e-5) << "a rises by 0.1, the reference stays";
  EXPECT_NEAR(figure(all, "warped", 0, 1).number, 0.1, 1e-6);
  EXPECT_NEAR(figure(all, "mse").number, 0.025, 1e-7) << "every pixel of the sequence counts alike";
  EXPECT_NEAR(figure(all, "psnr").number, -10 * std::log10(0.025), 1e-5) << "not the mean of the decibels";
  EXPECT_EQ(figure(all, "mse", 0, -1, "count").integer, 2 * kWidth * kHeight);
  EXPECT_EQ(figure(all, "tpsnr", 0, 0, "count").integer, 0) << "the first frame has none before it";
  EXPECT_EQ(figure(all, "tpsnr", 0, 0).kind, Json::Kind::null);
  EXPECT_EQ(all.find("compared")->string, "1-2");
}

TEST_F(Compare, PrintsATableWithTheBestOfEachFrameMarked) {
  // All exact in binary: the errors of frame 1 are alike, and those of b in frame 2 are none.
  for (int frame = 1; frame <= 2; ++frame) {
    const std::string end = ".000" + std::to_string(frame) + ".exr";
    make_flat("reference" + end, 0.5);
    make_flat("a" + end, 0.5 + 0.125 * frame);
    make_flat("b" + end, 0.25 + 0.125 * frame);
  }
  const Outcome outcome =
      compare({"reference.####.exr", "a.####.exr", "b.####.exr"}, {"--display", "none", "--metrics", "psnr,mse,tpsnr", "-q"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, "reference  " + text("reference.####.exr") + "\na          " + text("a.####.exr") + "\nb          " +
                             text("b.####.exr") +
                             "\ndisplay    none: the images hold display values already, which are clamped to 0..1\n"
                             "\n"
                             "frame  image  psnr dB       mse   tpsnr dB\n"
                             "               higher     lower     higher\n"
                             "    1  a        18.06   0.01562          -\n"
                             "       b        18.06   0.01562          -\n"
                             "    2  a        12.04   0.06250      18.06\n"
                             "       b          inf*  0.00000*     18.06\n"
                             "  all  a        14.08   0.03906      18.06\n"
                             "       b        21.07*  0.00781*     18.06\n");
}

TEST_F(Compare, OneImageTakesALineAFrameAndNoMarks) {
  make_frames();
  const std::vector<std::string> options = {"--display", "none", "--metrics", "psnr,mse", "-q"};
  const Outcome outcome = compare({"reference.####.exr", "a.####.exr"}, options);
  EXPECT_THAT(outcome.out, HasSubstr("\nframe  psnr dB     mse\n"
                                     "        higher   lower\n"
                                     "    1    20.00  0.0100\n"
                                     "    2    13.98  0.0400\n"
                                     "  all    16.02  0.0250\n"));
  const Outcome summary = compare({"reference.####.exr", "a.####.exr"}, {"--display", "none", "--metrics", "mse", "--summary"});
  EXPECT_THAT(summary.out, HasSubstr("\nframe     mse\n        lower\n  all  0.0250\n"));
}

TEST_F(Compare, TheTableFitsATerminalWhateverTheLabels) {
  make_frames();
  const std::string label(70, 'x');
  const Outcome outcome = compare({"reference.####.exr", label + "=a.####.exr", "b.####.exr"}, {"-q"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream lines(outcome.out.substr(outcome.out.find("\n\n")));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
  EXPECT_THAT(outcome.out, HasSubstr("xxx... "));
}

TEST_F(Compare, EqualImagesHaveAnInfinitePsnr) {
  make_flat("a.exr", 0.5);
  make_flat("b.exr", 0.5);
  const Json all = compare_json({"a.exr", "b.exr"});
  EXPECT_EQ(figure(all, "psnr").kind, Json::Kind::null);
  EXPECT_EQ(figure(all, "psnr", 0, -1, "sum").number, 0);
  EXPECT_EQ(figure(all, "psnr", 0, -1, "count").integer, kWidth * kHeight);
  EXPECT_NEAR(figure(all, "ssim").number, 1, 1e-9);
  EXPECT_EQ(figure(all, "flip").number, 0);
  EXPECT_THAT(compare({"a.exr", "b.exr"}, {"--metrics", "psnr,flip", "--csv", "-", "-q"}).out,
              StartsWith("frame,image,psnr,flip,nonfinite,nonfinite_in_reference\n1,b,inf,0,0,0\nall,b,inf,0,0,0\n"));
}

TEST_F(Compare, TakesReferenceAndColorOfAFolder) {
  make_shot(2);
  for (int frame = 1; frame <= 2; ++frame) add_image("reference", frame, 0.25F);
  const Json all = compare_json({"shot", "shot"});
  EXPECT_EQ(all.find("reference")->string, text("shot/reference.####.exr"));
  EXPECT_EQ(all.find("images")->elements.at(0).find("files")->string, text("shot/color.####.exr"));
  EXPECT_EQ(all.find("images")->elements.at(0).find("label")->string, "shot");
  EXPECT_EQ(compare_json({"shot/color.####.exr", "shot"}).find("reference")->string, text("shot/color.####.exr"));
  make_flat("other/albedo.0001.exr", 1);
  const Outcome outcome = compare({"shot", "other"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr(text("other") + ": has no input 'color'; it has 'albedo'; name the files instead"));
}

TEST_F(Compare, LabelsAreTheShortestNamesThatDiffer) {
  const auto labels = [&](const std::vector<std::string>& images) {
    std::vector<std::string> operands = {"r.exr"};
    operands.insert(operands.end(), images.begin(), images.end());
    std::string found;
    const Json all = compare_json(operands);
    for (const Json& image : all.find("images")->elements) found += image.find("label")->string + " ";
    return found;
  };
  for (const char* name : {"r.exr", "x/color.exr", "y/color.exr", "y/b.exr"}) make_flat(name, 0.5);
  EXPECT_EQ(labels({"x/color.exr", "y/b.exr"}), "color b ");
  EXPECT_EQ(labels({"x/color.exr", "y/color.exr"}), "x y ");
  EXPECT_EQ(labels({"mine=x/color.exr", "y/color.exr"}), "mine color ");
  EXPECT_EQ(labels({"x/color.exr", "x/color.exr"}), "color color-2 ");
  const Outcome twice = compare({"r.exr", "a=x/color.exr", "a=y/color.exr"});
  EXPECT_EQ(twice.code, 2);
  EXPECT_THAT(twice.err, HasSubstr("the label 'a' is given twice; choose another"));
  make_flat("x/reference.exr", 0.5);
  EXPECT_EQ(labels({"x/reference.exr"}), "x ") << "messages speak of the reference by that name";
  EXPECT_EQ(labels({"reference.exr=x/color.exr", "x/reference.exr", "y/b.exr"}), "reference.exr x y ");
  const std::string color = text("x/color.exr");
  EXPECT_THAT(compare({"r.exr"}, {"reference=" + color}).err, HasSubstr("the label 'reference' is that of the first operand"));
  EXPECT_THAT(compare({"r.exr"}, {"..=" + color}).err, HasSubstr("'..' cannot be a label: files are named after it"));
  EXPECT_EQ(compare({"r.exr"}, {"../a=" + color}).code, 3) << "a path, not a label";
}

TEST_F(Compare, TwoSingleFilesAreComparedWhateverTheirNumbers) {
  make_flat("r.0003.exr", 0.5);
  make_flat("a.0008.exr", 0.6);
  const Json all = compare_json({"r.0003.exr", "a.0008.exr"}, {"--display", "none", "--metrics", "psnr"});
  EXPECT_NEAR(figure(all, "psnr").number, 20, 1e-5);
  EXPECT_EQ(all.find("compared")->string, "3");
}

TEST_F(Compare, TellsFramesThatNotAllHave) {
  make_frames();
  make_flat("reference.0003.exr", 0.5);
  const Outcome outcome = compare({"reference.####.exr", "a.####.exr"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err,
              HasSubstr("warning: frame 3 is left out, because files are missing:\n  frame 3, a: " + text("a.0003.exr") + "\n"));
  const Outcome asked = compare({"reference.####.exr", "a.####.exr"}, {"--frames", "2-3"});
  EXPECT_EQ(asked.code, 3);
  EXPECT_THAT(asked.err, HasSubstr("files of the frames asked for are missing:\n  frame 3, a: "));
  make_flat("late.0007.exr", 0.5);
  const Outcome none = compare({"reference.####.exr", "late.####.exr"});
  EXPECT_EQ(none.code, 3);
  EXPECT_THAT(none.err, HasSubstr("there is no frame that all have:\n  reference: 1-3 of "));
  EXPECT_EQ(compare_json({"reference.####.exr", "a.####.exr"}, {"--frames", "2"}).find("compared")->string, "2");
}

TEST_F(Compare, RefusesImagesOfOtherSizesAndNamesBoth) {
  make_flat("r.exr", 0.5);
  make_flat("small.exr", 0.5, 8, 4);
  const Outcome outcome = compare({"r.exr", "small.exr"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr(text("small.exr") + ": has 8 x 4 pixels, but " + text("r.exr") + " has 16 x 12"));
}

TEST_F(Compare, AFrameThatCannotBeReadHarmsNoOther) {
  make_frames();
  make_flat("reference.0003.exr", 0.5);
  make_flat("b.0003.exr", 0.6);
  const std::string whole = read_file(path("b.0003.exr"));
  write_file("a.0003.exr", whole.substr(0, whole.size() / 2));
  const Outcome outcome = compare({"reference.####.exr", "a.####.exr", "b.####.exr"}, {"--json", text("all.json")});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("error: frame 3 (3 of 3) failed: " + text("a.0003.exr")));
  EXPECT_THAT(outcome.err, HasSubstr("error: 1 of 3 frames could not be compared: 3\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  all  a "));
  const Json all = parse(read_file(path("all.json")));
  EXPECT_EQ(all.find("compared")->string, "1-2");
  EXPECT_EQ(all.find("failed")->string, "3");
  EXPECT_THAT(all.find("frames")->elements.at(2).find("error")->string, StartsWith(text("a.0003.exr")));
  EXPECT_EQ(figure(all, "psnr", 1, -1, "count").integer, 2 * kWidth * kHeight) << "of b, too: all images cover the same frames";
}

TEST_F(Compare, PixelsThatAreNotFiniteAreToldAndLeftOut) {
  make_frames();
  std::vector<double> values(kWidth * kHeight, 0.6);
  values[5] = std::numeric_limits<double>::quiet_NaN();
  values[100] = std::numeric_limits<double>::infinity();
  make_image("a.0001.exr", values);
  std::vector<double> reference(kWidth * kHeight, 0.5);
  reference[5] = std::numeric_limits<double>::quiet_NaN();
  make_image("reference.0002.exr", reference);
  const Outcome outcome = compare({"reference.####.exr", "a.####.exr"}, {"--display", "none", "--json", "-"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("warning: a: 2 pixels are NaN or infinite (frame 1) and left out of all figures\n"));
  EXPECT_THAT(outcome.err, HasSubstr("warning: reference: 1 pixel is NaN or infinite (frame 2) and left out of all figures\n"));
  const Json all = parse(outcome.out);
  EXPECT_NEAR(figure(all, "psnr", 0, 0).number, 20, 1e-5);
  EXPECT_EQ(figure(all, "psnr", 0, 0, "count").integer, kWidth * kHeight - 2);
  EXPECT_EQ(all.find("all")->elements.at(0).find("nonfinite")->integer, 2);
  EXPECT_EQ(all.find("frames")->elements.at(1).find("nonfinite_in_reference")->integer, 1);
}

TEST_F(Compare, MotionTellsFlickerFromMovement) {
  // Stripes of a period of four pixels, which move by two: without motion, every pixel changes by 0.6.
  for (int frame = 1; frame <= 2; ++frame) {
    std::vector<double> stripes;
    for (int i = 0; i < kWidth * kHeight; ++i) stripes.push_back((i % kWidth + 2 * frame) % 4 < 2 ? 0.2 : 0.8);
    const std::string end = ".000" + std::to_string(frame) + ".exr";
    make_image("shot/color" + end, stripes);
    make_flat("shot/reference" + end, 0.5);
    make_motion("shot/motion" + end);
  }
  const std::vector<std::string> options = {"--display", "none", "--metrics", "warped"};
  const Json still = compare_json({"shot/reference.####.exr", "shot/color.####.exr"}, options);
  EXPECT_NEAR(figure(still, "warped").number, 0.6, 1e-6);
  const Json moving = compare_json({"shot", "shot"}, options);
  EXPECT_NEAR(figure(moving, "warped").number, 0, 1e-6);
  std::vector<std::string> with_motion = options;
  with_motion.insert(with_motion.end(), {"--motion", text("shot/motion.####.exr"), "-q"});
  const Outcome outcome = compare({"shot/reference.####.exr", "shot/color.####.exr"}, with_motion);
  EXPECT_THAT(outcome.out, HasSubstr("\nmotion     " + text("shot/motion.####.exr") + "\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  all  0.0000\n"));
  EXPECT_THAT(compare({"shot/reference.####.exr", "shot/color.####.exr"}, {"--metrics", "warped", "-q"}).out,
              HasSubstr("\nmotion     none given: warped takes pixels to stand still\n"));
}

TEST_F(Compare, LacksMotionOnlyWhereItHasNoFile) {
  make_frames();
  make_flat("reference.0003.exr", 0.5);
  write_file("a.0003.exr", "nothing");
  make_motion("motion.0001.exr");
  const Outcome outcome = compare({"reference.####.exr", "a.####.exr"}, {"--motion", text("motion.####.exr"), "-q"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err,
              HasSubstr("warped is not told where there is no motion: " + text("motion.####.exr") + " has no file for 2\n"))
      << "frame 3 failed for another reason";
}

TEST_F(Compare, RefusesMotionThatDoesNotFitBeforeItMeasures) {
  make_frames();
  make_flat("still.0001.exr", 0);
  const Outcome outcome = compare({"reference.####.exr", "a.####.exr"}, {"--motion", text("still.####.exr")});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr(text("still.0001.exr") + ": found 3 channels (R,G,B), but motion needs 2 channels"));
}

TEST_F(Compare, NamesTheLayerThatIsCompared) {
  test::ExrContent content{.width = kWidth, .height = kHeight};
  for (const char* channel : {"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"}) content.channels.emplace_back(channel);
  content.pixels.assign(std::size_t{kWidth} * kHeight * 6, 0.5);
  test::make_exr(path("layers.exr"), content);
  const Json all = compare_json({"layers.exr:a", "layers.exr:b"});
  EXPECT_EQ(all.find("reference")->string, text("layers.exr") + ":a");
  EXPECT_EQ(all.find("images")->elements.at(0).find("files")->string, text("layers.exr") + ":b");
  EXPECT_EQ(all.find("images")->elements.at(0).find("label")->string, "b");
}

TEST_F(Compare, PicturesOfADisplayAreComparedAsTheyStand) {
  // 8 bit numbers 100 and 120, by the curve of sRGB.
  const auto linear = [](double byte) { return std::pow((byte / 255 + 0.055) / 1.055, 2.4); };
  make_png("r.png", linear(100));
  make_png("a.png", linear(120));
  const Outcome outcome = compare({"r.png", "a.png"}, {"--metrics", "mse", "--csv", "-"});
  EXPECT_THAT(outcome.err, HasSubstr("--display srgb is taken, because " + text("r.png") + " holds what a display shows\n"));
  const double mse = std::stod(outcome.out.substr(outcome.out.find("all,a,") + 6));
  EXPECT_NEAR(mse, 20.0 / 255 * 20 / 255, 1e-6);
  EXPECT_THAT(compare({"r.png", "a.png"}, kPlain).err, HasSubstr("warning: --display none: the sRGB curve of "));
}

TEST_F(Compare, ExposuresOfHdrFlipAreFixedForAllFrames) {
  make_frames();
  make_flat("reference.0002.exr", 8);
  const Outcome chosen = compare({"reference.####.exr", "a.####.exr"}, {"--metrics", "hdrflip", "-q"});
  EXPECT_THAT(chosen.out, HasSubstr("\nexposures  "));
  const Outcome one = compare({"reference.0001.exr", "a.0001.exr"}, {"--metrics", "hdrflip", "-q"});
  EXPECT_NE(chosen.out.substr(chosen.out.find("exposures"), 60), one.out.substr(one.out.find("exposures"), 60));
  EXPECT_THAT(compare({"reference.####.exr", "a.####.exr"}, {"--metrics", "hdrflip", "--exposures", "-2,4", "-q"}).out,
              HasSubstr("\nexposures  -2.00 to 4.00 stops, 6 in all\n"));
  const Json given = compare_json({"reference.####.exr", "a.####.exr"}, {"--metrics", "hdrflip", "--exposures", "-1,2.5,9"});
  EXPECT_EQ(given.find("settings")->find("exposures")->find("count")->integer, 9);
  EXPECT_EQ(given.find("settings")->find("exposures")->find("stop")->number, 2.5);
  EXPECT_THAT(compare({"reference.####.exr", "a.####.exr"}, {"--metrics", "mse", "--exposures", "-2,4"}).err,
              HasSubstr("warning: --exposures has no effect: it is for hdrflip, which is not measured; add it to --metrics\n"));
  for (const char* wrong : {"1", "4,-2", "1,2,0", "a,2", "1,nan", "-101,2", "1,2,201"})
    EXPECT_EQ(compare({"reference.####.exr", "a.####.exr"}, {"--exposures", wrong}).code, 2) << wrong;
}

TEST_F(Compare, ExplainsWhatIsNotThere) {
  make_flat("r.exr", 0.5);
  const Outcome nowhere = compare({"nowhere.exr", "r.exr"});
  EXPECT_EQ(nowhere.code, 3);
  EXPECT_THAT(nowhere.err, HasSubstr(text("nowhere.exr") + ": there is no such file or folder"));
  EXPECT_EQ(compare({"none.####.exr", "r.exr"}).err, "error: " + text("none.####.exr") + ": there is no file of this name\n");
  EXPECT_THAT(quell({"compare", text("r.exr")}).err, HasSubstr("IMAGES is missing"));
  const Outcome metric = compare({"r.exr", "r.exr"}, {"--metrics", "psnr,filp"});
  EXPECT_EQ(metric.code, 2);
  EXPECT_THAT(metric.err, HasSubstr("--metrics: there is no metric 'filp'; did you mean 'flip'?"));
  EXPECT_EQ(compare({"r.exr", "r.exr"}, {"--pixels-per-degree", "0"}).code, 2);
  EXPECT_THAT(compare({"r.exr:layr=x", "r.exr"}).err, HasSubstr(text("r.exr:layr=x") + ": there is no setting 'layr'"));
}

TEST_F(Compare, FiguresAreTheSameForAnyNumberOfThreads) {
  const auto run = [&](const char* threads) {
    return compare({kSample, kSample, kSample + "/albedo.####.exr"},
                   {"--frames", "1-2", "--metrics", "all", "--json", "-", "-q", "--threads", threads});
  };
  const Outcome one = run("1");
  EXPECT_EQ(one.code, 0) << one.err;
  for (const char* threads : {"2", "5"}) EXPECT_EQ(run(threads).out, one.out) << threads;
}

}  // namespace
}  // namespace quell::app::testing
