#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

constexpr float kFarAway = 1e6F;
constexpr Size kSize{33, 17};
constexpr double kFocal = 100, kDistance = 10;

// A pinhole at (eye_x, eye_y, eye_z), looking along +z: x_screen = focal (X - eye_x) / (Z - eye_z) + width / 2, y alike.
Camera pinhole(double eye_x, double eye_y, double eye_z = 0, Size size = kSize) {
  Camera camera;
  camera.size = size;
  const double cx = size.width / 2.0, cy = size.height / 2.0;
  camera.world_to_screen = {
      kFocal, 0, cx, -kFocal * eye_x - cx * eye_z, 0, kFocal, cy, -kFocal * eye_y - cy * eye_z, 0, 0, 1, -eye_z, 0, 0, 1, -eye_z};
  return camera;
}

// A wall at z = kDistance, seen by pinhole(0, 0) through the pixels' centers, or `offset` pixels beside them.
Image wall(Size size = kSize, double offset = 0) {
  return test_image(QUELL_TYPE_POSITION, size, [=](int x, int y, int c) {
    if (c == 2) return static_cast<float>(kDistance);
    const double pixel = c == 0 ? x + 0.5 + offset - size.width / 2.0 : y + 0.5 + offset - size.height / 2.0;
    return static_cast<float>(pixel * kDistance / kFocal);
  });
}

// The wall's float coordinates are off by at most 2^-24 of 1.65, times kFocal / kDistance pixels.
constexpr double kWallError = 2e-6;

void expect_motion(const FloatImage& motion, double dx, double dy, double tolerance = kWallError) {
  for (int y = 0; y < motion.height; ++y)
    for (int x = 0; x < motion.width; ++x) {
      ASSERT_NEAR(motion.at(x, y, 0), dx, tolerance) << x << "," << y;
      ASSERT_NEAR(motion.at(x, y, 1), dy, tolerance) << x << "," << y;
    }
}

TEST(BackProject, GivesNoMotionWithoutPreviousCamera) {
  PassTest pass("back_project");
  pass.input("position", wall());
  pass.input("camera", pinhole(0.1, 0));
  pass.run();
  expect_motion(pass.output("motion"), 0, 0, 0);
}

TEST(BackProject, GivesNoMotionAtRest) {
  PassTest pass("back_project");
  pass.input("position", wall());
  pass.input("camera", pinhole(0, 0));
  pass.input("previous_camera", pinhole(0, 0));
  pass.run();
  expect_motion(pass.output("motion"), 0, 0);
}

TEST(BackProject, FollowsACameraThatMovesByWholeAndHalfPixels) {
  // 10 pixels a world unit on the wall. The previous eye stood 0.1 to the left, so the wall stood 1 pixel to the right.
  PassTest pass("back_project");
  pass.input("position", wall());
  pass.input("camera", pinhole(0, 0));
  pass.input("previous_camera", pinhole(-0.1, 0.05));
  pass.run();
  expect_motion(pass.output("motion"), 1, -0.5);
}

TEST(BackProject, TurnsAPointBackWithItsObject) {
  // Object 7 turned by 0.1 rad about (0.2, 0.1) of the wall; worked with sine and cosine of the point, without any matrix.
  const double angle = 0.3, before = 0.2, ox = 0.2, oy = 0.1;
  const auto turned = [&](double a) -> Matrix {
    return {std::cos(a), -std::sin(a), 0, ox, std::sin(a), std::cos(a), 0, oy, 0, 0, 1, kDistance, 0, 0, 0, 1};
  };
  Camera now = pinhole(0, 0), previous = pinhole(0, 0);
  now.object_to_world = {{3, kIdentity}, {7, turned(angle)}};
  previous.object_to_world = {{3, kIdentity}, {7, turned(before)}};
  const Image position = wall();

  PassTest pass("back_project");
  pass.input("position", position);
  pass.input_ids("id", kSize, [](int x, int) { return x < 10 ? 3U : 7U; });
  pass.input("camera", now);
  pass.input("previous_camera", previous);
  pass.run();
  const FloatImage motion = pass.output("motion"), p = position.floats();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const double a = x < 10 ? 0 : before - angle, dx = p.at(x, y, 0) - ox, dy = p.at(x, y, 1) - oy;
      const double px = ox + std::cos(a) * dx - std::sin(a) * dy, py = oy + std::sin(a) * dx + std::cos(a) * dy;
      ASSERT_NEAR(motion.at(x, y, 0), px * kFocal / kDistance + kSize.width / 2.0 - (x + 0.5), kWallError) << x << "," << y;
      ASSERT_NEAR(motion.at(x, y, 1), py * kFocal / kDistance + kSize.height / 2.0 - (y + 0.5), kWallError) << x << "," << y;
    }
}

