// The sample that ships, and the larger sequences beside the repository where they are there.
#include <algorithm>
#include <cmath>

#include "quell/sequence/matrix.h"
#include "quell/sequence/sequence.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

namespace fs = std::filesystem;

const fs::path kSample = fs::path(QUELL_SOURCE_DIR) / "graphs/sample";
const fs::path kData = fs::path(QUELL_SOURCE_DIR) / "../shared/data";
const fs::path kCourse = kData / "games202-box";
const fs::path kRoom = kData / "room";

#define SKIP_WITHOUT(folder) \
  if (!fs::is_directory(folder)) GTEST_SKIP() << (folder) << " is not there; it is too large to be part of the repository"

std::array<double, 4> transform(const Matrix& m, const std::array<double, 4>& p) {
  std::array<double, 4> result{};
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column) result[row] += m[4 * row + column] * p[column];
  return result;
}

/// Where the surface points of a frame are seen, relative to the corner of their own pixel.
struct Landing {
  long pixels = 0;
  double mean_x = 0, mean_y = 0;  // of the place within the pixel
  double farthest = 0;            // largest distance from the center along an axis
  double strays = 0;              // share of pixels farther than `tolerance` from the center
  double depth_error = 0;         // largest relative difference of w and the depth buffer
};

Landing land(Sequence& sequence, std::int64_t frame, double tolerance) {
  BufferPool pool;
  const Item position = sequence.read("position", frame, pool), id = sequence.read("id", frame, pool);
  const Item depth = sequence.read("depth", frame, pool), camera = sequence.read("camera", frame, pool);
  const FloatImage points = position.image()->floats();
  Landing landing;
  for (int y = 0; y < points.height; ++y) {
    for (int x = 0; x < points.width; ++x) {
      if (id.image()->ids().at(x, y) == QUELL_NO_ID) continue;
      const auto screen =
          transform(camera.camera()->camera().world_to_screen, {points.at(x, y, 0), points.at(x, y, 1), points.at(x, y, 2), 1});
      const double dx = screen[0] / screen[3] - x, dy = screen[1] / screen[3] - y;
      const double distance = std::max(std::abs(dx - 0.5), std::abs(dy - 0.5));
      ++landing.pixels;
      landing.mean_x += dx, landing.mean_y += dy;
      landing.farthest = std::max(landing.farthest, distance);
      landing.strays += distance > tolerance ? 1 : 0;
      landing.depth_error = std::max(landing.depth_error, std::abs(screen[3] / depth.image()->floats().at(x, y) - 1));
    }
  }
  const auto count = static_cast<double>(landing.pixels);
  landing.mean_x /= count, landing.mean_y /= count, landing.strays /= count;
  return landing;
}

/// All inputs of both in a frame hold the same bits.
void expect_same(Sequence& a, Sequence& b, std::int64_t frame, const std::vector<std::string>& inputs) {
  BufferPool pool;
  for (const std::string& input : inputs) {
    const Item first = a.read(input, frame, pool), second = b.read(input, frame, pool);
    ASSERT_EQ(first.type(), second.type()) << input;
    if (first.type() == QUELL_TYPE_CAMERA) {
      const Camera &x = first.camera()->camera(), &y = second.camera()->camera();
      EXPECT_EQ(x.world_to_camera, y.world_to_camera);
      EXPECT_EQ(x.world_to_screen, y.world_to_screen);
      EXPECT_EQ(x.object_to_world, y.object_to_world);
      EXPECT_EQ(x.size, y.size);
    } else if (first.type() == QUELL_TYPE_ID) {
      EXPECT_EQ(test::id_values(*first.image()), test::id_values(*second.image())) << input;
    } else {
      EXPECT_EQ(test::values(*first.image()), test::values(*second.image())) << input;
    }
  }
}

