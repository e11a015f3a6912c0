#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/testing/synthetic.h"
#include "quell/text/error.h"
#include "tests/passes/posed_camera.h"

namespace quell {
namespace {

using test::PosedCamera;
using test::Vector;

constexpr Size kSize{33, 17};

const PosedCamera kNow{.eye = {0.3, -0.4, 1.5}, .yaw = 0.2, .pitch = -0.15, .size = kSize};
const PosedCamera kBefore{.eye = {0.1, -0.2, 0.5}, .yaw = 0.23, .pitch = -0.1, .size = kSize};

float depth_at(int x, int y) { return 7.0F + 0.31F * static_cast<float>((3 * x + 5 * y) % 11); }
std::uint32_t id_at(int x, int y) { return static_cast<std::uint32_t>((x / 5 + y / 4) % 3); }

Image depths() {
  return test_image(QUELL_TYPE_DEPTH, kSize, [](int x, int y, int) { return depth_at(x, y); });
}
Image positions(const PosedCamera& camera) {
  return test_image(QUELL_TYPE_POSITION, kSize, [&](int x, int y, int c) {
    return static_cast<float>(camera.point(x + 0.5, y + 0.5, double{depth_at(x, y)})[static_cast<std::size_t>(c)]);
  });
}
Vector at(const FloatImage& image, int x, int y) { return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)}; }

// Turned about z by an angle, then shifted; and the same undone by sine and cosine, without a matrix.
constexpr double kAngle = 0.3;
constexpr Vector kShift{0.5, -0.2, 0.4};
Matrix turned() {
  const double c = std::cos(kAngle), s = std::sin(kAngle);
  return {c, -s, 0, kShift[0], s, c, 0, kShift[1], 0, 0, 1, kShift[2], 0, 0, 0, 1};
}
Vector turned_back(const Vector& p) {
  const double c = std::cos(kAngle), s = std::sin(kAngle);
  const Vector q = test::sum(p, -1, kShift);
  return {c * q[0] + s * q[1], -s * q[0] + c * q[1], q[2]};
}

// Object 1 stood at the world's origin one frame ago; 2 rests; 0 is in no table.
std::pair<Camera, Camera> cameras(const PosedCamera& now, const PosedCamera& before) {
  std::pair<Camera, Camera> both{now.camera(), before.camera()};
  both.first.object_to_world = {{1, turned()}, {2, turned()}};
  both.second.object_to_world = {{1, kIdentity}, {2, turned()}};
  return both;
}

// Numbers below 16, computed in double and rounded once.
constexpr double kRounding = 16.0 / (1 << 24);

TEST(PreviousPosition, CarriesPointsBackWithTheirObjects) {
  const Image position = positions(kNow);
  const auto [camera, previous] = cameras(kNow, kBefore);
  PassTest pass("previous_position");
  pass.input("position", position).input_ids("id", kSize, id_at).input("camera", camera).input("previous_camera", previous);
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const Vector now = at(position.floats(), x, y), want = id_at(x, y) == 1 ? turned_back(now) : now;
      const Vector got = at(pass.output("position"), x, y);
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(got[c], want[c], id_at(x, y) == 1 ? kRounding : 0) << x << "," << y;  // what rests keeps its bits
      ASSERT_NEAR(pass.output("depth").at(x, y), kBefore.depth(want), kRounding) << x << "," << y;
    }
}

// From depth the points are exact, from positions off by kRounding / 2 a coordinate.
TEST(PreviousPosition, KnowsTheSameFromDepthForEveryKindOfCamera) {
  for (const bool orthographic : {false, true})
    for (const double z_sign : {1.0, -1.0})
      for (const double w_scale : {1.0, 2.5}) {
        SCOPED_TRACE(std::to_string(orthographic) + " " + std::to_string(z_sign) + " " + std::to_string(w_scale));
        PosedCamera now = kNow, before = kBefore;
        for (PosedCamera* camera : {&now, &before})
          camera->orthographic = orthographic, camera->z_sign = z_sign, camera->w_scale = w_scale;
        now.jitter = {0.25, -0.4}, before.jitter = {-0.3, 0.1};
        const auto [camera, previous] = cameras(now, before);
        PassTest pass("previous_position");
        pass.input("depth", depths()).input_ids("id", kSize, id_at).input("camera", camera).input("previous_camera", previous);
        pass.run();
        for (int y = 0; y < kSize.height; ++y)
          for (int x = 0; x < kSize.width; ++x) {
            const Vector here = now.point(x + 0.5, y + 0.5, double{depth_at(x, y)});
            const Vector want = id_at(x, y) == 1 ? turned_back(here) : here, got = at(pass.output("position"), x, y);
            for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(got[c], want[c], kRounding) << x << "," << y;
            ASSERT_NEAR(pass.output("depth").at(x, y), before.depth(want), kRounding) << x << "," << y;
          }
      }
}

