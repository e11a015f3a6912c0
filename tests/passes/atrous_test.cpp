#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "tests/passes/atrous_reference.h"

namespace quell::atrous_test {
namespace {

struct Result {
  Image color, variance;
};

Result run(const Case& c, const Scene& scene, int grain = 0, int threads = 1) {
  PassTest pass("atrous");
  pass.set("level", c.level).set("stops", c.stops).set("phi_color_per_level", c.phi_color_per_level);
  for (const auto& [name, value] : c.params) pass.set(name, value);
  for (const auto& [name, image] : scene) pass.input(name, image);
  pass.grain(grain).threads(threads).run();
  return {*pass.output_item("color").image(), *pass.output_item("variance").image()};
}

bool same_bits(const Image& a, const Image& b) {
  for (int c = 0; c < a.channels(); ++c)
    for (int y = 0; y < a.height(); ++y)
      if (std::memcmp(a.floats().row(y, c), b.floats().row(y, c), static_cast<std::size_t>(a.width()) * sizeof(float)) != 0)
        return false;
  return true;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const char* stops : {"svgf", "dammertz", "joint_bilateral"}) {
    for (const Size size : {Size{1, 1}, {2, 1}, {1, 2}, {15, 5}, {16, 4}, {17, 9}, {64, 2}, {3, 40}, {150, 3}})
      cases.push_back({.stops = stops, .size = size});
    for (const int level : {1, 2, 3, 4, 7}) cases.push_back({.stops = stops, .level = level, .size = {75, 43}});
    cases.push_back({.stops = stops, .level = 4, .size = {1100, 5}});  // more than one tile
    for (const char* input : {"normal", "position", "depth", "variance"})
      cases.push_back({.stops = stops, .without = {input, "depth_gradient", "blurred_variance"}});
    cases.push_back(
        {.stops = stops, .without = {"normal", "position", "depth", "depth_gradient", "variance", "blurred_variance"}});
    cases.push_back({.stops = stops, .level = 1, .without = {}});
  }
  const auto with = [&](const std::string& stops, const std::string& name, const std::vector<double>& values) {
    for (const double value : values) cases.push_back({.stops = stops, .level = 1, .size = {40, 20}, .params = {{name, value}}});
  };
  with("svgf", "sigma_z", {0, 0.1, 10, 1e6});
  with("svgf", "eps_z", {0, 1e-8, 1e-3, 1});
  with("svgf", "sigma_n", {1, 2, 10.5, 63, 64, 65, 300});
  with("svgf", "sigma_l", {0, 0.1, 100, 1e6});
  with("svgf", "eps_l", {0, 0.3});
  with("svgf", "eps_variance", {1e-10, 0.1});
  for (const char* name : {"phi_color", "phi_normal", "phi_position"}) with("dammertz", name, {1e-6, 1e-2, 100, 1e12});
  for (const char* change : {"same", "halved"}) cases.push_back({.stops = "dammertz", .level = 2, .phi_color_per_level = change});
  with("joint_bilateral", "sigma_coord", {1e-3, 2, 1e6});
  with("joint_bilateral", "sigma_color", {1e-6, 1e-2, 10, 1e6});
  with("joint_bilateral", "sigma_normal", {1e-3, 0.01, 0.2, 0.21, 3, 1e3});
  with("joint_bilateral", "sigma_plane", {0.02, 1, 1e6});
  return cases;
}

// The vector units of this machine that the pass was compiled for, best first.
std::vector<std::int64_t> targets() {
  std::vector<std::int64_t> bits;
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) bits.push_back(left & -left);
  return bits;
}

class AtrousOnTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

struct Expected {
  Case c;
  Scene scene;
  std::vector<Reference::Filtered> pixels;
};
Expected expected_of(const Case& c, const Scene& scene) {
  Expected expected{c, scene, {}};
  const Reference reference(c, scene);
  for (int y = 0; y < c.size.height; ++y)
    for (int x = 0; x < c.size.width; ++x) expected.pixels.push_back(reference.filter(x, y));
  return expected;
}
// 1e-4 is the error that the pass promises, and the budget in its kernel. The absolute part is a rounding of the brightest color.
void expect_matches(const Expected& expected, const std::string& name) {
  const Size size = expected.c.size;
  const Result got = run(expected.c, expected.scene);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Reference::Filtered& want = expected.pixels[static_cast<std::size_t>(y * size.width + x)];
      const auto where = [&, px = x, py = y] { return std::to_string(px) + "," + std::to_string(py) + " of " + name; };
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_NEAR(pixel(got.color, x, y)[k], want.color[k], 1e-4 * want.color[k] + 1e-6) << where();
      ASSERT_NEAR(got.variance.floats().at(x, y), want.variance, 2e-4 * want.variance + 1e-8) << where();
    }
}

