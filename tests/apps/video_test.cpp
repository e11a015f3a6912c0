// quell run -o out.mp4
#include <gmock/gmock.h>

#include <csignal>
#include <cstdlib>

#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Video : public RunnerTest {
 protected:
  Video() { make_shot(4); }
  Outcome video(const std::string& name, const std::string& params, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"run", make_graph(params), text("shot"), "-o", text(name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  static bool has_ffmpeg() { return std::system("ffmpeg -version > /dev/null 2>&1") == 0; }  // NOLINT: a test's own command
  /// Green in the middle of each picture, as ffmpeg decodes it; the pictures have the size given.
  std::vector<int> greens(const std::string& name, std::size_t width, std::size_t height) const {
    const std::string command =
        "ffmpeg -loglevel error -y -i '" + text(name) + "' -f rawvideo -pix_fmt rgb24 '" + text("raw") + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);  // NOLINT
    const std::string raw = read_file(path("raw"));
    const std::size_t picture = width * height * 3;
    EXPECT_EQ(raw.size() % picture, 0U);
    std::vector<int> found;
    for (std::size_t at = 0; at + picture <= raw.size(); at += picture)
      found.push_back(static_cast<unsigned char>(raw[at + (height / 2 * width + width / 2) * 3 + 1]));
    return found;
  }
};

// The green of frame n is 0.1 n: 89, 124, 149 and 170 with the sRGB curve. Halved colors and 8 bits of video are some steps off.
MATCHER_P(IsNear, wanted, "") { return std::abs(arg - wanted) <= 4; }

TEST_F(Video, ShowsTheFramesInTheirOrder) {
  if (!has_ffmpeg()) GTEST_SKIP() << "there is no ffmpeg";
  const Outcome outcome = video("out.mp4", R"({"gain": 0.1})", {"--fps", "10"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("out.mp4  frames 1-4"));
  EXPECT_THAT(greens("out.mp4", 16, 8), ElementsAre(IsNear(89), IsNear(124), IsNear(149), IsNear(170)));
  EXPECT_THAT(list("."), ::testing::IsSupersetOf({"graph.json", "out.mp4", "shot"}));
  EXPECT_EQ(list(".").size(), 4U);  // and `raw`: nothing is left of what it was while it was made
}

TEST_F(Video, OddSizesAreFilledUp) {
  if (!has_ffmpeg()) GTEST_SKIP() << "there is no ffmpeg";
  ASSERT_EQ(video("out.mkv", R"({"gain": 0.1})", {"--crop", "0,0,15,7"}).code, 0);
  EXPECT_EQ(greens("out.mkv", 16, 8).size(), 4U);
}

TEST_F(Video, AFailedFrameShowsTheOneBefore) {
  if (!has_ffmpeg()) GTEST_SKIP() << "there is no ffmpeg";
  const Outcome outcome = video("out.mp4", R"({"gain": 0.1, "at": [3]})");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(greens("out.mp4", 16, 8), ElementsAre(IsNear(89), IsNear(124), IsNear(124), IsNear(170)));
}

TEST_F(Video, FramesThatFailBeforeTheFirstGoodOneShowThat) {
  if (!has_ffmpeg()) GTEST_SKIP() << "there is no ffmpeg";
  EXPECT_EQ(video("out.mp4", R"({"gain": 0.1, "at": [1, 2]})").code, 1);
  EXPECT_THAT(greens("out.mp4", 16, 8), ElementsAre(IsNear(149), IsNear(149), IsNear(149), IsNear(170)));
}

TEST_F(Video, NamesWithColonsAndCapitalsAreFiles) {
  if (!has_ffmpeg()) GTEST_SKIP() << "there is no ffmpeg";
  const std::string graph = make_graph(R"({"gain": 0.1})"), program = QUELL_PROGRAM;
  const std::string command = "cd '" + text(".") + "' && '" + program + "' run '" + graph +
                              "' shot -o http:out.MP4 -q --plugin-path '" + TEST_PLUGINS + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT: a test's own command
  EXPECT_EQ(greens("http:out.MP4", 16, 8).size(), 4U);
}

TEST_F(Video, HoldsTheFramesThatWereDoneWhenItIsInterrupted) {
  if (!has_ffmpeg()) GTEST_SKIP() << "there is no ffmpeg";
  const std::string graph = make_graph(R"({"gain": 0.1, "wait_from": 3})");
  Program program({"run", graph, text("shot"), "-o", text("out.mp4"), "--threads", "4", "--plugin-path", TEST_PLUGINS});
  ASSERT_TRUE(program.wait_for_error_text("\nframe 2 (2 of 4)"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.code, 75) << outcome.err;
  EXPECT_THAT(greens("out.mp4", 16, 8), ElementsAre(IsNear(89), IsNear(124)));
}

TEST_F(Video, IsRefusedBeforeTheRunWhereAFolderStands) {
  std::filesystem::create_directories(path("out.mp4"));
  const Outcome outcome = video("out.mp4", R"({"at": [1]})");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--out: " + text("out.mp4") + " is to be a video, but a folder has this name"));
}

TEST_F(Video, NeedsFfmpegAndSaysSo) {
  const Outcome outcome = Program({"run", make_graph(), text("shot"), "-o", text("out.mp4"), "--plugin-path", TEST_PLUGINS},
                                  false, {"PATH=" + text("nowhere")})
                              .finish();
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--out: videos are made by the program 'ffmpeg', which is not in PATH; install it"));
  EXPECT_THAT(list("."), ElementsAre("graph.json", "shot"));
}

TEST_F(Video, WhatFfmpegSaysIsPassedOn) {
  write_file("bin/ffmpeg", "#!/bin/sh\necho no such codec >&2\nexit 1\n");
  std::filesystem::permissions(path("bin/ffmpeg"), std::filesystem::perms::owner_all);
  const Outcome outcome = Program({"run", make_graph(), text("shot"), "-o", text("out.mp4"), "--plugin-path", TEST_PLUGINS},
                                  false, {"PATH=" + text("bin") + ":/usr/bin:/bin"})
                              .finish();
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("out.mp4: ffmpeg failed; it says:\nno such codec"));
  EXPECT_THAT(list("."), ElementsAre("bin", "graph.json", "shot"));
}

TEST_F(Video, WhatIsForImagesIsRefused) {
  const std::vector<std::vector<std::string>> options{
      {"--format", "png"}, {"--type", "half"}, {"--compression", "none"}, {"--padding", "3"}, {"--layers", "all"}};
  for (const std::vector<std::string>& option : options) {
    const Outcome outcome = video("out.mp4", "{}", option);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(option.front() + ": it is for images, and --out names a video"));
  }
}

TEST_F(Video, WhatIsForVideosIsRefusedWithoutOne) {
  const Outcome outcome = video("folder", "{}", {"--fps", "10"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--fps: it is for videos, and --out names a folder"));
  EXPECT_THAT(video("out.mp4", "{}", {"--fps", "no"}).err, HasSubstr("--fps"));
}

}  // namespace
}  // namespace quell::app::testing
