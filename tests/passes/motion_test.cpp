#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"

namespace quell {
namespace {

constexpr Size kSize{37, 11};
constexpr float kFarAway = 1e6F;

float true_motion(int x, int y, int c) {
  return c == 0 ? 0.37F * static_cast<float>(x - 9) : 2.1F - 0.83F * static_cast<float>(y);
}

Image vectors(double scale_x, double scale_y, PortType type = QUELL_TYPE_MOTION) {
  return test_image(type, kSize, [=](int x, int y, int c) {
    return c == 2 ? 77.0F : static_cast<float>((c == 0 ? scale_x : scale_y) * true_motion(x, y, c));
  });
}

Camera jittered(double x, double y, Size size = kSize) {
  Camera camera;
  camera.size = size, camera.jitter = {x, y};
  return camera;
}

// The vectors and the result are rounded to float once each: 2 x 2^-24.
void expect_motion(const PassTest& pass, double add_x = 0, double add_y = 0) {
  const FloatImage motion = pass.output("motion");
  for (int c = 0; c < 2; ++c)
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const double want = true_motion(x, y, c) + (c == 0 ? add_x : add_y);
        ASSERT_NEAR(motion.at(x, y, c), want, 1.2e-7 * (std::abs(want) + 1)) << x << "," << y << "," << c;
      }
}

TEST(Motion, LeavesItsOwnConventionBitForBit) {
  PassTest pass("motion");
  pass.input("vectors", vectors(1, 1));
  pass.run();
  for (int c = 0; c < 2; ++c)
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) ASSERT_EQ(pass.output("motion").at(x, y, c), true_motion(x, y, c));
}

// The factors are how many of a convention's units one pixel to the right, and one down, are, worked out by hand.
TEST(Motion, UnderstandsEverySignUnitAndDirection) {
  struct Unit {
    const char* name;
    double x, y;
  };
  for (const Unit& unit : {Unit{"pixels", 1, 1}, Unit{"uv", 1.0 / 37, 1.0 / 11}, Unit{"ndc", 2.0 / 37, 2.0 / 11}})
    for (const bool velocity : {false, true})
      for (const bool up : {false, true})
        for (const PortType type : {QUELL_TYPE_MOTION, QUELL_TYPE_COLOR, QUELL_TYPE_NORMAL, QUELL_TYPE_POSITION}) {
          SCOPED_TRACE(std::string(unit.name) + (velocity ? " velocity" : "") + (up ? " up" : ""));
          PassTest pass("motion");
          pass.set("unit", unit.name).set("sign", velocity ? "current-previous" : "previous-current");
          pass.set("y", up ? "up" : "down");
          pass.input("vectors", vectors(velocity ? -unit.x : unit.x, velocity != up ? -unit.y : unit.y, type));
          pass.run();
          expect_motion(pass);
        }
}

TEST(Motion, ScalesWhatIsInAnotherUnit) {
  PassTest pass("motion");
  pass.set("scale", 0.125).input("vectors", vectors(8, 8));
  pass.run();
  expect_motion(pass);
}

// A renderer that subtracts jittered positions writes m + (previous jitter - jitter).
TEST(Motion, TakesTheDifferenceOfJitterOut) {
  PassTest pass("motion");
  pass.set("jitter", "included").input("vectors", vectors(1, 1));
  pass.input("camera", jittered(0.25, -0.125)).input("previous_camera", jittered(-0.5, 0.375));
  pass.run();
  expect_motion(pass, 0.75, -0.5);

  // The same jitter in the doubled resolution, of vectors that are to be halved and turned: the jitter is not turned.
  pass.input("camera", jittered(0.5, -0.25, {2 * kSize.width, 2 * kSize.height}));
  pass.set("scale", 0.5).set("sign", "current-previous").set("y", "up").input("vectors", vectors(-2, 2));
  pass.run();
  expect_motion(pass, 0.75, -0.5);

  pass.set("jitter", "excluded");
  pass.run();
  expect_motion(pass);
}

TEST(Motion, RefusesToTakeJitterOutWithoutBothCameras) {
  PassTest pass("motion");
  pass.set("jitter", "included").input("vectors", vectors(1, 1)).input("camera", jittered(0.25, 0));
  try {
    pass.run();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::usage);
    EXPECT_NE(std::string(error.what()).find("'previous_camera'"), std::string::npos) << error.what();
  }
}

TEST(Motion, SendsWhatIsNoVectorOffTheScreen) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  Image image = vectors(1, 1);
  const FloatOutput v = image.writable_floats();
  v.at(0, 0, 0) = nan, v.at(16, 3, 1) = nan, v.at(36, 10, 0) = -infinity, v.at(5, 7, 1) = infinity, v.at(6, 7, 0) = -1.1e6F;
  const auto bad = [](int x, int y) {
    return (x == 0 && y == 0) || (x == 16 && y == 3) || (x == 36 && y == 10) || (x == 5 && y == 7) || (x == 6 && y == 7);
  };
  const auto masked = [](int x, int y) { return (x + y) % 7 == 0; };
  for (const bool mask : {false, true}) {
    PassTest pass("motion");
    pass.input("vectors", image);
    if (mask)
      pass.input("valid", test_image(QUELL_TYPE_MASK, kSize, [&](int x, int y, int) { return masked(x, y) ? 0.0F : 1.0F; }));
    pass.run();
    for (int c = 0; c < 2; ++c)
      for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x) {
          const float want = bad(x, y) || (mask && masked(x, y)) ? kFarAway : true_motion(x, y, c);
          ASSERT_EQ(pass.output("motion").at(x, y, c), want) << x << "," << y << "," << c;
        }
  }
}

TEST(Motion, MayBeWrittenOverVectorsOfItsOwnTypeAlone) {
  PassTest pass("motion");
  pass.input("vectors", vectors(1, 1));
  EXPECT_EQ(pass.in_place_of("motion"), "vectors");
  pass.input("vectors", vectors(1, 1, QUELL_TYPE_COLOR));
  EXPECT_EQ(pass.in_place_of("motion"), "");
}

QUELL_CONFORMANCE_TEST(motion)
QUELL_CONFORMANCE_TEST(motion, .set("jitter", "included"))

}  // namespace
}  // namespace quell