TEST_P(AtrousOnTarget, MatchesTheFormulasInDoublePrecision) {
  static const std::vector<Expected> kAll = [] {
    std::vector<Expected> all;
    for (const Case& c : all_cases()) all.push_back(expected_of(c, make_scene(c)));
    return all;
  }();
  for (const Expected& expected : kAll) expect_matches(expected, "case " + std::to_string(&expected - kAll.data()));
}

// Along the lines of equal depth the slopes of x and y cancel, and what they leave must be exact: it is compared with eps_z.
TEST_P(AtrousOnTarget, MatchesTheFormulasAlongADiagonalSlope) {
  for (const int level : {0, 4, 6}) {
    const Case c{.level = level, .size = {150, 150}, .without = {"depth_gradient", "blurred_variance", "variance"}};
    Scene scene = make_scene(c);
    scene.insert_or_assign("depth", test_image(QUELL_TYPE_DEPTH, c.size, [](int x, int y, int) {
                             return static_cast<float>(10 + 0.013 * x - 0.026 * y + 1e-6 * noise(x, y, 3));
                           }));
    expect_matches(expected_of(c, scene), "level " + std::to_string(level));
  }
}

// On a bent surface a firefly may be all that counts for pixels around it, however small its weight is, and however few of that
// weight's digits are right. As bright as the pass promises.
TEST_P(AtrousOnTarget, MatchesTheFormulasAroundFireflies) {
  for (const auto& [power, bright] : {std::pair{64.0, 10.0}, {128.0, 1000.0}}) {
    const Case c{.level = 1, .size = {80, 60}, .without = {"depth_gradient", "depth"}, .params = {{"sigma_n", power}}};
    Scene scene = make_scene(c);
    const auto color = [factor = bright](int x, int y, int k) {
      return static_cast<float>((noise(x, y, k) + 1) * (noise(x, y, 9) < 0.05 ? factor : 1));
    };
    const auto normal = [](int x, int y, int k) {
      const double a = 0.6 * noise(x, y, 5), b = 7 * noise(x, y, 6);
      return static_cast<float>(Vec{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)}[std::size_t(k)]);
    };
    scene.insert_or_assign("color", test_image(QUELL_TYPE_COLOR, c.size, color));
    scene.insert_or_assign("normal", test_image(QUELL_TYPE_NORMAL, c.size, normal));
    for (const float variance : {0.0F, 1e6F, 1e29F}) {
      scene.insert_or_assign("blurred_variance",
                             test_image(QUELL_TYPE_VARIANCE, c.size, [=](int, int, int) { return variance; }));
      expect_matches(expected_of(c, scene), "power " + std::to_string(power) + ", variance " + std::to_string(variance));
    }
  }
}

