// back_project where positions are absent: motion from depth is that from positions.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "quell/sequence/sequence.h"
#include "quell/testing/pass_test.h"
#include "quell/testing/synthetic.h"
#include "quell/text/error.h"
#include "tests/passes/posed_camera.h"

namespace quell {
namespace {

using test::PosedCamera;
using test::Vector;

constexpr float kFarAway = 1e6F;

float depth_at(int x, int y) { return 7.0F + 0.31F * static_cast<float>((3 * x + 5 * y) % 11); }  // 7 to 10.1
std::uint32_t id_at(int x, int y) { return static_cast<std::uint32_t>((x / 5 + y / 4) % 3); }

// Turned by 0.3 rad about z at (0.5, -0.2), and moved toward the camera.
Matrix turned() {
  return {std::cos(0.3), -std::sin(0.3), 0, 0.5, std::sin(0.3), std::cos(0.3), 0, -0.2, 0, 0, 1, 0.4, 0, 0, 0, 1};
}
Vector times(const Matrix& m, const Vector& p) {
  Vector product;
  for (std::size_t i = 0; i < 3; ++i) product[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
  return product;
}

struct Views {
  std::string name;
  PosedCamera now, previous;
};
void PrintTo(const Views& views, std::ostream* stream) { *stream << views.name; }

std::vector<Views> all_views() {
  const PosedCamera now{.eye = {0.3, -0.4, 1.5}, .yaw = 0.2, .pitch = -0.15};
  const PosedCamera previous{.eye = {0.1, -0.2, 0.5}, .yaw = 0.23, .pitch = -0.1};
  std::vector<Views> all{{"perspective", now, previous}};
  const auto add = [&](const std::string& name, auto&& change) {
    for (const bool orthographic : {false, true}) {
      Views views{name + (orthographic ? "_orthographic" : ""), now, previous};
      views.now.orthographic = views.previous.orthographic = orthographic;
      change(views.now), change(views.previous);
      all.push_back(views);
    }
  };
  add("plain", [](PosedCamera&) {});
  add("as_opengl", [](PosedCamera& camera) { camera.z_sign = -1; });
  add("scaled_matrix", [](PosedCamera& camera) { camera.w_scale = 2.5; });
  add("jittered", [&](PosedCamera& camera) {
    camera.jitter = camera.yaw == now.yaw ? std::array<double, 2>{0.25, -0.4} : std::array<double, 2>{-0.3, 0.1};
  });
  return all;
}

class FromDepth : public ::testing::TestWithParam<Views> {};

// Depths are exact, so what is left is the motion's own rounding, 2^-24 of at most 128 px, and little of the matrices in double.
// Positions below 16 are off by 2^-21 in each of three directions. Points move by at most 1.5 and so lay 5.5 or more away, where
// a world unit is 100 / 5.5 px; in an orthographic camera it is 100 px.
constexpr double kDepthError = 8e-6;

TEST_P(FromDepth, IsTheMotionThatThePoseTellsAndThatPositionsGive) {
  const auto& [name, now, previous] = GetParam();
  Camera camera = now.camera(), previous_camera = previous.camera();
  camera.object_to_world = {{1, turned()}, {2, kIdentity}};
  previous_camera.object_to_world = {{1, kIdentity}, {2, kIdentity}};
  // What is turned now was not one frame ago: its points came from the inverse, by the transpose of the rotation.
  const Matrix m = turned();
  const Matrix back{m[0], m[4], 0, -(m[0] * m[3] + m[4] * m[7]), m[1], m[5], 0, -(m[1] * m[3] + m[5] * m[7]), 0, 0, 1, -m[11], 0,
                    0,    0,    1};
  const PosedCamera& camera_now = now;  // a structured binding cannot be captured
  const auto point = [&](int x, int y) { return camera_now.point(x + 0.5, y + 0.5, double{depth_at(x, y)}); };
  const Size size = now.size;
  const Image position = test_image(QUELL_TYPE_POSITION, size, [&](int x, int y, int c) {
    return static_cast<float>(point(x, y)[static_cast<std::size_t>(c)]);
  });
  PassTest by_depth("back_project"), by_position("back_project");
  by_depth.input("depth", test_image(QUELL_TYPE_DEPTH, size, [](int x, int y, int) { return depth_at(x, y); }));
  by_position.input("position", position);
  const double position_error = kDepthError + 8.3e-7 * (now.orthographic ? 100 : 100 / 5.5);
  for (PassTest* pass : {&by_depth, &by_position}) {
    pass->input_ids("id", size, id_at).input("camera", camera).input("previous_camera", previous_camera);
    pass->run();
  }
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Vector before = id_at(x, y) == 1 ? times(back, point(x, y)) : point(x, y);
      const auto was = previous.pixel(before);
      for (int c = 0; c < 2; ++c) {
        const double center = (c == 0 ? x : y) + 0.5 - now.jitter[static_cast<std::size_t>(c)];
        const double got = by_depth.output("motion").at(x, y, c);
        ASSERT_NEAR(got, was[static_cast<std::size_t>(c)] - center, kDepthError) << x << "," << y;
        ASSERT_NEAR(got, by_position.output("motion").at(x, y, c), kDepthError + position_error) << x << "," << y;
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Cameras, FromDepth, ::testing::ValuesIn(all_views()),
                         [](const auto& views) { return views.param.name; });

TEST(BackProjectFromDepth, ScalesACameraOfAnotherResolution) {
  PosedCamera now{.eye = {0, 0, 1}}, previous{.eye = {0.2, 0.1, 0.5}};
  now.jitter = {0.5, -0.25};
  PassTest whole("back_project"), half("back_project");
  for (const auto& [pass, size] : {std::pair(&whole, Size{32, 16}), std::pair(&half, Size{16, 8})}) {
    now.size = previous.size = {32, 16};
    pass->input("depth", test_image(QUELL_TYPE_DEPTH, size, [](int, int, int) { return 8.0F; }));
    pass->input("camera", now.camera()).input("previous_camera", previous.camera());
    pass->run();
  }
  // The motion on a wall is affine in the place: the half's pixel has the mean of its four, in pixels twice as large.
  for (int c = 0; c < 2; ++c)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x) {
        double mean = 0;
        for (int i = 0; i < 4; ++i) mean += whole.output("motion").at(2 * x + i % 2, 2 * y + i / 2, c) / 4.0;
        ASSERT_NEAR(half.output("motion").at(x, y, c), mean / 2, 1e-6) << x << "," << y;
      }
}

TEST(BackProjectFromDepth, GivesNoMotionWithoutSurfaceAndSendsWhatIsNoNumberFarAway) {
  const PosedCamera now{}, previous{.eye = {0.1, 0, 0}};
  Image depth = test_image(QUELL_TYPE_DEPTH, now.size, [](int x, int, int) { return x > 20 ? QUELL_NO_SURFACE_DEPTH : 10.0F; });
  depth.writable_floats().at(3, 2) = std::numeric_limits<float>::quiet_NaN();
  depth.writable_floats().at(4, 2) = std::numeric_limits<float>::infinity();
  PassTest pass("back_project");
  pass.input("depth", depth).input("camera", now.camera()).input("previous_camera", previous.camera());
  pass.run();
  for (int y = 0; y < now.size.height; ++y)
    for (int x = 0; x < now.size.width; ++x) {
      const bool bad = y == 2 && (x == 3 || x == 4);
      ASSERT_NEAR(pass.output("motion").at(x, y, 0), bad ? kFarAway : x > 20 ? 0 : -1, 1e-6) << x << "," << y;
      ASSERT_NEAR(pass.output("motion").at(x, y, 1), bad ? kFarAway : 0, 1e-6) << x << "," << y;
    }
}

TEST(BackProjectFromDepth, IsNotLookedAtWherePositionsAreGiven) {
  PassTest pass("back_project");
  for (const PortType type : {QUELL_TYPE_POSITION, QUELL_TYPE_ID}) pass.input(info(type).name, synthetic(type, {37, 19}));
  pass.input("camera", synthetic(QUELL_TYPE_CAMERA, {37, 19}))
      .input("previous_camera", synthetic(QUELL_TYPE_CAMERA, {37, 19}, 1));
  pass.run();
  const Item want = pass.output_item("motion");
  pass.input("depth", synthetic(QUELL_TYPE_DEPTH, {37, 19}));
  pass.run();
  for (int c = 0; c < 2; ++c)
    for (int y = 0; y < 19; ++y)
      for (int x = 0; x < 37; ++x) ASSERT_EQ(pass.output("motion").at(x, y, c), want.image()->floats().at(x, y, c));
}

TEST(BackProjectFromDepth, GivesTheSameBitsForAnyThreadsAndChunks) {
  PassTest pass("back_project");
  for (const PortType type : {QUELL_TYPE_DEPTH, QUELL_TYPE_ID}) pass.input(info(type).name, synthetic(type, {37, 19}));
  pass.input("camera", synthetic(QUELL_TYPE_CAMERA, {37, 19}))
      .input("previous_camera", synthetic(QUELL_TYPE_CAMERA, {37, 19}, 1));
  pass.run();
  const Item want = pass.output_item("motion");
  for (const int grain : {1, 3, 64}) {
    pass.grain(grain).threads(3);
    pass.run();
    for (int c = 0; c < 2; ++c)
      for (int y = 0; y < 19; ++y)
        for (int x = 0; x < 37; ++x) ASSERT_EQ(pass.output("motion").at(x, y, c), want.image()->floats().at(x, y, c));
  }
}

TEST(BackProject, NamesBothPortsWhenNeitherIsConnected) {
  PassTest pass("back_project");
  pass.input("camera", PosedCamera{}.camera()).input_ids("id", {4, 3}, id_at);
  try {
    pass.run();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::usage);
    EXPECT_NE(std::string(error.what()).find("'position'"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("'depth'"), std::string::npos) << error.what();
  }
}

// The files hold positions and depths rounded to 2^-14 m, and the samples lie some 0.005 px beside their pixels' centers. From
// positions the motion therefore is that of `projected`, which starts at the sample as well, so that what is off in a point moves
// both ends alike; what is left is how much more one end moves than the other. The room's camera comes some 2 % closer a frame,
// and its turning head turns by 0.105 rad: 13 % of 0.01 px (twice the spread), and of the 533 px / depth times 9.1e-5 m (both
// roundings, along the diagonal) that a point is off by.
TEST(BackProjectFromDepth, IsThatFromPositionsOnARenderedRoom) {
  const std::filesystem::path room = QUELL_SOURCE_DIR "/../shared/data/room";
  if (!std::filesystem::exists(room)) GTEST_SKIP() << "the rendered room is not there: " << room;
  const auto sequence = Sequence::open(room);
  for (const auto& [input, type] : {std::pair("position", QUELL_TYPE_POSITION), std::pair("depth", QUELL_TYPE_DEPTH),
                                    std::pair("id", QUELL_TYPE_ID), std::pair("camera", QUELL_TYPE_CAMERA)})
    sequence->expect(input, type);
  BufferPool pool;
  double worst = 0, largest = 0;
  for (const std::int64_t frame : {2, 7, 12}) {
    PassTest by_depth("back_project"), by_position("back_project");
    const Item depth = sequence->read("depth", frame, pool);
    by_depth.input("depth", depth);
    by_position.set("current", "projected").input("position", sequence->read("position", frame, pool));
    for (PassTest* pass : {&by_depth, &by_position}) {
      pass->input("id", sequence->read("id", frame, pool)).input("camera", sequence->read("camera", frame, pool));
      pass->input("previous_camera", sequence->read("camera", frame - 1, pool));
      pass->run();
    }
    const FloatImage got = by_depth.output("motion"), want = by_position.output("motion"), z = depth.image()->floats();
    for (int y = 0; y < got.height; ++y)
      for (int x = 0; x < got.width; ++x)
        for (int c = 0; c < 2; ++c) {
          const double tolerance = 0.13 * (0.01 + 533 * 9.1e-5 / z.at(x, y));
          ASSERT_NEAR(got.at(x, y, c), want.at(x, y, c), tolerance) << "frame " << frame << ", " << x << "," << y;
          worst = std::max(worst, std::abs(double{got.at(x, y, c)} - want.at(x, y, c)));
          largest = std::max(largest, std::abs(double{want.at(x, y, c)}));
        }
  }
  std::printf("motion up to %.2f px; that from depth differs by up to %.4f px\n", largest, worst);
  EXPECT_GT(largest, 3);
}

}  // namespace
}  // namespace quell
