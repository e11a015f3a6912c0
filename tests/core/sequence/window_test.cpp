// Which part of the images a sequence reads: display window, data window, crop.
#include <climits>

#include "quell/sequence/sequence.h"
#include "tests/core/sequence/layout_rows.h"

namespace quell {
namespace {

using test::ExrContent;
using test::make_exr;
using test::make_text;
using test::message_of;
using test::values;
using testing::ElementsAre;
using testing::HasSubstr;

/// A display window of 4 x 3 with two more columns and rows all around; the value of a pixel is 10 x + y, seen from the display
/// window's corner.
class WindowOf : public testing::Test {
 protected:
  WindowOf() {
    ExrContent content{
        .width = 8, .height = 7, .channels = {"Y"}, .x = -2, .y = -2, .full_width = 4, .full_height = 3, .pixel_aspect = 2};
    for (int y = -2; y < 5; ++y)
      for (int x = -2; x < 6; ++x) content.pixels.push_back(10 * x + y);
    make_exr(folder_ / "depth.0001.exr", content);
    make_text(folder_ / "frame.0001.json",
              R"({"width": 4, "height": 3, "world_to_camera": )" + test::kIdentityText +
                  R"(, "world_to_pixel": [[4,0,2,0],[0,3,1,0],[0,0,0,1],[0,0,1,0]], "objects": {}})");
  }
  std::unique_ptr<Sequence> open(const SequenceOptions& options) { return Sequence::open(folder_.path(), options); }
  std::vector<float> read(Sequence& sequence) {
    sequence.expect("depth", QUELL_TYPE_DEPTH);
    BufferPool pool;
    return values(*sequence.read("depth", 1, pool).image());
  }
  Camera camera(Sequence& sequence) {
    BufferPool pool;
    return sequence.read("camera", 1, pool).camera()->camera();
  }
  test::TempFolder folder_;
};

/// Where a point is seen.
std::pair<double, double> project(const Camera& camera, double x, double y, double z) {
  const Matrix& m = camera.world_to_screen;
  const double w = m[12] * x + m[13] * y + m[14] * z + m[15];
  return {(m[0] * x + m[1] * y + m[2] * z + m[3]) / w, (m[4] * x + m[5] * y + m[6] * z + m[7]) / w};
}

TEST_F(WindowOf, TheImageIsTheDisplayWindow) {
  const auto sequence = open({});
  EXPECT_EQ(sequence->shape("depth")->size, (Size{4, 3}));
  EXPECT_THAT(read(*sequence), ElementsAre(1e10F, 10, 20, 30, 1, 11, 21, 31, 2, 12, 22, 32));
  const auto window = sequence->picture_window();
  ASSERT_TRUE(window);
  EXPECT_EQ(window->display, (Rectangle{0, 0, 4, 3}));
  EXPECT_EQ(window->data, (Rectangle{0, 0, 4, 3}));
  EXPECT_EQ(window->pixel_aspect, 2);
  EXPECT_THAT(sequence->warnings(), ElementsAre(HasSubstr("reach beyond the image of 4 x 3 and are cropped")));
}

TEST_F(WindowOf, TheDataWindowCanBeTakenInstead) {
  const auto sequence = open({.window = WindowChoice::data});
  EXPECT_EQ(sequence->shape("depth")->size, (Size{8, 7}));
  EXPECT_EQ(sequence->picture_window()->display, (Rectangle{0, 0, 4, 3}));
  EXPECT_EQ(sequence->picture_window()->data, (Rectangle{-2, -2, 8, 7}));
  const std::vector<float> got = read(*sequence);
  EXPECT_EQ(got[0], -22);
  EXPECT_EQ(got[8 * 3 + 3], 11) << "pixel (1, 1) of the display window";
  EXPECT_THAT(sequence->warnings(), testing::IsEmpty());
  const Camera shifted = camera(*sequence);
  EXPECT_EQ(shifted.size, (Size{8, 7}));
  EXPECT_EQ(project(shifted, 0.5, 0.25, 1), std::pair(4 * 0.5 + 2 + 2, 3 * 0.25 + 1 + 2));
}

TEST_F(WindowOf, ACropIsPartOfTheImageAndShiftsTheCamera) {
  const auto sequence = open({.crop = Rectangle{1, 1, 2, 2}});
  EXPECT_EQ(sequence->shape("depth")->size, (Size{2, 2}));
  EXPECT_THAT(read(*sequence), ElementsAre(11, 21, 12, 22));
  EXPECT_EQ(sequence->picture_window()->data, (Rectangle{1, 1, 2, 2}));
  const Camera shifted = camera(*sequence);
  EXPECT_EQ(shifted.size, (Size{2, 2}));
  EXPECT_EQ(project(shifted, 0.5, 0.25, 1), std::pair(4 * 0.5 + 2 - 1, 3 * 0.25 + 1 - 1));
}

TEST_F(WindowOf, ACropOfTheDataWindowCountsFromItsCorner) {
  const auto sequence = open({.window = WindowChoice::data, .crop = Rectangle{0, 0, 2, 1}});
  EXPECT_THAT(read(*sequence), ElementsAre(-22, -12));
  EXPECT_EQ(sequence->picture_window()->data, (Rectangle{-2, -2, 2, 1}));
}

TEST_F(WindowOf, ACropBeyondTheImageSaysItsSize) {
  for (const Rectangle crop :
       {Rectangle{3, 0, 2, 1}, {0, 3, 1, 1}, {0, 0, 5, 3}, {-1, 0, 1, 1}, {0, 0, 0, 1}, {INT_MAX, 0, 1, 1}, {1, 0, INT_MAX, 1}}) {
    const auto sequence = open({.crop = crop});
    EXPECT_THAT(message_of(Fault::usage, [&] { sequence->shape("depth"); }),
                HasSubstr(" is not all within the image, which is 4 x 3 (" + (folder_ / "depth.0001.exr").string() + ")"));
  }
}

TEST_F(WindowOf, MotionInFractionsRefersToTheWholeImage) {
  ExrContent content{.width = 4, .height = 2, .channels = {"X", "Y"}};
  for (int i = 0; i < 8; ++i) content.pixels.insert(content.pixels.end(), {0.25, 0.5});
  make_exr(folder_ / "m.0001.exr", content);
  BufferPool pool;
  const auto sequence =
      Sequence::open("", {.in = {"motion=" + (folder_ / "m.####.exr").string() + ":unit=uv"}, .crop = Rectangle{2, 1, 1, 1}});
  EXPECT_THAT(values(*sequence->read("motion", 1, pool).image()), ElementsAre(1, 1));
}

TEST_F(WindowOf, ImagesOfOtherSizesHaveNoPartInCommon) {
  make_exr(folder_ / "color.0001.exr", {.width = 8, .height = 6, .channels = {"R", "G", "B"}});
  const auto sequence = open({.crop = Rectangle{0, 0, 2, 2}});
  EXPECT_EQ(sequence->shape("color")->size, (Size{2, 2}));
  EXPECT_THAT(message_of(Fault::input, [&] { sequence->shape("depth"); }),
              HasSubstr("the images of 'depth' are 4 x 3, those of 'color' 8 x 6"));
}

}  // namespace
}  // namespace quell
