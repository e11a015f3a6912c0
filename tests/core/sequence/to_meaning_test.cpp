// Conversions to the meaning of a type, against formulas in double that start from scenes instead of matrices.
#include <cmath>
#include <limits>

#include "quell/sequence/conventions.h"
#include "tests/core/sequence/test_camera.h"
#include "tests/core/sequence/test_files.h"

namespace quell {
namespace {

using namespace test::camera;
using test::message_of;
using test::values;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kUlp = 6e-8;  // half a unit in the last place of a float, relative
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

class ToMeaning : public testing::Test {
 protected:
  Image make(PortType type, Size size, const std::vector<double>& planes) {
    Image image(type, size, pool_);
    const FloatOutput out = image.writable_floats();
    std::size_t next = 0;
    for (int c = 0; c < out.channels; ++c)
      for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) out.at(x, y, c) = static_cast<float>(planes.at(next++));
    return image;
  }
  /// Of a row of pixels, the planes one after the other.
  std::vector<float> convert(PortType type, const std::vector<double>& planes, const Conventions& conventions,
                             const ConversionContext& context = {}) {
    const int width = static_cast<int>(planes.size()) / info(type).channels;
    Image image = make(type, {width, 1}, planes);
    to_meaning(image, conventions, context);
    return values(image);
  }
  ConversionContext with(std::optional<Camera> now, std::optional<Camera> before = {}) {
    ConversionContext context{.file = "a.exr", .whole = kWhole};
    context.camera = [=](int back) -> std::shared_ptr<const Camera> {
      const auto& camera = back == 0 ? now : before;
      return camera ? std::make_shared<const Camera>(*camera) : nullptr;
    };
    context.note = [this](const std::string& note) { notes_.push_back(note); };
    return context;
  }
  BufferPool pool_;
  std::vector<std::string> notes_;
};

TEST_F(ToMeaning, WhatIsAsQuellHasItKeepsItsBits) {
  const std::vector<double> numbers = {0.1F, -0.0, kInfinity, 1e-40F, 3e38F, -7, 0, 0.3F, 1};
  for (const PortType type : {QUELL_TYPE_COLOR, QUELL_TYPE_ALBEDO, QUELL_TYPE_POSITION})
    EXPECT_THAT(convert(type, numbers, {}), testing::ElementsAreArray(std::vector<float>(numbers.begin(), numbers.end())));
  const Conventions own{
      .sign = MotionSign::previous_minus_current, .unit = MotionUnit::pixels, .y = YDirection::down, .jitter = Jitter::excluded};
  EXPECT_THAT(convert(QUELL_TYPE_MOTION, {0.1F, -2, 3, kInfinity}, own), ElementsAre(0.1F, -2, 3, kInfinity));
}

// A point moves from one place of the whole image to another; each convention's numbers are written from its own coordinates.
TEST_F(ToMeaning, MotionOfEverySignUnitAndDirectionBecomesPixelsDownPreviousMinusCurrent) {
  const double before[2] = {17.25, 40.5}, now[2] = {20, 31.125};
  for (const MotionSign sign : {MotionSign::previous_minus_current, MotionSign::current_minus_previous}) {
    for (const MotionUnit unit : {MotionUnit::pixels, MotionUnit::uv, MotionUnit::ndc}) {
      for (const YDirection y : {YDirection::down, YDirection::up}) {
        double written[2];
        for (int axis = 0; axis < 2; ++axis) {
          const double size = axis == 0 ? kWhole.width : kWhole.height;
          const auto place = [&](double pixels) {
            if (axis == 1 && y == YDirection::up) pixels = size - pixels;
            return unit == MotionUnit::pixels ? pixels : unit == MotionUnit::uv ? pixels / size : 2 * pixels / size - 1;
          };
          written[axis] = sign == MotionSign::previous_minus_current ? place(before[axis]) - place(now[axis])
                                                                     : place(now[axis]) - place(before[axis]);
        }
        const Conventions conventions{.sign = sign, .unit = unit, .y = y};
        const auto got = convert(QUELL_TYPE_MOTION, {written[0], written[1]}, conventions, {.whole = kWhole});
        EXPECT_NEAR(got[0], before[0] - now[0], 2 * kUlp * 10) << describe(conventions);
        EXPECT_NEAR(got[1], before[1] - now[1], 2 * kUlp * 10) << describe(conventions);
      }
    }
  }
}

TEST_F(ToMeaning, MotionThatIsNoPartOfALargerImageRefersToItsOwnSize) {
  EXPECT_THAT(convert(QUELL_TYPE_MOTION, {0.5, 0, 0.25, 1}, {.unit = MotionUnit::uv}), ElementsAre(1, 0, 0.25, 1));
}

// A point stands still before a camera that stands still, and is seen through two jitters.
TEST_F(ToMeaning, JitterIsTakenOffTheMotion) {
  const Vector point{3, 9, 4};
  Camera now = camera_of(a_pose()), before = now;
  const auto jitter = [](Camera& camera, double x, double y) {
    camera.jitter = {x, y};
    for (std::size_t i = 0; i < 4; ++i) {  // moves the image by (x, y): u + x = (s0 + x s3) p / s3 p
      camera.world_to_screen[i] += x * camera.world_to_screen[12 + i];
      camera.world_to_screen[4 + i] += y * camera.world_to_screen[12 + i];
    }
  };
  jitter(now, 0.25, -0.375), jitter(before, -0.125, 0.4);
  const auto seen = [&](const Camera& camera, std::size_t axis) {
    const auto row = [&](std::size_t r) {
      const Matrix& m = camera.world_to_screen;
      return m[4 * r] * point[0] + m[4 * r + 1] * point[1] + m[4 * r + 2] * point[2] + m[4 * r + 3];
    };
    return row(axis) / row(3);
  };
  const double dx = seen(before, 0) - seen(now, 0), dy = seen(before, 1) - seen(now, 1);
  ASSERT_NEAR(dx, -0.375, 1e-9);
  const auto pixels = convert(QUELL_TYPE_MOTION, {dx, dy}, {.jitter = Jitter::included}, with(now, before));
  EXPECT_NEAR(pixels[0], 0, kUlp);
  EXPECT_NEAR(pixels[1], 0, kUlp);
  const Conventions other{
      .sign = MotionSign::current_minus_previous, .unit = MotionUnit::ndc, .y = YDirection::up, .jitter = Jitter::included};
  const auto ndc = convert(QUELL_TYPE_MOTION, {-dx * 2 / kWhole.width, dy * 2 / kWhole.height}, other, with(now, before));
  EXPECT_NEAR(ndc[0], 0, 2 * kUlp);
  EXPECT_NEAR(ndc[1], 0, 2 * kUlp);
  EXPECT_THAT(notes_, testing::IsEmpty());
}

TEST_F(ToMeaning, AFrameWithoutACameraBeforeItTakesOffItsOwnJitterAlone) {
  Camera now = camera_of(a_pose());
  now.jitter = {0.25, -0.5};
  EXPECT_THAT(convert(QUELL_TYPE_MOTION, {1, 1}, {.jitter = Jitter::included}, with(now)), ElementsAre(1.25F, 0.5F));
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("some frames have no camera before them")));
}