// Snapping positions to 2^-14 m moves a point by up to 3.1e-5 m along each axis, at depth 2.4 m and 270 px focal length 0.004 px;
// samples lie within 0.005 px of the center. Their sum, 0.009 px, holds but for the filter's tail seen at grazing angles.
TEST(SampleSequence, PointsLandOnTheirPixelsCenters) {
  const auto sequence = Sequence::open(kSample);
  for (const std::int64_t frame : {1, 8}) {
    const Landing landing = land(*sequence, frame, 0.009);
    EXPECT_EQ(landing.pixels, 320 * 180);
    EXPECT_NEAR(landing.mean_x, 0.5, 1e-3);
    EXPECT_NEAR(landing.mean_y, 0.5, 1e-3);
    EXPECT_LT(landing.strays, 1e-3);
    EXPECT_LT(landing.farthest, 0.5);
    EXPECT_LT(landing.depth_error, 1e-4) << "both are snapped: 6e-5 m of at least 2.3 m, twice";
  }
}

TEST(SampleSequence, AllThreeWaysGiveTheSameItems) {
  const auto file = Sequence::open(kSample);
  const test::TempFolder bare;  // the same files without the sequence.json
  std::vector<std::string> inputs, options;
  for (const InputFiles& input : file->inputs()) {
    inputs.push_back(input.input);
    options.push_back(input.input + "=" + input.pattern);
    const fs::path original = fs::path(input.pattern).parent_path();
    for (const std::int64_t frame : {1, 2}) {
      std::string name = fs::path(input.pattern).filename().string();
      name.replace(name.find("####"), 4, "000" + std::to_string(frame));
      fs::create_symlink(fs::absolute(original / name), bare / name);
    }
  }
  ASSERT_EQ(inputs.size(), 10U);
  const auto folder = Sequence::open(bare.path());
  const auto given = Sequence::open({}, {options, {}});
  EXPECT_EQ(folder->inputs().size(), 10U);
  for (const std::int64_t frame : {1, 2}) {
    expect_same(*file, *folder, frame, inputs);
    expect_same(*file, *given, frame, inputs);
  }
  EXPECT_THAT(file->warnings(), testing::IsEmpty());
}

// The files are float32: a relative error of 6e-8 in each of a few products of about 2500 px, divided by a depth of at least 4.
TEST(CourseSequence, PointsLandOnTheirPixelsCenters) {
  SKIP_WITHOUT(kCourse);
  const auto sequence = Sequence::open(kCourse);
  for (const std::int64_t frame : {0, 11}) {
    const Landing landing = land(*sequence, frame, 1e-3);
    EXPECT_EQ(landing.pixels, 248004);
    EXPECT_EQ(landing.strays, 0);
    EXPECT_LT(landing.depth_error, 1e-5);
  }
}

TEST(CourseSequence, BackgroundIsNoIdAndFarthestDepthAndZeroNormal) {
  SKIP_WITHOUT(kCourse);
  const auto sequence = Sequence::open(kCourse);
  BufferPool pool;
  const Item id = sequence->read("id", 3, pool), depth = sequence->read("depth", 3, pool),
             normal = sequence->read("normal", 3, pool);
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 512; ++x) {
      const bool background = id.image()->ids().at(x, y) == QUELL_NO_ID;
      const FloatImage n = normal.image()->floats();
      const double length = std::hypot(n.at(x, y, 0), n.at(x, y, 1), n.at(x, y, 2));
      ASSERT_EQ(depth.image()->floats().at(x, y) == QUELL_NO_SURFACE_DEPTH, background) << x << "," << y;
      ASSERT_NEAR(length, background ? 0 : 1, 2e-7) << x << "," << y;
    }
  }
}

TEST(CourseSequence, AllThreeWaysGiveTheSameItems) {
  SKIP_WITHOUT(kCourse);
  const auto folder = Sequence::open(kCourse);
  const test::TempFolder elsewhere;
  const std::string base = fs::absolute(kCourse).string() + "/";
  test::make_text(elsewhere / "sequence.json", R"({"quell_sequence": 1, "inputs": {"color": ")" + base + R"(beauty_%d.exr",
    "normal": ")" + base + R"(normal_%d.exr", "position": ")" +
                                                   base + R"(position_%d.exr", "depth": ")" + base + R"(depth_%d.exr",
    "id": {"file": ")" + base + R"(ID_%d.exr", "background": -1}, "camera": ")" +
                                                   base + R"(matrix_%d.mat"}})");
  const auto file = Sequence::open(elsewhere.path());
  const auto given = Sequence::open(
      {}, {{"color=" + base + "beauty_%d.exr", "normal=" + base + "normal_#.exr", "position=" + base + "position_%d.exr",
            "depth=" + base + "depth_%d.exr", "id=" + base + "ID_%d.exr", "camera=" + base + "matrix_%d.mat"},
           {}});
  const std::vector<std::string> inputs = {"camera", "color", "depth", "id", "normal", "position"};
  expect_same(*folder, *file, 1, inputs);
  expect_same(*folder, *given, 1, inputs);
  EXPECT_EQ(folder->frames(inputs).size(), 12U);
  EXPECT_EQ(given->frames(inputs), folder->frames(inputs));
  EXPECT_EQ(folder->padding(), 4);
}