TEST_P(AtrousOnTarget, GivesTheSameBitsForAnyBandsAndThreads) {
  for (const char* stops : {"svgf", "dammertz", "joint_bilateral"}) {
    const Case c{.stops = stops, .level = 2, .size = {150, 41}};
    const Scene scene = make_scene(c);
    const Result whole = run(c, scene, 41);
    for (const int grain : {1, 3, 8, 13})
      for (const int threads : {1, 3}) {
        const Result banded = run(c, scene, grain, threads);
        EXPECT_TRUE(same_bits(whole.color, banded.color)) << stops << ", " << grain << " rows, " << threads;
        EXPECT_TRUE(same_bits(whole.variance, banded.variance)) << stops << ", " << grain << " rows, " << threads;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(All, AtrousOnTarget, ::testing::ValuesIn(targets()),
                         [](const auto& target) { return std::string(hwy::TargetName(target.param)); });

// An image without any edge-stopping input.
Result blur(const Image& color, int level, const Image* variance = nullptr) {
  PassTest pass("atrous");
  pass.set("level", level).set("sigma_l", 1e6).input("color", color);
  if (variance)
    pass.input("variance", *variance).input("blurred_variance", test_image(QUELL_TYPE_VARIANCE, color.size(), [](int, int, int) {
                                              return 1e18F;
                                            }));
  pass.run();
  return {*pass.output_item("color").image(), *pass.output_item("variance").image()};
}
Image impulse(Size size, int x, int y) {
  return test_image(QUELL_TYPE_COLOR, size, [=](int px, int py, int) { return px == x && py == y ? 1.0F : 0.0F; });
}

TEST(Atrous, HasEachOf25OffsetsOnceAndWeightsThatSumTo1) {
  for (const int level : {0, 1, 3}) {
    const int step = 1 << level, middle = 4 * step, size = 2 * middle + 1;  // no window of a pixel that sees the impulse is cut
    const Result got = blur(impulse({size, size}, middle, middle), level);
    int offsets = 0;
    double sum = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        if (const double w = got.color.floats().at(x, y); w != 0) {
          ++offsets, sum += w;
          ASSERT_TRUE((x - middle) % step == 0 && (y - middle) % step == 0) << x << "," << y;
        }
    EXPECT_EQ(offsets, 25);
    EXPECT_NEAR(sum, 1, 1e-6);
  }
}

// The closed form: in one dimension, five levels multiply the polynomials of (1 4 6 4 1) / 16 at x, x^2, x^4, x^8 and x^16.
TEST(Atrous, SpreadsAnImpulseOverFiveLevelsAsTheClosedFormSays) {
  constexpr int kReach = 2 * 31, kSize = 4 * kReach + 1;
  std::vector<long long> row(2 * kReach + 1);
  row[kReach] = 1;
  for (int level = 0; level < 5; ++level) {
    std::vector<long long> next(row.size());
    for (int x = 0; x < static_cast<int>(row.size()); ++x)
      for (int k = -2; k <= 2; ++k)
        if (const int q = x + k * (1 << level); q >= 0 && q < static_cast<int>(row.size()))
          next[static_cast<std::size_t>(x)] += row[static_cast<std::size_t>(q)] * (k == 0 ? 6 : std::abs(k) == 1 ? 4 : 1);
    row = next;
  }
  Image color = impulse({kSize, kSize}, kSize / 2, kSize / 2);
  for (int level = 0; level < 5; ++level) color = blur(color, level).color;
  const double scale = std::pow(2.0, -20);
  for (int y = -kReach; y <= kReach; ++y)
    for (int x = -kReach; x <= kReach; ++x) {
      const double want = scale * static_cast<double>(row[static_cast<std::size_t>(x + kReach)]) * scale *
                          static_cast<double>(row[static_cast<std::size_t>(y + kReach)]);
      // A level's weights err by 3.8e-6, being powers of two.
      ASSERT_NEAR(color.floats().at(kSize / 2 + x, kSize / 2 + y), want, 5 * 3.8e-6 * want + 1e-12) << x << "," << y;
    }
}

TEST(Atrous, LeavesAConstantImageConstant) {
  for (const char* stops : {"svgf", "dammertz", "joint_bilateral"})
    for (const int level : {0, 2, 5}) {
      const Case c{.stops = stops, .level = level, .size = {61, 40}};
      Scene scene = make_scene(c);
      scene.insert_or_assign("color",
                             test_image(QUELL_TYPE_COLOR, c.size, [](int, int, int k) { return 0.3F + static_cast<float>(k); }));
      const Result got = run(c, scene);
      for (int y = 0; y < c.size.height; ++y)
        for (int x = 0; x < c.size.width; ++x)
          for (int k = 0; k < 3; ++k) {
            const double want = double{0.3F + static_cast<float>(k)};
            ASSERT_NEAR(got.color.floats().at(x, y, k), want, 1e-6 * want) << stops << " " << x << "," << y;
          }
    }
}

// Without edges, the variance of a mean of independent values: sum h^2 variance, in each direction 70/256 for a constant one.
TEST(Atrous, CarriesTheVarianceOfAMean) {
  const Size size{50, 30};
  const Image variance = test_image(QUELL_TYPE_VARIANCE, size, [](int, int, int) { return 2.0F; });
  const Result got = blur(impulse(size, 3, 3), 1, &variance);
  for (int y = 4; y < size.height - 4; ++y)
    for (int x = 4; x < size.width - 4; ++x)
      ASSERT_NEAR(got.variance.floats().at(x, y), 2 * square(70.0 / 256), 2e-6) << x << "," << y;
}

TEST(Atrous, GivesNoVarianceWhenItGetsNone) {
  const Result got = blur(impulse({20, 9}, 3, 3), 0);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 20; ++x) ASSERT_EQ(got.variance.floats().at(x, y), 0);
}

// A dark wall and a bright one, which differ in one of the inputs alone.
Result run_walls(const char* stops, const char* input, PortType type, const std::function<float(int x, int y, int k)>& value) {
  const Size size{40, 20};
  PassTest pass("atrous");
  pass.set("stops", stops).set("phi_color", 1e12).set("sigma_color", 1e6).set("sigma_coord", 1e6).set("sigma_plane", 1e6);
  pass.input("color", test_image(QUELL_TYPE_COLOR, size, [](int x, int, int) { return x < 20 ? 1.0F : 5.0F; }));
  if (std::string(input) == "position")  // the plane term needs normals
    pass.input("normal", test_image(QUELL_TYPE_NORMAL, size, [](int, int, int k) { return k == 2 ? 1.0F : 0.0F; }))
        .set("sigma_plane", 0.1);
  pass.input(input, test_image(type, size, value));
  pass.run();
  return {*pass.output_item("color").image(), *pass.output_item("variance").image()};
}
void expect_walls(const Result& got, const char* what) {
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) ASSERT_NEAR(got.color.floats().at(x, y), x < 20 ? 1 : 5, 1e-5) << what << " " << x << "," << y;
}

TEST(Atrous, PassesNothingOverARightAngledCrease) {
  const auto crease = [](int x, int, int k) { return k == (x < 20 ? 0 : 2) ? 1.0F : 0.0F; };
  for (const char* stops : {"svgf", "joint_bilateral"})
    expect_walls(run_walls(stops, "normal", QUELL_TYPE_NORMAL, crease), stops);
}

TEST(Atrous, PassesNothingOverAStepOfDepthOrPosition) {
  expect_walls(run_walls("svgf", "depth", QUELL_TYPE_DEPTH,
                         [](int x, int y, int) { return static_cast<float>(5 + 0.01 * x + 0.02 * y + (x < 20 ? 0 : 3)); }),
               "depth");
  const auto step = [](int x, int y, int k) { return static_cast<float>(k == 0 ? x : k == 1 ? y : x < 20 ? 0 : 1000); };
  for (const char* stops : {"dammertz", "joint_bilateral"})
    expect_walls(run_walls(stops, "position", QUELL_TYPE_POSITION, step), stops);
}

// The slope explains each difference, so that w_z is exp(-1) for taps beside the pixel's column, and 1 within it.
TEST(Atrous, MixesAlongASlopeHoweverSteepItIs) {
  const auto slope = [](int x, int, int) { return static_cast<float>(10 + 3 * x); };
  const Result got = run_walls("svgf", "depth", QUELL_TYPE_DEPTH, slope);
  const double side = (1.0 / 4 + 1.0 / 16) * std::exp(-1), total = 3.0 / 8 + 2 * side;
  EXPECT_NEAR(got.color.floats().at(19, 10), (1 * (total - side) + 5 * side) / total, 1e-4);
  EXPECT_NEAR(got.color.floats().at(20, 10), (5 * (total - side) + 1 * side) / total, 1e-4);
}

// Falcor's pass, from its shader: weights relative to the middle, which weighs 1, and tolerances that are not sums.
TEST(Atrous, IsFalcorsFilterWhenItsTolerancesAreSet) {
  const Case c{.level = 2,
               .size = {70, 50},
               .without = {"position"},
               .params = {{"sigma_l", 10}, {"eps_l", 0}, {"eps_variance", 1e-10}, {"eps_z", 0}}};
  Scene scene = make_scene(c);
  const auto at = [&](const char* name, int x, int y) { return double{scene.at(name).floats().at(x, y)}; };
  const auto vec = [&](const char* name, int x, int y) { return pixel(scene.at(name), x, y); };
  const auto inside = [&](int x, int y) { return x >= 0 && y >= 0 && x < c.size.width && y < c.size.height; };
  for (int i = 0; i < 70; i += 3)
    scene.at("depth_gradient").writable_floats().at(i, i % 50) = 1e-8F;  // max(gradient, 1e-8) there
  const Result got = run(c, scene);
  const double kernel[] = {1, 2.0 / 3, 1.0 / 6};
  for (int y = 0; y < c.size.height; ++y)
    for (int x = 0; x < c.size.width; ++x) {
      if (at("depth", x, y) >= 1e10 || dot(vec("normal", x, y), vec("normal", x, y)) == 0) continue;
      const auto luminance = [&](int px, int py) { return dot(vec("color", px, py), {0.2126, 0.7152, 0.0722}); };
      const double phi_color = 10 * std::sqrt(std::max(0.0, 1e-10 + at("blurred_variance", x, y)));
      double weights = 1, variance = at("variance", x, y), red = at("color", x, y);
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
          const int qx = x + 4 * dx, qy = y + 4 * dy;
          if ((dx == 0 && dy == 0) || !inside(qx, qy)) continue;
          const double phi_depth = std::max(at("depth_gradient", x, y), 1e-8) * 4 * std::hypot(dx, dy);
          const double w = std::exp(-std::abs(luminance(x, y) - luminance(qx, qy)) / phi_color -
                                    std::abs(at("depth", x, y) - at("depth", qx, qy)) / phi_depth) *
                           std::pow(std::max(0.0, dot(vec("normal", x, y), vec("normal", qx, qy))), 128.0) *
                           kernel[std::abs(dx)] * kernel[std::abs(dy)];
          weights += w, variance += w * w * at("variance", qx, qy), red += w * at("color", qx, qy);
        }
      ASSERT_NEAR(got.color.floats().at(x, y), red / weights, 1e-4 * red / weights + 1e-6) << x << "," << y;
      variance /= weights * weights;
      ASSERT_NEAR(got.variance.floats().at(x, y), variance, 2e-4 * variance + 1e-8) << x << "," << y;
    }
}