TEST(BackProject, MovesNothingButTheCameraForObjectsNotInBothTables) {
  const Matrix shifted{1, 0, 0, 5, 0, 1, 0, 5, 0, 0, 1, 5, 0, 0, 0, 1};
  Camera now = pinhole(0, 0), previous = pinhole(-0.1, 0);
  now.object_to_world = {{1, shifted}, {2, shifted}, {6, kIdentity}};
  previous.object_to_world = {{2, shifted}, {3, shifted}, {6, kIdentity}};
  PassTest pass("back_project");
  pass.input("position", wall());
  pass.input_ids("id", kSize,
                 [](int x, int) { return static_cast<std::uint32_t>(x % 5); });  // 1 and 3 in one table, 0 and 4 in none
  pass.input("camera", now);
  pass.input("previous_camera", previous);
  pass.run();
  expect_motion(pass.output("motion"), 1, 0);
}

TEST(BackProject, GivesNoMotionWhereThereIsNoSurface) {
  PassTest pass("back_project");
  pass.input("position", wall());
  pass.input_ids("id", kSize, [](int, int) { return QUELL_NO_ID; });
  pass.input("camera", pinhole(0, 0));
  pass.input("previous_camera", pinhole(-0.1, 0));
  pass.run();
  expect_motion(pass.output("motion"), 0, 0, 0);
}

TEST(BackProject, SendsPointsBehindThePreviousCameraFarAway) {
  PassTest pass("back_project");
  pass.input("position", wall());
  pass.input("camera", pinhole(0, 0));
  for (const double eye_z : {kDistance + 1, kDistance}) {  // behind, and in the eye's own plane
    pass.input("previous_camera", pinhole(0, 0, eye_z));
    pass.run();
    expect_motion(pass.output("motion"), kFarAway, kFarAway, 0);
  }
}

TEST(BackProject, SendsPointsThatAreNoNumberFarAwayAndLeavesTheirNeighborsAlone) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  Image position = wall();
  const FloatOutput p = position.writable_floats();
  p.at(4, 5, 0) = nan;
  p.at(9, 5, 1) = infinity;
  p.at(20, 5, 2) = infinity;
  p.at(25, 5, 0) = std::numeric_limits<float>::max();
  PassTest pass("back_project");
  pass.input("position", position);
  pass.input("camera", pinhole(0, 0));
  pass.input("previous_camera", pinhole(-0.1, 0));
  pass.run();
  const FloatImage motion = pass.output("motion");
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const bool bad = y == 5 && (x == 4 || x == 9 || x == 20 || x == 25);
      ASSERT_NEAR(motion.at(x, y, 0), bad ? kFarAway : 1, kWallError) << x << "," << y;
      ASSERT_NEAR(motion.at(x, y, 1), bad ? kFarAway : 0, kWallError) << x << "," << y;
    }
}

TEST(BackProject, SendsObjectsWithASingularMatrixFarAway) {
  Camera now = pinhole(0, 0), previous = pinhole(0, 0);
  now.object_to_world = {{1, Matrix{}}};
  previous.object_to_world = {{1, kIdentity}};
  PassTest pass("back_project");
  pass.input("position", wall());
  pass.input_ids("id", kSize, [](int, int) { return 1U; });
  pass.input("camera", now);
  pass.input("previous_camera", previous);
  pass.run();
  expect_motion(pass.output("motion"), kFarAway, kFarAway, 0);
}

TEST(BackProject, StartsFromThePixelsCenterOrFromThePoint) {
  // The samples lie 0.25 pixels right of and below the centers.
  PassTest pass("back_project");
  pass.input("position", wall(kSize, 0.25));
  pass.input("camera", pinhole(0, 0));
  pass.input("previous_camera", pinhole(-0.1, 0));
  pass.run();
  expect_motion(pass.output("motion"), 1.25, 0.25);
  pass.set("current", "projected");
  pass.run();
  expect_motion(pass.output("motion"), 1, 0);
}