TEST_F(ToMeaning, CamerasThatTellNoJitterAreNoted) {
  const Camera camera = camera_of(a_pose());
  convert(QUELL_TYPE_MOTION, {1, 1}, {.jitter = Jitter::included}, with(camera, camera));
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("the cameras tell none; sidecars tell it as \"jitter\": [x, y]")));
}

/// A point of the world for each pixel of a part of the image: the distances along the ray vary.
struct Surface {
  std::vector<double> ray, axis;
};
Surface surface_of(const Pose& pose, bool orthographic, Size size, int x0, int y0) {
  Surface surface;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double across = (x0 + x + 0.5 - kCenterX) / kFocal, below = (y0 + y + 0.5 - kCenterY) / kFocal;
      const double depth = 2 + 0.1 * x + 0.3 * y;
      Vector point = plus(pose.eye, scaled(pose.forward, depth));
      const double spread = orthographic ? 1 : depth;
      point = plus(point, plus(scaled(pose.right, across * spread), scaled(pose.down, below * spread)));
      const Vector way = minus(point, pose.eye);
      surface.axis.push_back(dot(way, pose.forward));
      // An orthographic ray begins on the image plane, not in the eye.
      surface.ray.push_back(orthographic ? depth : std::sqrt(dot(way, way)));
    }
  }
  return surface;
}

