#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"

namespace quell {
namespace {

using Vec = std::array<double, 3>;

Vec pixel(const Image& image, int x, int y) {
  const FloatImage view = image.floats();
  return {view.at(x, y, 0), view.at(x, y, 1), view.at(x, y, 2)};
}
Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double square(double x) { return x * x; }

// The parameters and inputs of a case.
struct Case {
  Size size{33, 17};
  int radius = 3;
  bool world = false;
  bool with_normal = true, with_position = true;
  double sigma_coord = 3, sigma_color = 0.8, sigma_normal = 0.1, sigma_plane = 0.1;
  bool difference = false, z = false, separable = false;
  double sigma_z = 0.2;
};

constexpr double kOff = 1e6;  // a sigma whose term vanishes

struct Scene {
  Image color, normal, position;
};

// Repeatable noise in [0, 1).
double noise(int x, int y, int c) {
  unsigned h =
      static_cast<unsigned>(x) * 374761393u + static_cast<unsigned>(y) * 668265263u + static_cast<unsigned>(c) * 2246822519u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return static_cast<double>((h ^ (h >> 16)) & 0xffffff) / 0x1000000;
}

// A wavy surface far from the origin, with holes, a few fireflies, and columns that face anywhere, even away.
Scene make_scene(Size size) {
  const auto is_hole = [](int x, int y) { return (x / 3 + y / 4) % 5 == 4; };
  const auto normal = [=](int x, int y, int c) {
    if (is_hole(x, y)) return 0.0F;
    const double a = 0.9 * noise(x / 2, y, 7) * (x % 7 == 0 ? 3.4 : 0.3), b = 0.7 * y + 0.2 * noise(x, y, 8);
    const Vec n{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)};
    return static_cast<float>(n[static_cast<std::size_t>(c)]);
  };
  const auto position = [](int x, int y, int c) {
    const Vec p{1e3 + 0.5 * x, -200 + 0.5 * y, 30 + 0.2 * std::sin(x + 0.5 * y) + 0.05 * noise(x, y, 3)};
    return static_cast<float>(p[static_cast<std::size_t>(c)]);
  };
  const auto color = [](int x, int y, int c) {
    return static_cast<float>(2 * noise(x, y, c) + (x % 11 == 5 && y % 5 == 2 ? 40 : 0));
  };
  return {test_image(QUELL_TYPE_COLOR, size, color), test_image(QUELL_TYPE_NORMAL, size, normal),
          test_image(QUELL_TYPE_POSITION, size, position)};
}

Image run(const Case& c, const Scene& scene, int grain = 0, int threads = 1) {
  PassTest pass("joint_bilateral");
  pass.set("radius", c.radius).set("coord", c.world ? "world" : "pixels").set("sigma_coord", c.sigma_coord);
  pass.set("sigma_color", c.sigma_color).set("sigma_normal", c.sigma_normal).set("sigma_plane", c.sigma_plane);
  pass.set("normal_measure", c.difference ? "difference" : "angle").set("surface", c.z ? "z" : "plane");
  pass.set("sigma_z", c.sigma_z).set("separable", c.separable);
  pass.input("color", scene.color).grain(grain).threads(threads);
  if (c.with_normal) pass.input("normal", scene.normal);
  if (c.with_position) pass.input("position", scene.position);
  pass.run();
  return *pass.output_item("color").image();
}

bool same_bits(const Image& a, const Image& b) {
  for (int c = 0; c < a.channels(); ++c)
    for (int y = 0; y < a.height(); ++y)
      if (std::memcmp(a.floats().row(y, c), b.floats().row(y, c), static_cast<std::size_t>(a.width()) * sizeof(float)) != 0)
        return false;
  return true;
}

using Colors = std::function<Vec(int x, int y)>;

double plane_exponent(const Case& c, const Vec& n, const Vec& d) {
  if (!c.with_position || c.z || dot(d, d) == 0) return 0;
  return square(dot(n, d)) / dot(d, d) / (2 * square(c.sigma_plane));
}

// Minus the logarithm of the weight of a tap, from the published formula. Normals of the scene are unit vectors rounded to float;
// the formula is about the vectors meant.
double exponent(const Case& c, const Scene& scene, const Colors& colors, int x, int y, int qx, int qy) {
  const Vec d = pixel(scene.position, qx, qy) - pixel(scene.position, x, y);
  const Vec contrast = colors(qx, qy) - colors(x, y);
  const double distance2 = c.world ? dot(d, d) : square(qx - x) + square(qy - y);
  double e = distance2 / (2 * square(c.sigma_coord)) + dot(contrast, contrast) / (2 * square(c.sigma_color));
  if (c.z && c.with_position) e += square(d[2]) / (2 * square(c.sigma_z));
  if (!c.with_normal) return e;
  const Vec n = pixel(scene.normal, x, y), m = pixel(scene.normal, qx, qy);
  if (dot(n, n) == 0 || dot(m, m) == 0) return std::numeric_limits<double>::infinity();
  if (c.difference) return e + dot(n - m, n - m) / (2 * square(c.sigma_normal)) + plane_exponent(c, n, d);
  const double cosine = dot(n, m) / std::sqrt(dot(n, n) * dot(m, m));
  e += square(std::acos(std::min(1.0, std::max(-1.0, cosine)))) / (2 * square(c.sigma_normal));
  return e + plane_exponent(c, n, d);
}

Vec filtered(const Case& c, const Scene& scene, const Colors& colors, int radius_x, int radius_y, int x, int y) {
  Vec sum{};
  double weights = 0;
  for (int qy = std::max(0, y - radius_y); qy <= std::min(c.size.height - 1, y + radius_y); ++qy)
    for (int qx = std::max(0, x - radius_x); qx <= std::min(c.size.width - 1, x + radius_x); ++qx) {
      const double w = std::exp(-exponent(c, scene, colors, x, y, qx, qy));
      const Vec q = colors(qx, qy);
      weights += w;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += w * q[k];
    }
  if (weights == 0) return colors(x, y);
  return {sum[0] / weights, sum[1] / weights, sum[2] / weights};
}

// Of all pixels, row by row.
std::vector<Vec> reference(const Case& c, const Scene& scene) {
  const auto filter = [&](const Colors& colors, int radius_x, int radius_y) {
    std::vector<Vec> all;
    for (int y = 0; y < c.size.height; ++y)
      for (int x = 0; x < c.size.width; ++x) all.push_back(filtered(c, scene, colors, radius_x, radius_y, x, y));
    return all;
  };
  const Colors own = [&](int x, int y) { return pixel(scene.color, x, y); };
  if (!c.separable) return filter(own, c.radius, c.radius);
  const std::vector<Vec> rows = filter(own, c.radius, 0);
  return filter([&](int x, int y) { return rows[static_cast<std::size_t>(y * c.size.width + x)]; }, 0, c.radius);
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const Size size : {Size{1, 1}, {15, 5}, {16, 4}, {17, 9}, {33, 11}, {64, 2}, {3, 20}, {150, 3}})
    for (const bool world : {false, true}) cases.push_back({.size = size, .world = world});
  for (const bool normal : {false, true})
    for (const bool position : {false, true}) cases.push_back({.with_normal = normal, .with_position = position});
  cases.push_back({.world = true, .with_normal = false});
  cases.push_back({.radius = 0});
  cases.push_back({.radius = 20});                    // wider than the image
  cases.push_back({.size = {40, 12}, .radius = 64});  // the largest
  for (const double angle : {1e-3, 0.01, 0.2, 0.21, 0.5, 1.0, 3.0, 1e3})
    cases.push_back({.sigma_normal = angle, .sigma_plane = 1});
  for (const double sine : {1e-3, 0.01, 1.0, 1e6}) cases.push_back({.sigma_normal = 1, .sigma_plane = sine});
  for (const double radiance : {1e-6, 1e-2, 10.0, 1e6}) cases.push_back({.sigma_color = radiance, .sigma_normal = 0.4});
  for (const double length : {1e-3, 0.3, 1e6})
    for (const bool world : {false, true}) cases.push_back({.world = world, .sigma_coord = length, .sigma_normal = 0.4});
  // Every weight close to 1, so that every tap's error counts.
  cases.push_back({.radius = 12, .sigma_coord = 1e3, .sigma_color = 30, .sigma_normal = 2, .sigma_plane = 2});
  // Angles, and heights over the plane, of weights that are small, but of so many taps that they count.
  cases.push_back({.radius = 16, .sigma_coord = 1e6, .sigma_color = 1e3, .sigma_normal = 0.2, .sigma_plane = 1e6});
  cases.push_back({.radius = 16, .sigma_coord = 1e6, .sigma_color = 1e3, .sigma_normal = 1e6, .sigma_plane = 0.1});
  // The terms of the WebGPU path tracer, which know neither angles nor planes.
  for (const bool normal : {false, true})
    for (const bool position : {false, true})
      cases.push_back({.with_normal = normal, .with_position = position, .sigma_normal = 0.3, .difference = true, .z = true});
  cases.push_back({.world = true, .difference = true, .z = true});
  cases.push_back({.sigma_normal = 0.5, .z = true});
  cases.push_back({.sigma_normal = 0.5, .difference = true});
  for (const Size size : {Size{1, 1}, {15, 5}, {33, 11}, {3, 20}, {150, 10}}) {
    cases.push_back({.size = size, .radius = 5, .separable = true});
    cases.push_back({.size = size, .world = true, .sigma_normal = 0.5, .difference = true, .z = true, .separable = true});
  }
  return cases;
}

