// Cameras of headers, written here as each renderer is known to write them, from where the camera stands and what it sees.
#include "quell/sequence/header_camera.h"

#include <limits>

#include "quell/sequence/sequence.h"
#include "tests/core/sequence/test_camera.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using namespace test::camera;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Size kSize{60, 40};
constexpr double kTan = 0.4;  // of half the angle across the shorter side

struct Writer {
  const char* name;
  HeaderReading reading;
  double z;  // sign of camera space's z in front
};
const Writer kWriters[] = {
    {"RenderMan by a script for Nuke", {VectorOrder::row, NdcRange::minus_one_to_one, YDirection::up}, 1},
    {"Mantra", {VectorOrder::row, NdcRange::minus_one_to_one, YDirection::up, SignOfW::negative}, 1},
    {"OpenEXR's definition", {VectorOrder::row, NdcRange::zero_to_one, YDirection::down}, 1},
    {"pbrt-v4", {VectorOrder::column, NdcRange::zero_to_one_shorter, YDirection::up}, 1},
    {"an OpenGL program", {VectorOrder::column, NdcRange::minus_one_to_one, YDirection::up}, -1},
};

struct Lens {
  double shift = 0;  ///< of the picture to the right, in widths
  bool orthographic = false;
};

Matrix in_order(Matrix m, VectorOrder order) {
  if (order == VectorOrder::row)
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t column = 0; column < row; ++column) std::swap(m[4 * row + column], m[4 * column + row]);
  for (double& value : m) value = static_cast<float>(value);
  return m;
}

/// What the writer's header holds. Where a point lies across the image, from its middle, in shorter sides: X / (2 tan Z).
HeaderCamera header_of(const Pose& pose, const Writer& writer, const Lens& lens = {}) {
  HeaderCamera header{"a.exr", kSize, 1, kIdentity, Matrix{}};
  set_row(header.world_to_camera, 0, pose.right, -dot(pose.right, pose.eye));
  set_row(header.world_to_camera, 1, scaled(pose.down, -1), dot(pose.down, pose.eye));
  set_row(header.world_to_camera, 2, scaled(pose.forward, writer.z), -writer.z * dot(pose.forward, pose.eye));
  const double shorter = std::min(kSize.width, kSize.height);
  const bool square = writer.reading.ndc == NdcRange::zero_to_one_shorter,
             both = writer.reading.ndc == NdcRange::minus_one_to_one;
  const double per_x = (both ? 2 : 1) * (square ? 1 : shorter / kSize.width) / (2 * kTan);
  const double per_y = (both ? 2 : 1) * (square ? 1 : shorter / kSize.height) / (2 * kTan);
  const double middle = both ? 0 : 0.5, right = lens.shift * (both ? 2 : 1) * (square ? kSize.width / shorter : 1);
  const Vector axis = lens.orthographic ? Vector{} : pose.forward;
  const Vector x = plus(scaled(pose.right, per_x), scaled(axis, middle + right));
  const Vector y = plus(scaled(pose.down, writer.reading.y == YDirection::up ? -per_y : per_y), scaled(axis, middle));
  const double one = lens.orthographic ? 1 : 0;
  set_row(header.world_to_ndc, 0, x, one * (middle + right) - dot(x, pose.eye));
  set_row(header.world_to_ndc, 1, y, one * middle - dot(y, pose.eye));
  set_row(header.world_to_ndc, 2, scaled(pose.forward, 1.01), -1.01 * dot(pose.forward, pose.eye) - 0.1);
  const double w = writer.reading.w == SignOfW::negative && !lens.orthographic ? -1 : 1;
  set_row(header.world_to_ndc, 3, scaled(axis, w), one - w * dot(axis, pose.eye));
  header.world_to_camera = in_order(header.world_to_camera, writer.reading.vectors);
  header.world_to_ndc = in_order(header.world_to_ndc, writer.reading.vectors);
  return header;
}

double depth_at(int x, int y) { return 3 + 0.05 * x + 0.11 * y; }