// The numbers are rounded once when they are written and once when they are converted.
TEST_F(ToMeaning, DepthAlongRaysBecomesDepthAlongTheAxis) {
  const Pose pose = a_pose();
  for (const bool orthographic : {false, true}) {
    for (const double z : {1.0, -1.0}) {
      for (const double w : {1.0, -0.02, 40.0}) {
        for (const auto& [x0, y0, size] : {std::tuple(0, 0, kWhole), std::tuple(40, 33, Size{5, 4})}) {
          const Surface surface = surface_of(pose, orthographic, size, x0, y0);
          ConversionContext context = with(camera_of(pose, z, w, orthographic));
          context.x = x0, context.y = y0;
          Image image = make(QUELL_TYPE_DEPTH, size, surface.ray);
          to_meaning(image, {.depth = DepthMeasure::ray}, context);
          const auto got = values(image);
          for (std::size_t i = 0; i < got.size(); ++i)
            ASSERT_NEAR(got[i], surface.axis[i], 2 * kUlp * surface.axis[i]) << orthographic << z << w << " pixel " << i;
        }
      }
    }
  }
}

// Positions are huge, and the matrices were rounded to float by their writer: a relative error of 6e-8 in 5e6 and a depth of 2.
TEST_F(ToMeaning, ACameraFarFromTheOriginIsStillAPerspective) {
  Pose pose = a_pose();
  pose.eye = {5e6, -3e6, 1e3};
  Camera camera = camera_of(pose, -1);
  for (Matrix* matrix : {&camera.world_to_camera, &camera.world_to_screen})
    for (double& value : *matrix) value = static_cast<float>(value);
  const Surface surface = surface_of(pose, false, kWhole, 0, 0);
  Image image = make(QUELL_TYPE_DEPTH, kWhole, surface.ray);
  to_meaning(image, {.depth = DepthMeasure::ray}, with(camera));
  for (std::size_t i = 0; i < surface.axis.size(); ++i) ASSERT_NEAR(values(image)[i], surface.axis[i], 1e-5 * surface.axis[i]);
}

TEST_F(ToMeaning, DepthWithoutSurfaceStaysSoWhateverItMeasures) {
  const auto context = with(camera_of(a_pose()));
  EXPECT_THAT(convert(QUELL_TYPE_DEPTH, {0, kInfinity, -kInfinity, 1e9F, 1e10F}, {.depth = DepthMeasure::ray}, context),
              testing::Each(1e10F));
  EXPECT_THAT(convert(QUELL_TYPE_DEPTH, {0, -0.0, 1e-9F, 1e-30F, kInfinity, -kInfinity}, {.depth = DepthMeasure::reciprocal}),
              testing::Each(1e10F));
  EXPECT_TRUE(std::isnan(convert(QUELL_TYPE_DEPTH, {kNan}, {.depth = DepthMeasure::ray}, context)[0]));
  EXPECT_TRUE(std::isnan(convert(QUELL_TYPE_DEPTH, {kNan}, {.depth = DepthMeasure::reciprocal})[0]));
}

TEST_F(ToMeaning, ReciprocalDepthIsTurnedOver) {
  const std::vector<double> depths = {1e-3, 0.3, 1, 7, 12345.678, 9.5e8};
  std::vector<double> written;
  for (const double depth : depths) written.push_back(1 / depth);
  const auto got = convert(QUELL_TYPE_DEPTH, written, {.depth = DepthMeasure::reciprocal});
  for (std::size_t i = 0; i < depths.size(); ++i) EXPECT_NEAR(got[i], depths[i], 2 * kUlp * depths[i]);
  EXPECT_THAT(convert(QUELL_TYPE_DEPTH, {-4}, {.depth = DepthMeasure::reciprocal}), ElementsAre(-0.25F)) << "as along the axis";
}

// A rounded component is off by 1/255 of its range of 2 at most, half of that on average: 0.0068 in the direction's sine.
TEST_F(ToMeaning, NormalsWrittenWithEightBitsComeBack) {
  for (int i = 0; i < 50; ++i) {
    const double a = 0.7 * i, z = 1 - 2 * (i + 0.5) / 50, r = std::sqrt(1 - z * z);
    const Vector n{r * std::cos(a), r * std::sin(a), z};
    std::vector<double> written;
    for (const double value : n) written.push_back(std::round((value + 1) / 2 * 255) / 255);
    const auto got = convert(QUELL_TYPE_NORMAL, written, {.encoding = Encoding::unsigned_numbers});
    EXPECT_NEAR(std::hypot(got[0], got[1], got[2]), 1, 3 * kUlp);
    EXPECT_NEAR(std::hypot(got[0] - n[0], got[1] - n[1], got[2] - n[2]), 0, 0.0069) << i;
  }
  EXPECT_THAT(convert(QUELL_TYPE_NORMAL, {0.5, 1, 0.5}, {.encoding = Encoding::unsigned_numbers}), ElementsAre(0, 1, 0));
}