// The vector units of this machine that the pass was compiled for, best first.
std::vector<std::int64_t> targets() {
  std::vector<std::int64_t> bits;
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) bits.push_back(left & -left);
  return bits;
}

class JointBilateralOnTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

// 1e-4 is the error that the pass promises, and the budget in its kernel. The absolute part is a rounding of the brightest color.
// Of a filter over rows and then over columns the second compares what the first has made: there, too, it errs by 2e-6 of colors
// of about sigma_color, which changes weights by no more.
TEST_P(JointBilateralOnTarget, MatchesTheFormulaInDoublePrecision) {
  const std::vector<Case> cases = all_cases();
  for (const Case& c : cases) {
    const Scene scene = make_scene(c.size);
    const Image got = run(c, scene);
    const std::vector<Vec> all = reference(c, scene);
    for (int y = 0; y < c.size.height; ++y)
      for (int x = 0; x < c.size.width; ++x) {
        const Vec want = all[static_cast<std::size_t>(y * c.size.width + x)], have = pixel(got, x, y);
        for (std::size_t k = 0; k < 3; ++k)
          ASSERT_NEAR(have[k], want[k], 1e-4 * want[k] + 1e-6) << x << "," << y << " of case " << &c - cases.data();
      }
  }
}

TEST_P(JointBilateralOnTarget, GivesTheSameBitsForAnyBandsAndThreads) {
  const Case c{.size = {150, 40}, .radius = 5};
  const Scene scene = make_scene(c.size);
  const Image whole = run(c, scene, 40);
  for (const int grain : {1, 3, 8, 13})
    for (const int threads : {1, 3})
      EXPECT_TRUE(same_bits(whole, run(c, scene, grain, threads))) << grain << " rows, " << threads;
}