TEST(Atrous, TakesAGradientOfAnySizeForASlopeThatExplainsAll) {
  const Case c{.level = 3, .without = {"blurred_variance"}};
  Scene steep = make_scene(c), flat = steep;
  steep.insert_or_assign("depth_gradient", test_image(QUELL_TYPE_SCALAR, c.size, [](int x, int, int) {
                           return x % 2 == 0 ? std::numeric_limits<float>::max() : 1e12F;
                         }));
  for (int y = 0; y < c.size.height; ++y)
    for (int x = 0; x < c.size.width; ++x)
      if (float& depth = flat.at("depth").writable_floats().at(x, y); depth < QUELL_NO_SURFACE_DEPTH) depth = 5;
  const Result got = run(c, steep), want = run(c, flat);
  for (int y = 0; y < c.size.height; ++y)
    for (int x = 0; x < c.size.width; ++x)
      ASSERT_NEAR(got.color.floats().at(x, y), want.color.floats().at(x, y), 1e-5) << x << "," << y;
}

// A background next to a surface is neither a slope nor a neighbor.
TEST(Atrous, KeepsTheBackgroundApart) {
  const auto sky = [](int x, int y, int) { return x < 20 ? static_cast<float>(5 + 0.1 * x + 0.1 * y) : QUELL_NO_SURFACE_DEPTH; };
  expect_walls(run_walls("svgf", "depth", QUELL_TYPE_DEPTH, sky), "depth");
  const auto hole = [](int x, int, int k) { return x < 20 && k == 2 ? 1.0F : 0.0F; };
  for (const char* stops : {"svgf", "dammertz", "joint_bilateral"})
    expect_walls(run_walls(stops, "normal", QUELL_TYPE_NORMAL, hole), stops);
}

