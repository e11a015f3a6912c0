// quell inspect: what is right passes, what is read wrongly is caught, and the option shown mends it.
#include <gmock/gmock.h>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::string kSample = QUELL_SOURCE_DIR "/graphs/sample";
const std::string kData = QUELL_SOURCE_DIR "/../shared/data";

/// The words after "try" in the output: an option that the program suggests, as a shell would split it.
std::vector<std::string> suggested(const std::string& out) {
  const std::size_t at = out.find("try --in ");
  if (at == std::string::npos) return {};
  std::string value = out.substr(at + 9, out.find('\n', at) - at - 9);
  if (value.starts_with('\'')) value = value.substr(1, value.size() - 2);
  return {"--in", value};
}

class Inspect : public RunnerTest {
 protected:
  /// quell inspect ARGUMENTS -q, without the tests' passes.
  static Outcome inspect(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "inspect");
    arguments.emplace_back("-q");
    return quell(arguments);
  }
};

TEST_F(Inspect, RefusesFramesOfWhichThereIsNoFile) {
  const Outcome outcome = inspect({kSample, "--frames", "98-99"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("--frames: no input has a file of the frames 98-99; see the list above\n"));
}

TEST_F(Inspect, FindsNothingWrongWithTheSample) {
  const Outcome outcome = inspect({kSample});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("tested in frames 1-3,5, the figures are of the worst:\n"));
  for (const char* subject :
       {"positions land on their pixels", "depth agrees with positions", "motion agrees with the matrices", "normals are unit",
        "normals stand on the surfaces", "ids are objects", "sizes agree", "numbers are finite", "files are complete"})
    EXPECT_THAT(outcome.out, HasSubstr(std::string("  ok          ") + subject)) << subject;
  EXPECT_THAT(outcome.out, HasSubstr("\nnothing is wrong"));
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Inspect, CatchesAWrongGuessAndTheOptionShownMendsIt) {
  const std::string files = kSample + "/";
  const std::vector<std::string> guesses = {"motion=" + files + "motion.####.exr:sign=current-previous",
                                            "motion=" + files + "motion.####.exr:y=up",
                                            "motion=" + files + "motion.####.exr:unit=uv",
                                            "depth=" + files + "depth.####.exr:depth=ray",
                                            "depth=" + files + "depth.####.exr:depth=reciprocal",
                                            "normal=" + files + "normal.####.exr:space=camera",
                                            "normal=" + files + "normal.####.exr:encoding=unsigned",
                                            "position=" + files + "position.####.exr:space=camera"};
  for (const std::string& guess : guesses) {
    SCOPED_TRACE(guess);
    const Outcome wrong = inspect({kSample, "--frames", "2", "--in", guess});
    EXPECT_EQ(wrong.code, 1) << wrong.out;
    EXPECT_THAT(wrong.out, HasSubstr("\n  WRONG  "));
    const std::vector<std::string> option = suggested(wrong.out);
    ASSERT_EQ(option.size(), 2U) << wrong.out;
    const Outcome mended = inspect({kSample, "--frames", "2", option[0], option[1]});
    EXPECT_EQ(mended.code, 0) << option[1] << "\n" << mended.out << mended.err;
    EXPECT_THAT(mended.out, Not(HasSubstr("WRONG")));
  }
}

TEST_F(Inspect, NamesTheSettingThatMendsTheSign) {
  const Outcome outcome =
      inspect({kSample, "--frames", "2-3", "--in", "motion=" + kSample + "/motion.####.exr:sign=current-previous"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr(":sign=previous-current"));
  EXPECT_THAT(outcome.out, HasSubstr("\n1 is wrong"));
}

TEST_F(Inspect, TellsWhatIsInAFile) {
  make_shot(1);
  const Outcome outcome = inspect({text("shot/color.0001.exr")});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith(text("shot/color.0001.exr") + ": openexr, 16 x 8, 3 channels\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\n    R  float   0.25 to 0.25, mean 0.25\n    G  float   1 to 1, mean 1\n"));
  EXPECT_THAT(outcome.out, HasSubstr("recognized as\n  color       R,G,B"));
}