TEST(BackProject, LeavesJitterOutOfTheMotion) {
  const auto jittered = [](double x, double y) {
    Camera camera = pinhole(0, 0);
    camera.jitter = {x, y};
    for (std::size_t i = 0; i < 4; ++i) {
      camera.world_to_screen[i] += x * camera.world_to_screen[12 + i];
      camera.world_to_screen[4 + i] += y * camera.world_to_screen[12 + i];
    }
    return camera;
  };
  // With the screen 0.25 px to the right, the sample in a pixel's center is that of 0.25 px to the left without jitter.
  PassTest pass("back_project");
  pass.input("position", wall(kSize, -0.25));
  pass.input("camera", jittered(0.25, 0.25));
  pass.input("previous_camera", jittered(-0.125, 0.4));
  for (const char* current : {"pixel_center", "projected"}) {
    pass.set("current", current);
    pass.run();
    expect_motion(pass.output("motion"), 0, 0);
  }
}

TEST(BackProject, ScalesACameraOfAnotherResolution) {
  constexpr Size kHalf{16, 8}, kCamera{32, 16};
  const Image position = test_image(QUELL_TYPE_POSITION, kHalf, [=](int x, int y, int c) {
    if (c == 2) return static_cast<float>(kDistance);
    const double pixel = c == 0 ? 2 * x + 1 - kCamera.width / 2.0 : 2 * y + 1 - kCamera.height / 2.0;
    return static_cast<float>(pixel * kDistance / kFocal);
  });
  PassTest pass("back_project");
  pass.input("position", position);
  pass.input("camera", pinhole(0, 0, 0, kCamera));
  pass.input("previous_camera", pinhole(-0.1, 0.2, 0, kCamera));
  for (const char* current : {"pixel_center", "projected"}) {
    pass.set("current", current);
    pass.run();
    expect_motion(pass.output("motion"), 0.5, -1);
  }
}

// Solves m x = b by elimination with pivoting: independent of the pass's cofactors.
std::array<long double, 4> solve(const Matrix& m, const std::array<long double, 4>& b) {
  long double a[4][5];
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) a[i][j] = m[static_cast<std::size_t>(4 * i + j)];
    a[i][4] = b[static_cast<std::size_t>(i)];
  }
  for (int k = 0; k < 4; ++k) {
    int pivot = k;
    for (int i = k; i < 4; ++i)
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    std::swap(a[k], a[pivot]);
    for (int i = 0; i < 4; ++i)
      if (i != k)
        for (int j = 4; j >= k; --j) a[i][j] -= a[k][j] * a[i][k] / a[k][k];
  }
  return {a[0][4] / a[0][0], a[1][4] / a[1][1], a[2][4] / a[2][2], a[3][4] / a[3][3]};
}

std::array<long double, 4> multiply(const Matrix& m, const std::array<long double, 4>& v) {
  std::array<long double, 4> product{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 4; ++k) product[i] += m[4 * i + k] * v[k];
  return product;
}

TEST(BackProject, AgreesWithTheFormulaForAnyMatrices) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> spread(-0.2, 0.2);
  const auto near_identity = [&] {
    Matrix m = kIdentity;
    for (double& value : m) value += spread(random);
    return m;
  };
  Camera now = pinhole(0, 0), previous = pinhole(0.3, -0.2, 0.5);
  for (const std::uint32_t id : {0U, 5U, 4000000000U}) {
    now.object_to_world[id] = near_identity();
    previous.object_to_world[id] = near_identity();
  }
  const std::uint32_t ids[] = {5, 0, 4000000000U, 9};
  const Image position = wall();
  PassTest pass("back_project");
  pass.input("position", position);
  pass.input_ids("id", kSize, [&](int x, int y) { return ids[(x + 3 * y) % 4]; });
  pass.input("camera", now);
  pass.input("previous_camera", previous);
  pass.run();
  const FloatImage motion = pass.output("motion"), p = position.floats();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      std::array<long double, 4> world{p.at(x, y, 0), p.at(x, y, 1), p.at(x, y, 2), 1};
      const std::uint32_t id = ids[(x + 3 * y) % 4];
      if (id != 9) world = multiply(previous.object_to_world[id], solve(now.object_to_world[id], world));
      const auto screen = multiply(previous.world_to_screen, world);
      const double want_x = static_cast<double>(screen[0] / screen[3]) - (x + 0.5);
      const double want_y = static_cast<double>(screen[1] / screen[3]) - (y + 0.5);
      // Half a unit in the last place of the float result, and 1e-10 px for the composed matrices in double.
      ASSERT_NEAR(motion.at(x, y, 0), want_x, 6e-8 * std::abs(want_x) + 1e-10) << x << "," << y;
      ASSERT_NEAR(motion.at(x, y, 1), want_y, 6e-8 * std::abs(want_y) + 1e-10) << x << "," << y;
    }
}

QUELL_CONFORMANCE_TEST(back_project)

}  // namespace
}  // namespace quell