TEST_F(ToMeaning, UnsignedNormalsOfNoSurfaceAreBlackOrGrey) {
  for (const double none : {0.0, 0.5, 127 / 255.0, 128 / 255.0, 32768 / 65535.0})
    EXPECT_THAT(convert(QUELL_TYPE_NORMAL, {none, none, none}, {.encoding = Encoding::unsigned_numbers}), ElementsAre(0, 0, 0))
        << none;
  EXPECT_THAT(convert(QUELL_TYPE_NORMAL, {0.5, 0.5, 126 / 255.0}, {.encoding = Encoding::unsigned_numbers}),
              ElementsAre(0, 0, -1))
      << "a short one is one";
}

// Camera space of the pose, by its axes.
TEST_F(ToMeaning, NormalsAndPositionsInCameraSpaceAreTurnedToTheWorld) {
  const Pose pose = a_pose();
  const Vector n{0.36, -0.48, 0.8}, p{-4, 7, 11};
  for (const double z : {1.0, -1.0}) {
    const auto context = with(camera_of(pose, z));
    const Conventions camera_space{.space = Space::camera};
    const auto normal =
        convert(QUELL_TYPE_NORMAL, {dot(n, pose.right), z * dot(n, pose.down), z * dot(n, pose.forward)}, camera_space, context);
    const Vector way = minus(p, pose.eye);
    const auto position = convert(
        QUELL_TYPE_POSITION, {dot(way, pose.right), z * dot(way, pose.down), z * dot(way, pose.forward)}, camera_space, context);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(normal[i], n[i], 4 * kUlp) << "three rounded numbers of at most 1";
      EXPECT_NEAR(position[i], p[i], 4 * kUlp * 14) << "three rounded numbers of at most 14";
    }
    EXPECT_THAT(convert(QUELL_TYPE_NORMAL, {0, 0, 0}, camera_space, context), ElementsAre(0, 0, 0));
    EXPECT_THAT(convert(QUELL_TYPE_POSITION, {0, 0, 0}, camera_space, context), ElementsAre(0, 0, 0)) << "no surface";
  }
}