TEST_F(Inspect, CountsNanAndInfinity) {
  make_shot(1);
  add_image("albedo", 1, std::numeric_limits<float>::quiet_NaN());
  const Outcome outcome = inspect({text("shot")});
  EXPECT_EQ(outcome.code, 0) << "a run replaces them";
  EXPECT_THAT(outcome.out, HasSubstr("suspicious  numbers are finite: albedo: 128 NaN in plane 1"));
}

TEST_F(Inspect, TellsFilesThatAreMissing) {
  make_shot(4);
  fs::remove(path("shot/color.0002.exr"));
  for (int frame = 1; frame <= 4; ++frame) add_image("albedo", frame, 0.5F);
  const Outcome outcome = inspect({text("shot")});
  EXPECT_THAT(outcome.out, HasSubstr("suspicious  files are complete: missing are color of frame 2"));
}

TEST_F(Inspect, TellsADamagedFileAndGoesOn) {
  make_shot(2);
  const std::string bytes = read_file(path("shot/color.0002.exr"));
  write_file("shot/color.0002.exr", bytes.substr(0, bytes.size() / 2));
  const Outcome outcome = inspect({text("shot")});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("WRONG       color can be read:"));
  EXPECT_THAT(outcome.out, HasSubstr("color is radiance"));
}

TEST_F(Inspect, DrawsAPictureAndWritesJson) {
  make_shot(1);
  EXPECT_THAT(inspect({text("shot"), "--picture", text("sheet.txt")}).err, HasSubstr("let it end in .png"));
  write_file("theirs.png", "not a picture");
  EXPECT_EQ(inspect({text("shot"), "--picture", text("theirs.png")}).code, 2);
  EXPECT_EQ(read_file(path("theirs.png")), "not a picture");
  const Outcome outcome = inspect({text("shot"), "--picture", text("sheet.png"), "--json", text("verdicts.json")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(read_file(path("sheet.png")), StartsWith("\x89PNG"));
  const std::string json = read_file(path("verdicts.json"));
  EXPECT_THAT(json, StartsWith("{\"sequence\":"));
  EXPECT_THAT(json, HasSubstr("\"subject\":\"color is radiance\",\"verdict\":\"ok\""));
  EXPECT_THAT(json, HasSubstr("\"figures\":{\"negative_share\":0,"));
  EXPECT_EQ(list(".").size(), 4U) << "shot, theirs.png, sheet.png and verdicts.json: nothing half-written";
  EXPECT_EQ(inspect({text("shot"), "--picture", text("sheet.png"), "--json", text("verdicts.json")}).code, 0) << "its own";
}

TEST_F(Inspect, RefusesWhatIsNotThere) {
  EXPECT_EQ(inspect({text("nowhere")}).code, 3);
  const Outcome nothing = inspect({});
  EXPECT_EQ(nothing.code, 2);
  EXPECT_THAT(nothing.err, HasSubstr("nothing is given to look at"));
  write_file("notes.txt", "no image");
  EXPECT_EQ(inspect({text("notes.txt")}).code, 3);
}

TEST_F(Inspect, RecognizesEveryInputOfAMultilayerFileWithoutBeingTold) {
  const std::string folder = kData + "/room/multilayer";
  if (!fs::is_directory(folder)) GTEST_SKIP() << folder << " is not there; it is too large to be part of the repository";
  const Outcome outcome = inspect({folder + "/multi.%04d.exr"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  for (const char* input : {"albedo", "alpha", "camera", "color", "depth", "id", "motion", "normal", "position"})
    EXPECT_THAT(outcome.out, HasSubstr(std::string("\n  ") + input + " ")) << input;
  for (const char* subject : {"positions land on their pixels", "motion agrees with the matrices", "depth agrees with positions"})
    EXPECT_THAT(outcome.out, HasSubstr(std::string("  ok          ") + subject)) << subject;
}

TEST_F(Inspect, FindsNothingWrongWithTheCourseData) {
  const std::string folder = kData + "/games202-box";
  if (!fs::is_directory(folder)) GTEST_SKIP() << folder << " is not there; it is too large to be part of the repository";
  const Outcome outcome = inspect({folder, "--frames", "0-1"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("  ok          positions land on their pixels"));
}

}  // namespace
}  // namespace quell::app::testing