// As for the sample, at twice the resolution.
TEST(RoomSequence, PointsLandOnTheirPixelsCenters) {
  SKIP_WITHOUT(kRoom);
  const auto sequence = Sequence::open(kRoom);
  const Landing landing = land(*sequence, 6, 0.013);
  EXPECT_EQ(landing.pixels, 640 * 360);
  EXPECT_NEAR(landing.mean_x, 0.5, 1e-3);
  EXPECT_NEAR(landing.mean_y, 0.5, 1e-3);
  EXPECT_LT(landing.strays, 1e-3);
  EXPECT_LT(landing.farthest, 0.5);
}

// What Blender itself writes: all passes in one part.
TEST(RoomMultilayer, EveryInputIsRecognizedWithoutBeingTold) {
  SKIP_WITHOUT(kRoom);
  const auto sequence = Sequence::open(kRoom / "multilayer/multi.%04d.exr");
  std::string names;
  for (const InputFiles& input : sequence->inputs()) names += input.input + " ";
  EXPECT_EQ(names, "albedo alpha camera color depth emission id motion normal position ");
  EXPECT_THAT(sequence->describe(),
              testing::HasSubstr("ViewLayer.Vector: X,Y (Blender)  sign=previous-current, unit=pixels, y=up"));
  // Positions are float here, not snapped; the farthest was measured 0.034 px from its pixel's center.
  const Landing landing = land(*sequence, 2, 0.05);
  EXPECT_EQ(landing.pixels, 320 * 180);
  EXPECT_NEAR(landing.mean_x, 0.5, 1e-3);
  EXPECT_NEAR(landing.mean_y, 0.5, 1e-3);
  EXPECT_EQ(landing.strays, 0);
  EXPECT_LT(landing.depth_error, 1e-5);
}

// The table's sign, unit and direction of Blender's vectors against the matrices of both frames.
TEST(RoomMultilayer, MotionAgreesWithTheMatrices) {
  SKIP_WITHOUT(kRoom);
  const auto sequence = Sequence::open(kRoom / "multilayer/multi.%04d.exr");
  BufferPool pool;
  const Item motion = sequence->read("motion", 2, pool), position = sequence->read("position", 2, pool);
  const Item id = sequence->read("id", 2, pool), before = sequence->read("camera", 1, pool),
             now = sequence->read("camera", 2, pool);
  const Camera &first = before.camera()->camera(), &second = now.camera()->camera();
  std::vector<double> errors;
  for (int y = 0; y < 180; ++y)
    for (int x = 0; x < 320; ++x) {
      const std::uint32_t object = id.image()->ids().at(x, y);
      if (!first.object_to_world.contains(object) || !second.object_to_world.contains(object)) continue;
      const FloatImage p = position.image()->floats(), v = motion.image()->floats();
      const std::array<double, 4> point{p.at(x, y, 0), p.at(x, y, 1), p.at(x, y, 2), 1};
      const auto there =
          transform(first.object_to_world.at(object), transform(inverse(second.object_to_world.at(object)), point));
      const auto from = transform(first.world_to_screen, there), to = transform(second.world_to_screen, point);
      errors.push_back(
          std::hypot(from[0] / from[3] - to[0] / to[3] - v.at(x, y, 0), from[1] / from[3] - to[1] / to[3] - v.at(x, y, 1)));
    }
  ASSERT_EQ(errors.size(), 320U * 180U);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.05) << "px; at edges, vectors are those of several surfaces, averaged";
}

}  // namespace
}  // namespace quell