// A camera space that is stretched: a normal stays perpendicular to the surface only by the inverse transpose.
TEST_F(ToMeaning, NormalsOfAStretchedCameraSpaceStayPerpendicular) {
  Camera camera = camera_of(a_pose());
  for (std::size_t i = 0; i < 4; ++i) camera.world_to_camera[i] *= 3, camera.world_to_camera[4 + i] *= 0.5;
  const Vector along{1, 2, 0}, across{0, 1, -1};  // of the surface, in the world; its normal is their cross product
  const Vector expected = scaled({-2, 1, 1}, 1 / std::sqrt(6.0));
  const auto to_camera = [&](const Vector& v) {
    Vector result;
    for (std::size_t r = 0; r < 3; ++r)
      result[r] = camera.world_to_camera[4 * r] * v[0] + camera.world_to_camera[4 * r + 1] * v[1] +
                  camera.world_to_camera[4 * r + 2] * v[2];
    return result;
  };
  const Vector a = to_camera(along), b = to_camera(across);
  const Vector n{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const auto got = convert(QUELL_TYPE_NORMAL, {n[0], n[1], n[2]}, {.space = Space::camera}, with(camera));
  const double sign = got[0] * expected[0] > 0 ? 1 : -1;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(got[i], sign * expected[i], 20 * kUlp);
}

// The curve of the standard in its other direction, from linear to display.
double srgb_from_linear(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

// The two directions of the standard meet within 1e-6 where the straight part ends; elsewhere two roundings remain, the first
// made larger by the slope, at most 2.3 relative.
TEST_F(ToMeaning, TheSrgbCurveIsUndone) {
  for (int i = 0; i <= 1000; ++i) {
    const double linear = i / 1000.0;
    const auto got = convert(QUELL_TYPE_ALBEDO, {srgb_from_linear(linear), 0, 1}, {.transfer = Transfer::srgb});
    ASSERT_NEAR(got[0], linear, std::abs(linear - 0.0031308) < 2e-4 ? 1e-6 : 5 * kUlp * linear) << linear;
    ASSERT_EQ(got[1], 0);
    ASSERT_EQ(got[2], 1);
  }
  EXPECT_THAT(convert(QUELL_TYPE_COLOR, {0.04045, 0.5, -0.1}, {.transfer = Transfer::srgb}),
              ElementsAre(testing::FloatEq(0.0031308049F), testing::FloatEq(0.21404114F), testing::FloatEq(-0.0077399381F)));
}

TEST_F(ToMeaning, StraightAlphaIsMultipliedAfterTheCurveIsUndone) {
  ConversionContext context;
  context.alpha = [&] { return make(QUELL_TYPE_ALPHA, {2, 1}, {0.25, 0}); };
  const std::vector<double> pixels = {0.5, 0.5, 1, 1, 0, 8};
  EXPECT_THAT(convert(QUELL_TYPE_COLOR, pixels, {.alpha = AlphaKind::straight}, context), ElementsAre(0.125, 0, 0.25, 0, 0, 0));
  const auto both = convert(QUELL_TYPE_COLOR, pixels, {.alpha = AlphaKind::straight, .transfer = Transfer::srgb}, context);
  EXPECT_FLOAT_EQ(both[0], 0.25F * 0.21404114F);
  EXPECT_THAT(convert(QUELL_TYPE_COLOR, pixels, {.alpha = AlphaKind::premultiplied}, context), testing::ElementsAreArray(pixels));
  context.alpha = [] { return std::optional<Image>(); };
  EXPECT_THAT(convert(QUELL_TYPE_COLOR, pixels, {.alpha = AlphaKind::straight}, context), testing::ElementsAreArray(pixels))
      << "without alpha everything is covered";
}

TEST_F(ToMeaning, WhatIsNotFiniteStaysSo) {
  const auto context = with(camera_of(a_pose()), camera_of(a_pose()));
  const auto none_finite = [](const std::vector<float>& numbers) {
    return std::none_of(numbers.begin(), numbers.end(), [](float value) { return std::isfinite(value); });
  };
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    const std::vector<double> two(2, bad), three(3, bad);
    EXPECT_TRUE(none_finite(convert(QUELL_TYPE_MOTION, two, {.unit = MotionUnit::uv, .jitter = Jitter::included}, context)));
    EXPECT_TRUE(none_finite(convert(QUELL_TYPE_NORMAL, three, {})));
    EXPECT_TRUE(none_finite(
        convert(QUELL_TYPE_NORMAL, three, {.space = Space::camera, .encoding = Encoding::unsigned_numbers}, context)));
    EXPECT_TRUE(none_finite(convert(QUELL_TYPE_POSITION, three, {.space = Space::camera}, context)));
    EXPECT_TRUE(none_finite(convert(QUELL_TYPE_COLOR, three, {.transfer = Transfer::srgb})));
  }
}

TEST_F(ToMeaning, WhatNeedsACameraSaysSo) {
  const auto error = [&](PortType type, const Conventions& conventions, const ConversionContext& context) {
    return message_of(Fault::input, [&] {
      convert(type, std::vector<double>(static_cast<std::size_t>(info(type).channels), 1.0), conventions, context);
    });
  };
  EXPECT_EQ(error(QUELL_TYPE_DEPTH, {.depth = DepthMeasure::ray}, with({})),
            "a.exr: depth along rays needs the camera of its frame, and there is none for it");
  EXPECT_THAT(error(QUELL_TYPE_MOTION, {.jitter = Jitter::included}, with({})),
              HasSubstr("a.exr: motion that holds jitter needs"));
  EXPECT_THAT(error(QUELL_TYPE_NORMAL, {.space = Space::camera}, with({})), HasSubstr("a.exr: a normal in camera space needs"));
  EXPECT_THAT(error(QUELL_TYPE_POSITION, {.space = Space::camera}, {}), HasSubstr("a position in camera space needs"));
  Camera small = camera_of(a_pose());
  small.size = {32, 24};
  EXPECT_EQ(error(QUELL_TYPE_DEPTH, {.depth = DepthMeasure::ray}, with(small)),
            "a.exr: depth along rays needs a camera of the image's size: this one is of 32 x 24 pixels, the image has 64 x 48");
  Camera flat = camera_of(a_pose());
  for (std::size_t i = 0; i < 4; ++i) flat.world_to_screen[i] = flat.world_to_screen[4 + i];
  EXPECT_THAT(error(QUELL_TYPE_DEPTH, {.depth = DepthMeasure::ray}, with(flat)), HasSubstr("projects everything onto a line"));
}

}  // namespace
}  // namespace quell