/// The point of the world seen in the middle of a pixel.
Vector point_at(const Pose& pose, int x, int y, const Lens& lens) {
  const double shorter = std::min(kSize.width, kSize.height), depth = depth_at(x, y);
  const double spread = 2 * kTan * (lens.orthographic ? 1 : depth);
  const double across = (x + 0.5 - kSize.width * (0.5 + lens.shift)) / shorter, below = (y + 0.5 - kSize.height / 2.0) / shorter;
  return plus(plus(pose.eye, scaled(pose.forward, depth)),
              plus(scaled(pose.right, across * spread), scaled(pose.down, below * spread)));
}

class HeaderCameraOf : public testing::Test {
 protected:
  HeaderPositions positions(const Pose& pose, const Lens& lens = {}) {
    Image image(QUELL_TYPE_POSITION, kSize, pool_);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const Vector point = point_at(pose, x, y, lens);
        for (int c = 0; c < 3; ++c)  // the first rows are sky
          image.writable_floats().at(x, y, c) = y < 5 ? 0 : static_cast<float>(point[static_cast<std::size_t>(c)]);
      }
    return {image};
  }
  /// Float matrices: relative errors of 6e-8 in products of up to 60 px times a depth of 10, and as much in the translation.
  static void expect_lands(const Camera& camera, const Pose& pose, const Lens& lens, const std::string& what) {
    EXPECT_EQ(camera.size, kSize);
    for (int y = 0; y < kSize.height; y += 7)
      for (int x = 0; x < kSize.width; x += 7) {
        const Vector p = point_at(pose, x, y, lens);
        const auto row = [&](const Matrix& m, std::size_t r) {
          return m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
        };
        const double w = row(camera.world_to_screen, 3);
        ASSERT_NEAR(row(camera.world_to_screen, 0) / w, x + 0.5, 1e-4) << what;
        ASSERT_NEAR(row(camera.world_to_screen, 1) / w, y + 0.5, 1e-4) << what;
        ASSERT_NEAR(w, lens.orthographic ? 1 : depth_at(x, y), 1e-5) << what << ": w is the depth";
        ASSERT_NEAR(std::abs(row(camera.world_to_camera, 2)), depth_at(x, y), 1e-5) << what;
      }
  }
  BufferPool pool_;
};

TEST_F(HeaderCameraOf, AnyRendererIsReadRightlyByItsPositions) {
  const Pose pose = a_pose();
  for (const Lens& lens : {Lens{}, Lens{.shift = 0.3}, Lens{.orthographic = true}}) {
    const HeaderPositions seen = positions(pose, lens);
    for (const Writer& writer : kWriters) {
      const HeaderCamera header = header_of(pose, writer, lens);
      const HeaderReadings readings = find_readings(header, {}, &seen);
      HeaderReading expected = writer.reading;
      if (lens.orthographic) expected.w = SignOfW::positive;
      EXPECT_THAT(readings.possible, ElementsAre(expected)) << writer.name;
      EXPECT_THAT(readings.why, HasSubstr("positions land on their pixels (half of them within"));
      expect_lands(make_camera(header, expected), pose, lens, writer.name);
    }
  }
}

/// A reading's settings of what no matrix tells.
Conventions turned_like(const HeaderReading& reading) { return {.y = reading.y, .w = reading.w}; }

// No matrix tells which way an image is turned, nor to which side the camera looks: y and w stay open until they are stated.
TEST_F(HeaderCameraOf, WithoutPositionsTheFormTellsTheVectorsAndTheRange) {
  for (const Writer& writer : kWriters) {
    const HeaderCamera header = header_of(a_pose(), writer);
    const auto open = find_readings(header, {}, nullptr).possible;
    // With a negative w, NDC of 0 to 1 would have its middle at -0.5: that is no picture.
    EXPECT_EQ(open.size(), writer.reading.ndc == NdcRange::minus_one_to_one ? 4U : 2U) << writer.name;
    for (const HeaderReading& reading : open) {
      EXPECT_EQ(reading.vectors, writer.reading.vectors) << writer.name;
      EXPECT_EQ(reading.ndc, writer.reading.ndc) << writer.name;
    }
    EXPECT_THAT(find_readings(header, turned_like(writer.reading), nullptr).possible, ElementsAre(writer.reading)) << writer.name;
  }
  HeaderReading down = kWriters[0].reading, up = down;
  down.y = YDirection::down;
  EXPECT_THAT(find_readings(header_of(a_pose(), kWriters[0], {.orthographic = true}), {}, nullptr).possible,
              ElementsAre(down, up));
}