// Only its own pixel shows it; for the others it is as if there were no surface.
TEST(Atrous, LeavesOutATapThatIsNotFinite) {
  for (const char* stops : {"svgf", "dammertz", "joint_bilateral"})
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      const Case c{.stops = stops, .without = {"depth_gradient", "variance"}};
      Scene broken = make_scene(c), hole = make_scene(c);
      ASSERT_NE(hole.at("normal").floats().at(7, 6, 2), 0.0F);
      broken.at("color").writable_floats().at(7, 6, 1) = bad;
      for (int k = 0; k < 3; ++k) hole.at("normal").writable_floats().at(7, 6, k) = 0;
      Image got = run(c, broken).color;
      EXPECT_TRUE(std::isnan(bad) ? std::isnan(got.floats().at(7, 6, 1)) : got.floats().at(7, 6, 1) == bad);
      got.writable_floats().at(7, 6, 1) = hole.at("color").floats().at(7, 6, 1);
      EXPECT_TRUE(same_bits(got, run(c, hole).color)) << stops;
    }
}

TEST(Atrous, LeavesOutATapThatLiesTooFarOff) {
  for (const char* stops : {"dammertz", "joint_bilateral"}) {
    const Case c{.stops = stops, .without = {"depth_gradient", "variance"}};
    Scene broken = make_scene(c), hole = make_scene(c);
    broken.at("position").writable_floats().at(7, 6, 1) = 1e25F;  // its square is infinite
    for (int k = 0; k < 3; ++k) hole.at("normal").writable_floats().at(7, 6, k) = 0;
    EXPECT_TRUE(same_bits(run(c, broken).color, run(c, hole).color)) << stops;
  }
}

}  // namespace
}  // namespace quell::atrous_test

QUELL_CONFORMANCE_TEST(atrous);
QUELL_CONFORMANCE_TEST(atrous, .set("level", 2).set("sigma_n", 8));
QUELL_CONFORMANCE_TEST(atrous, .set("stops", "dammertz"));
QUELL_CONFORMANCE_TEST(atrous, .set("stops", "joint_bilateral").set("level", 3));
QUELL_CONFORMANCE_TEST(atrous, .set("stops", "joint_bilateral").set("sigma_normal", 0.5));