TEST(PreviousPosition, GivesWhatIsNowWithoutPreviousCamera) {
  const Image position = positions(kNow);
  PassTest pass("previous_position");
  pass.input("position", position).input_ids("id", kSize, id_at).input("camera", cameras(kNow, kNow).first);
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      ASSERT_EQ(at(pass.output("position"), x, y), at(position.floats(), x, y)) << x << "," << y;
      ASSERT_NEAR(pass.output("depth").at(x, y), depth_at(x, y), 2 * kRounding) << x << "," << y;
    }
}

TEST(PreviousPosition, TellsNoSurfaceWhereThereIsNoneAndWhatLayBehindTheCamera) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  Image position = test_image(QUELL_TYPE_POSITION, kSize, [](int, int, int c) { return c == 2 ? 3.0F : 0.5F; });
  const FloatOutput p = position.writable_floats();
  p.at(1, 0, 0) = nan, p.at(2, 0, 1) = infinity, p.at(3, 0, 2) = -nan, p.at(4, 0, 2) = std::numeric_limits<float>::max();
  PassTest pass("previous_position");
  Camera now = PosedCamera{}.camera(), before = PosedCamera{.eye = {0, 0, 5}}.camera();
  now.object_to_world[9] = Matrix{}, before.object_to_world[9] = kIdentity;  // singular
  pass.input("position", position).input("camera", now).input("previous_camera", before);
  pass.input_ids("id", kSize, [](int x, int y) { return y == 1 ? QUELL_NO_ID : y == 2 && x == 7 ? 9U : 0U; });
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const bool none = (y == 0 && x >= 1 && x <= 4) || y == 1 || (y == 2 && x == 7);
      ASSERT_EQ(pass.output("depth").at(x, y), none ? QUELL_NO_SURFACE_DEPTH : -2.0F) << x << "," << y;
      ASSERT_EQ(at(pass.output("position"), x, y), none ? Vector{} : (Vector{0.5, 0.5, 3})) << x << "," << y;
    }

  pass.disconnect("position");
  pass.input("depth", test_image(QUELL_TYPE_DEPTH, kSize, [](int x, int, int) { return x % 2 ? QUELL_NO_SURFACE_DEPTH : 3.0F; }));
  pass.run();
  EXPECT_EQ(pass.output("depth").at(3, 8), QUELL_NO_SURFACE_DEPTH);
  EXPECT_EQ(at(pass.output("position"), 3, 8), Vector{});
  EXPECT_EQ(pass.output("depth").at(4, 8), -2.0F);
}

// A wall comes from depth 10 to 8: a fifth, where reproject tolerates a fiftieth.
TEST(PreviousPosition, KeepsTheHistoryOfWhatMovesTowardTheCamera) {
  const PosedCamera pinhole{.size = kSize};
  const auto wall = [](float depth) { return test_image(QUELL_TYPE_DEPTH, kSize, [=](int, int, int) { return depth; }); };
  Camera now = pinhole.camera(), before = pinhole.camera();
  now.object_to_world[1] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -2, 0, 0, 0, 1};
  before.object_to_world[1] = kIdentity;
  PassTest back("previous_position"), motion("back_project");
  for (PassTest* pass : {&back, &motion}) {
    pass->input("depth", wall(8)).input_ids("id", kSize, [](int, int) { return 1U; });
    pass->input("camera", now).input("previous_camera", before);
    pass->run();
  }
  const auto share_with_history = [&](const Item& depth) {
    PassTest reproject("reproject");
    reproject.input("history", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 1.0F; }));
    reproject.input("motion", motion.output_item("motion")).input("depth", depth).input("previous_depth", wall(10));
    reproject.run();
    double sum = 0;
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) sum += reproject.output("valid").at(x, y);
    return sum / (kSize.width * kSize.height);
  };
  EXPECT_EQ(share_with_history(wall(8)), 0);
  EXPECT_EQ(share_with_history(back.output_item("depth")), 1);
}

TEST(PreviousPosition, NamesBothPortsWhenNeitherIsConnected) {
  PassTest pass("previous_position");
  pass.input("camera", kNow.camera()).input_ids("id", kSize, id_at);
  try {
    pass.run();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::usage);
    EXPECT_NE(std::string(error.what()).find("'position', or 'depth'"), std::string::npos) << error.what();
  }
}

TEST(PreviousPosition, GivesTheSameBitsFromDepthForAnyThreadsAndChunks) {
  const auto [camera, previous] = cameras(kNow, kBefore);
  PassTest pass("previous_position");
  pass.input("depth", depths()).input_ids("id", kSize, id_at).input("camera", camera).input("previous_camera", previous);
  pass.run();
  const Item position = pass.output_item("position"), depth = pass.output_item("depth");
  for (const int grain : {1, 3, 64}) {
    pass.grain(grain).threads(3);
    pass.run();
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        ASSERT_EQ(at(pass.output("position"), x, y), at(position.image()->floats(), x, y));
        ASSERT_EQ(pass.output("depth").at(x, y), depth.image()->floats().at(x, y));
      }
  }
}

QUELL_CONFORMANCE_TEST(previous_position)

}  // namespace
}  // namespace quell