// The header of a frame that Mantra rendered, as ynput/ayon-houdini issue 76 shows it; the camera's axes are the rows of the
// first matrix read for column vectors, a field of view of 45 degrees across 1280 pixels is Houdini's default.
TEST_F(HeaderCameraOf, AHeaderThatMantraWroteIsReadRightly) {
  HeaderCamera header{"mantra.exr", {1280, 720}, 1, {}, {}};
  header.world_to_camera = {-0.243232, -0.429738, -0.869577, 0, -4.55991e-08, 0.8965,    -0.443043, 0,
                            -0.969968, 0.107762,  0.218058,  0, -0.49336,     -0.356619, 6.48486,   1};
  header.world_to_ndc = {-0.587216, -1.84441, -8.69577e-05, 0.869577,  -1.10086e-07, 3.84773,  -4.43043e-05, 0.443043,
                         -2.34172,  0.462509, 2.18058e-05,  -0.218058, -1.19108,     -1.53059, 0.000648386,  -6.48486};
  const Vector right{-0.243232, 0, -0.969968}, up{-0.429738, 0.8965, 0.107762}, forward{-0.869577, -0.443043, 0.218058};
  const Vector eye = plus(plus(scaled(right, 0.49336), scaled(up, 0.356619)), scaled(forward, -6.48486));
  HeaderPositions seen{Image(QUELL_TYPE_POSITION, header.size, pool_)};
  const double tan = std::tan(std::acos(-1) / 8);
  for (int y = 0; y < 720; ++y)
    for (int x = 0; x < 1280; ++x) {
      const double depth = 4 + 0.001 * x, per_pixel = 2 * tan / 1280 * depth;
      const Vector p = plus(plus(eye, scaled(forward, depth)),
                            plus(scaled(right, (x + 0.5 - 640) * per_pixel), scaled(up, -(y + 0.5 - 360) * per_pixel)));
      for (int c = 0; c < 3; ++c) seen.image.writable_floats().at(x, y, c) = static_cast<float>(p[static_cast<std::size_t>(c)]);
    }
  EXPECT_THAT(find_readings(header, {}, &seen).possible, ElementsAre(kWriters[1].reading));
}

TEST_F(HeaderCameraOf, AShiftedPictureWithoutPositionsLeavesTheRangeOpen) {
  const HeaderCamera header = header_of(a_pose(), kWriters[0], {.shift = 0.2});
  const auto readings = find_readings(header, turned_like(kWriters[0].reading), nullptr);
  EXPECT_EQ(readings.possible.size(), 3U) << "each range";
  for (const HeaderReading& reading : readings.possible) EXPECT_EQ(reading.vectors, VectorOrder::row);
}

// Without a translation, the first matrix looks alike in either order, but only one has its w along the axis.
TEST_F(HeaderCameraOf, ACameraInTheOriginIsToldByItsProjection) {
  Pose pose = a_pose();
  pose.eye = {};
  const HeaderPositions seen = positions(pose);
  for (const Writer& writer : kWriters) {
    const HeaderCamera header = header_of(pose, writer);
    EXPECT_THAT(find_readings(header, {}, &seen).possible, ElementsAre(writer.reading)) << writer.name;
    EXPECT_THAT(find_readings(header, turned_like(writer.reading), nullptr).possible, ElementsAre(writer.reading)) << writer.name;
  }
}

// As pbrt-v4's gbuffer film writes them when it is not told otherwise.
TEST_F(HeaderCameraOf, PositionsInCameraSpaceTellAsWell) {
  const Pose pose = a_pose();
  Image image(QUELL_TYPE_POSITION, kSize, pool_);
  for (const Writer& writer : kWriters) {
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const Vector way = minus(point_at(pose, x, y, {}), pose.eye);
        image.writable_floats().at(x, y, 0) = static_cast<float>(dot(way, pose.right));
        image.writable_floats().at(x, y, 1) = static_cast<float>(-dot(way, pose.down));
        image.writable_floats().at(x, y, 2) = static_cast<float>(writer.z * dot(way, pose.forward));
      }
    const HeaderPositions seen{image, Space::camera};
    EXPECT_THAT(find_readings(header_of(pose, writer), {}, &seen).possible, ElementsAre(writer.reading)) << writer.name;
  }
}

