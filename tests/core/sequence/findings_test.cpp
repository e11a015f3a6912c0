// What is looked at besides the conventions: files and their channels, numbers that are none, the picture, and many frames.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "quell/sequence/checks/channel_statistics.h"
#include "quell/sequence/checks/checks.h"
#include "quell/sequence/checks/load_frame.h"
#include "quell/sequence/checks/picture.h"
#include "tests/core/sequence/scene.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using test::Scene;
using testing::HasSubstr;

TEST(BadNumbers, AreCountedByInputAndPlane) {
  FrameData frame = Scene().read(2, {}, {});
  frame.color->stored.writable_floats().at(1, 1, 2) = std::numeric_limits<float>::quiet_NaN();
  frame.color->stored.writable_floats().at(2, 1, 2) = std::numeric_limits<float>::infinity();
  frame.normal->stored.writable_floats().at(5, 5, 0) = std::numeric_limits<float>::quiet_NaN();
  frame.depth->stored.writable_floats().at(0, 0) = std::numeric_limits<float>::infinity();  // means no surface
  const Finding finding = check_finite(frame).at(0);
  EXPECT_EQ(finding.verdict, Verdict::suspicious);
  EXPECT_THAT(finding.text, HasSubstr("color: 1 NaN and 1 infinite in plane 3"));
  EXPECT_THAT(finding.text, HasSubstr("normal: 1 NaN in plane 1"));
  EXPECT_EQ(figure(finding, "count"), 3);
}

TEST(LoadedFrame, KnowsHowEachImageIsChosenInItsFile) {
  const test::TempFolder folder;
  test::make_exr(folder / "a.0001.exr", {.channels = {"v.X", "v.Y", "v.Q", "w.Z", "w.Q", "n.X", "n.Y", "n.Z"}});
  test::make_exr(folder / "alpha.0001.exr", {.channels = {"A"}});
  const std::string file = (folder / "a.####.exr").string();
  const auto sequence = Sequence::open({}, {{"motion=" + file + ":channels=v.Q,v.Y", "depth=" + file + ":w.Z",
                                             "normal=" + file + ":n", "alpha=" + (folder / "alpha.####.exr").string()},
                                            {}});
  BufferPool pool;
  std::vector<Finding> problems;
  const FrameData frame = load_frame(*sequence, 1, pool, problems);
  ASSERT_TRUE(problems.empty());
  EXPECT_EQ(frame.motion->layer, "channels=v.Q,v.Y");
  EXPECT_EQ(frame.depth->layer, "w.Z");
  EXPECT_EQ(frame.normal->layer, "n");
  EXPECT_EQ(frame.alpha->layer, "");
}

TEST(Picture, OfAStripHasNoPlaceForTheWheelOfDirections) {
  BufferPool pool;
  FrameData frame;
  for (const Size size : {Size{1000, 2}, Size{4000, 3}}) {
    Image motion(QUELL_TYPE_MOTION, size, pool);
    for (int c = 0; c < 2; ++c)
      for (int y = 0; y < size.height; ++y) std::fill_n(motion.writable_floats().row(y, c), size.width, 1.0F);
    frame.motion = CheckedImage{"motion", motion, motion};
    const std::vector<Panel> panels = make_panels(frame, {});
    ASSERT_EQ(panels.size(), 1U);
    const Raster& picture = panels[0].picture;
    EXPECT_EQ(picture.at(picture.width - 1, 0), picture.at(0, 0)) << "one motion, one color";
  }
}

TEST(ChannelStatistics, CountEveryChannelOfEveryPartWhateverIsReadAtATime) {
  const test::TempFolder folder;
  test::ExrContent first{.width = 3, .height = 70, .channels = {"R", "G", "B"}}, second{.width = 2, .channels = {"Z"}};
  for (int i = 0; i < 210; ++i) first.pixels.insert(first.pixels.end(), {1.0 * i, -1.0, i == 5 ? NAN : 2.0});
  second.pixels = {4, INFINITY};
  first.part = "a", second.part = "b", second.full_width = 3, second.full_height = 70;
  test::make_parts(folder / "a.exr", {first, second});
  ImageFile file(folder / "a.exr");
  double done = 0;
  const auto all = measure_channels(file, [&](double share) {
    EXPECT_GE(share, done);
    done = share;
  });
  EXPECT_EQ(done, 1);
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[0].max, 209);
  EXPECT_EQ(all[0].mean, 104.5);
  EXPECT_EQ(all[1].min, -1);
  EXPECT_EQ(all[2].nan, 1U);
  EXPECT_EQ(all[2].finite, 209U);
  EXPECT_EQ(all[3].infinite, 1U);
  EXPECT_EQ(all[3].max, 4);
}

TEST(WorstOf, KeepsTheMostAlarmingFindingOfEachSubject) {
  const auto make = [](Verdict verdict, const char* subject, double value, std::int64_t frame) {
    Finding finding{verdict, subject, ""};
    finding.figures = {{"value", value}}, finding.frame = frame;
    return finding;
  };
  const auto worst = worst_of({make(Verdict::not_tested, "a", 0, 1), make(Verdict::ok, "b", 3, 1), make(Verdict::ok, "a", 1, 2),
                               make(Verdict::ok, "b", 5, 2), make(Verdict::wrong, "c", 1, 2), make(Verdict::ok, "c", 9, 3)});
  ASSERT_EQ(worst.size(), 3U);
  EXPECT_EQ(worst[0].verdict, Verdict::ok);
  EXPECT_EQ(worst[1].frame, 2);
  EXPECT_EQ(worst[2].verdict, Verdict::wrong);
}

}  // namespace
}  // namespace quell