INSTANTIATE_TEST_SUITE_P(All, JointBilateralOnTarget, ::testing::ValuesIn(targets()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

// One flat wall seen from the front, with the color, normal and height that the functions give. Sigmas that are not about what a
// test looks at are so large that their terms vanish.
Scene make_wall(Size size, const std::function<float(int x, int c)>& color, const std::function<Vec(int x)>& normal,
                const std::function<double(int x)>& height) {
  const auto position = [&](int x, int y, int c) { return static_cast<float>(c == 0 ? x : c == 1 ? y : height(x)); };
  return {test_image(QUELL_TYPE_COLOR, size, [&](int x, int, int c) { return color(x, c); }),
          test_image(QUELL_TYPE_NORMAL, size,
                     [&](int x, int, int c) { return static_cast<float>(normal(x)[static_cast<std::size_t>(c)]); }),
          test_image(QUELL_TYPE_POSITION, size, position)};
}
Vec facing(int) { return {0, 0, 1}; }
double flat(int) { return 0; }
float left_dark(int x, int) { return x < 10 ? 1.0F : 5.0F; }

void expect_left_dark(const Image& got) {
  for (int y = 0; y < got.height(); ++y)
    for (int x = 0; x < got.width(); ++x) ASSERT_NEAR(got.floats().at(x, y), left_dark(x, 0), 1e-6 * left_dark(x, 0)) << x;
}

TEST(JointBilateral, LeavesAConstantImageConstant) {
  const Scene scene = make_wall(
      {40, 20}, [](int, int c) { return 0.3F + static_cast<float>(c); }, facing, flat);
  const Image got = run({.radius = 16, .sigma_coord = 8}, scene);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(got.floats().at(x, y, c), 0.3F + static_cast<float>(c), 1e-6 * (1 + c));
}

TEST(JointBilateral, PassesNothingOverARightAngledCrease) {
  const auto crease = [](int x) { return x < 10 ? Vec{1, 0, 0} : Vec{0, 0, 1}; };
  expect_left_dark(
      run({.sigma_coord = kOff, .sigma_color = kOff, .sigma_plane = kOff}, make_wall({20, 9}, left_dark, crease, flat)));
}

TEST(JointBilateral, PassesNothingOverAStepBetweenParallelPlanes) {
  const auto step = [](int x) { return x < 10 ? 0.0 : 100.0; };  // seen from either side the other rises by nearly 90 degrees
  expect_left_dark(run({.sigma_coord = kOff, .sigma_color = kOff}, make_wall({20, 9}, left_dark, facing, step)));
}

TEST(JointBilateral, KeepsAnEdgeOfColor) {
  expect_left_dark(run({.sigma_coord = kOff, .sigma_color = 0.5}, make_wall({20, 9}, left_dark, facing, flat)));
}

TEST(JointBilateral, MixesAcrossAnEdgeThatItIsToldToTolerate) {
  const Image got = run({.radius = 64, .sigma_coord = kOff, .sigma_color = kOff}, make_wall({20, 9}, left_dark, facing, flat));
  EXPECT_NEAR(got.floats().at(3, 4), 3.0, 1e-5);  // 10 columns of 1 and 10 of 5
}

TEST(JointBilateral, KnowsTheAngleOfOppositeNormals) {
  const auto back_to_back = [](int x) { return x == 0 ? Vec{0, 0.6, 0.8} : Vec{0, -0.6, -0.8}; };
  const Scene scene = make_wall(
      {2, 1}, [](int x, int) { return static_cast<float>(x); }, back_to_back, flat);
  const Image got = run({.sigma_coord = kOff, .sigma_color = kOff, .sigma_normal = 1, .sigma_plane = kOff}, scene);
  const double w = std::exp(-std::acos(-1.0) * std::acos(-1.0) / 2);
  EXPECT_NEAR(got.floats().at(0, 0), w / (1 + w), 1e-5 * w);
}

// Without colors and surfaces in the weights the window falls apart into rows and columns; the corner of a bright square does
// not.
TEST(JointBilateral, SeparableIsExactForDistancesAloneAndAnApproximationElse) {
  const auto tilted = [](int x, int y, int c) { return static_cast<float>(x + y > 20 ? 4 + c : 0); };
  Scene scene{test_image(QUELL_TYPE_COLOR, {25, 21}, tilted), {}, {}};
  Case c{.size = {25, 21}, .radius = 4, .with_normal = false, .with_position = false, .sigma_color = 1e6};
  const auto largest_difference = [&] {
    c.separable = false;
    const Image whole = run(c, scene);
    c.separable = true;
    const Image twice = run(c, scene);
    double largest = 0;
    for (int y = 0; y < 21; ++y)
      for (int x = 0; x < 25; ++x)
        largest = std::max(largest, std::abs(double{whole.floats().at(x, y)} - twice.floats().at(x, y)));
    return largest;
  };
  EXPECT_LT(largest_difference(), 4 * 4e-6);  // 2^x errs by 3.8e-6
  c.sigma_color = 3;
  EXPECT_GT(largest_difference(), 0.01);
}

TEST(JointBilateral, PassesNothingOverAStepInZWhereToldSo) {
  const auto step = [](int x) { return x < 10 ? 0.0 : 1.0; };
  const Case c{.sigma_coord = kOff, .sigma_color = kOff, .z = true, .sigma_z = 0.1};
  expect_left_dark(run(c, make_wall({20, 9}, left_dark, facing, step)));
}

TEST(JointBilateral, LeavesAnImageOfBackgroundAsItIs) {
  const Scene scene = make_wall(
      {20, 9}, left_dark, [](int) { return Vec{}; }, flat);
  EXPECT_TRUE(same_bits(run({}, scene), scene.color));
}

TEST(JointBilateral, IsTheIdentityWithRadius0) {
  Case c{.radius = 0};
  const Scene scene = make_scene(c.size);
  EXPECT_TRUE(same_bits(run(c, scene), scene.color));
  c.with_normal = c.with_position = false;
  EXPECT_TRUE(same_bits(run(c, scene), scene.color));
}

// Only its own pixel shows it; for the others it is as if there were no surface.
TEST(JointBilateral, LeavesOutATapThatIsNotFinite) {
  const Case c;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Scene broken = make_scene(c.size), hole = make_scene(c.size);
    ASSERT_NE(hole.normal.floats().at(6, 6, 2), 0.0F);
    broken.color.writable_floats().at(6, 6, 1) = bad;
    for (int k = 0; k < 3; ++k) hole.normal.writable_floats().at(6, 6, k) = 0;
    Image got = run(c, broken);
    EXPECT_TRUE(std::isnan(bad) ? std::isnan(got.floats().at(6, 6, 1)) : got.floats().at(6, 6, 1) == bad);
    got.writable_floats().at(6, 6, 1) = hole.color.floats().at(6, 6, 1);
    EXPECT_TRUE(same_bits(got, run(c, hole)));
  }
}

TEST(JointBilateral, RefusesDistancesInTheWorldWithoutPositions) {
  const Case c{.world = true, .with_position = false};
  EXPECT_THAT([&] { run(c, make_scene(c.size)); },
              ::testing::ThrowsMessage<Error>(::testing::HasSubstr("the input 'position' is absent")));
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(joint_bilateral);
QUELL_CONFORMANCE_TEST(joint_bilateral, .set("radius", 2).set("coord", "world"));
QUELL_CONFORMANCE_TEST(joint_bilateral, .set("radius", 3).set("sigma_normal", 0.5));
QUELL_CONFORMANCE_TEST(joint_bilateral, .set("radius", 3).set("normal_measure", "difference").set("surface", "z"));
QUELL_CONFORMANCE_TEST(joint_bilateral, .set("radius", 3).set("separable", true));