TEST_F(HeaderCameraOf, PositionsThatLandNowhereLeaveNoReading) {
  Pose elsewhere = a_pose();
  elsewhere.eye = {-7, 3, 1};
  const HeaderPositions seen = positions(elsewhere);
  const auto readings = find_readings(header_of(a_pose(), kWriters[2]), {}, &seen);
  EXPECT_THAT(readings.possible, IsEmpty());
  EXPECT_THAT(readings.why, HasSubstr("by none of them positions land on their pixels (at best half of them within"));
}

TEST_F(HeaderCameraOf, PositionsWithoutAnySurfaceTellNothing) {
  HeaderPositions sky{Image(QUELL_TYPE_POSITION, kSize, pool_)};
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < kSize.height; ++y) std::fill_n(sky.image.writable_floats().row(y, c), kSize.width, 0.0F);
  EXPECT_EQ(find_readings(header_of(a_pose(), kWriters[0]), {}, &sky).possible.size(), 4U);
}

TEST_F(HeaderCameraOf, WhatIsStatedInFullIsTaken) {
  const HeaderCamera header = header_of(a_pose(), kWriters[0]);
  const Conventions stated{
      .y = YDirection::down, .vectors = VectorOrder::row, .ndc = NdcRange::zero_to_one, .w = SignOfW::positive};
  const auto readings = find_readings(header, stated, nullptr);
  ASSERT_EQ(readings.possible.size(), 1U);
  EXPECT_EQ(describe(readings.possible[0]), "y=down, vectors=row, ndc=0..1, w=positive");
  EXPECT_EQ(readings.why, "as stated");
}

TEST_F(HeaderCameraOf, InASquareImageEqualReadingsCountOnce) {
  HeaderCamera header = header_of(a_pose(), kWriters[0]);
  header.size = {40, 40};
  const auto readings = find_readings(header, {.y = YDirection::up, .vectors = VectorOrder::row}, nullptr);
  for (const HeaderReading& reading : readings.possible) EXPECT_NE(reading.ndc, NdcRange::zero_to_one_shorter);
}

/// Files `image.<frame>.exr` with positions, and a header as the writer has it.
class HeaderCameraSequence : public HeaderCameraOf {
 protected:
  void make(int frame, const Writer& writer, bool with_positions = true) {
    Pose pose = a_pose();
    pose.eye[0] += frame;
    const HeaderCamera header = header_of(pose, writer);
    test::ExrContent content{.width = kSize.width, .height = kSize.height, .channels = {"X", "Y", "Z"}};
    const HeaderPositions seen = positions(pose);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x)
        for (int c = 0; c < 3; ++c)
          content.pixels.push_back(with_positions ? static_cast<double>(seen.image.floats().at(x, y, c)) : 0);
    content.matrices = {{"worldToCamera", header.world_to_camera}, {"worldToNDC", header.world_to_ndc}};
    test::make_exr(file(frame), content);
  }
  std::filesystem::path file(int frame) const { return folder_ / ("image.000" + std::to_string(frame) + ".exr"); }
  std::string pattern() const { return (folder_ / "image.####.exr").string(); }
  std::unique_ptr<Sequence> open(const std::string& settings = "", bool with_positions = true) {
    std::vector<std::string> in = {"camera=" + pattern() + settings};
    if (with_positions) in.push_back("position=" + pattern());
    return Sequence::open({}, {in, {}});
  }
  std::string error(Sequence& sequence, int frame) {
    return test::message_of(Fault::input, [&] { sequence.read("camera", frame, pool_); });
  }
  test::TempFolder folder_;
};

TEST_F(HeaderCameraSequence, CamerasComeFromTheHeadersOfImages) {
  for (const Writer& writer : kWriters) {
    for (const int frame : {1, 2}) make(frame, writer);
    const std::string bytes = test::read_bytes(file(1));
    ASSERT_NE(bytes.find(std::string("worldToCamera\0m44f", 18)), std::string::npos) << "as renderers name it";
    ASSERT_NE(bytes.find(std::string("worldToNDC\0m44f", 15)), std::string::npos);
    const auto sequence = open();
    for (const int frame : {2, 1}) {
      Pose pose = a_pose();
      pose.eye[0] += frame;
      const Item camera = sequence->read("camera", frame, pool_);
      expect_lands(camera.camera()->camera(), pose, {}, writer.name);
    }
    EXPECT_THAT(sequence->warnings(), ElementsAre(HasSubstr(pattern() + ": the header's camera is read with " +
                                                            describe(writer.reading) + " (positions land on their pixels")))
        << "told once";
  }
}

// The first frame shows the sky alone; the second decides for both, whichever is read first.
TEST_F(HeaderCameraSequence, TheFirstFrameThatCanTellDecidesForAll) {
  make(1, kWriters[3], false);
  make(2, kWriters[3]);
  make(3, kWriters[3], false);
  for (const int frame : {1, 3}) {
    Pose pose = a_pose();
    pose.eye[0] += frame;
    const auto sequence = open();
    expect_lands(sequence->read("camera", frame, pool_).camera()->camera(), pose, {}, "frame " + std::to_string(frame));
  }
}

TEST_F(HeaderCameraSequence, WhatCannotBeToldIsAnErrorThatListsTheWays) {
  make(1, kWriters[0]);
  const auto sequence = open("", false);
  for (int twice = 0; twice < 2; ++twice)
    EXPECT_EQ(error(*sequence, 1),
              pattern() +
                  ": worldToCamera and worldToNDC of these headers can be understood in several ways:\n"
                  "  y=down, vectors=row, ndc=-1..1, w=positive\n"
                  "  y=down, vectors=row, ndc=-1..1, w=negative\n"
                  "  y=up, vectors=row, ndc=-1..1, w=positive\n"
                  "  y=up, vectors=row, ndc=-1..1, w=negative\n"
                  "add positions (--in position=PATTERN), which tell them apart, or say which: --in camera=" +
                  pattern() + ":y=down:vectors=row:ndc=-1..1:w=positive");
  Pose pose = a_pose();
  pose.eye[0] += 1;
  expect_lands(open(":y=up:w=positive", false)->read("camera", 1, pool_).camera()->camera(), pose, {}, "y stated");
}

TEST_F(HeaderCameraSequence, PositionsThatContradictEveryWayAreTold) {
  make(1, kWriters[2]);
  make(2, kWriters[2]);
  std::filesystem::copy_file(file(2), folder_ / "p.0001.exr");
  const auto sequence = Sequence::open({}, {{"camera=" + pattern(), "position=" + (folder_ / "p.####.exr").string()}, {}});
  const std::string message = test::message_of(Fault::input, [&] { sequence->read("camera", 1, pool_); });
  EXPECT_THAT(message, HasSubstr("but by none of them positions land on their pixels"));
  EXPECT_THAT(message, HasSubstr("--in camera=PATTERN:vectors=row:ndc=0..1:y=down:w=positive"));
}

TEST_F(HeaderCameraSequence, AHeaderWithoutMatricesIsRefused) {
  test::make_exr(file(1), {.width = 2, .height = 2});
  EXPECT_EQ(error(*open("", false), 1),
            file(1).string() + ": the header has no matrix worldToCamera; a camera needs worldToCamera and worldToNDC");
  HeaderCamera header = header_of(a_pose(), kWriters[0]);
  header.world_to_ndc[5] = std::numeric_limits<double>::quiet_NaN();
  test::make_exr(
      file(1),
      {.width = 2, .height = 2, .matrices = {{"worldToCamera", header.world_to_camera}, {"worldToNDC", header.world_to_ndc}}});
  EXPECT_THAT(error(*open("", false), 1), HasSubstr("the header's worldToNDC holds a number that is not finite"));
}

TEST_F(HeaderCameraOf, MatricesThatGiveNoPictureAreRefused) {
  HeaderCamera header = header_of(a_pose(), kWriters[0]);
  header.world_to_camera = {};
  EXPECT_THAT(test::message_of(Fault::input, [&] { make_camera(header, {}); }),
              HasSubstr("a.exr: the header's worldToCamera cannot be inverted"));
  EXPECT_THAT(test::message_of(Fault::input, [&] { find_readings(header, {}, nullptr); }), HasSubstr("cannot be inverted"));
}

}  // namespace
}  // namespace quell
