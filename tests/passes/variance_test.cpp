#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

constexpr Size kSize{37, 17};

double noise(int x, int y, int seed) {
  unsigned h =
      static_cast<unsigned>(x) * 374761393U + static_cast<unsigned>(y) * 668265263U + static_cast<unsigned>(seed) * 2246822519U;
  h = (h ^ (h >> 13)) * 1274126177U;
  return static_cast<double>((h ^ (h >> 16)) & 0xffffff) / 0x1000000;
}

bool is_hole(int x, int y) { return (x / 4 + y / 3) % 6 == 5; }
float color_at(int x, int y, int c) { return static_cast<float>(2 * noise(x, y, c)); }
float moment_at(int x, int y, int c) { return static_cast<float>(c == 0 ? noise(x, y, 3) : 1 + noise(x, y, 4)); }
float length_at(int x, int y, int) { return static_cast<float>(1 + static_cast<int>(8 * noise(x, y, 5))); }
float depth_at(int x, int y, int) {
  return is_hole(x, y) ? QUELL_NO_SURFACE_DEPTH
                       : static_cast<float>(5 + 0.1 * x + 0.05 * y + 0.02 * noise(x, y, 6) + (x > 20 ? 4 : 0));
}
float gradient_at(int x, int y, int) { return x == 9 ? 0.0F : static_cast<float>(0.05 + 0.1 * noise(x, y, 7)); }
float normal_at(int x, int y, int c) {
  const double a = 0.3 * noise(x, y, 8) + (y > 9 ? 0.5 : 0);
  return static_cast<float>(c == 0 ? std::sin(a) : c == 2 ? std::cos(a) : 0);
}

struct Case {
  std::set<std::string> without = {};
  double min_length = 4, sigma_l = 0, sigma_z = 1, sigma_n = 128;
  bool boost = false, filter_color = false;
  bool has(const std::string& input) const { return without.count(input) == 0; }
};

PassTest make(const Case& c) {
  PassTest pass("variance");
  pass.set("min_length", c.min_length).set("sigma_l", c.sigma_l).set("sigma_z", c.sigma_z).set("sigma_n", c.sigma_n);
  pass.set("boost", c.boost ? "young" : "none").set("filter_color", c.filter_color);
  pass.input("moments", test_image(QUELL_TYPE_MOMENTS, kSize, moment_at))
      .input("color", test_image(QUELL_TYPE_COLOR, kSize, color_at));
  if (c.has("length")) pass.input("length", test_image(QUELL_TYPE_SCALAR, kSize, length_at));
  if (c.has("depth")) pass.input("depth", test_image(QUELL_TYPE_DEPTH, kSize, depth_at));
  if (c.has("depth_gradient")) pass.input("depth_gradient", test_image(QUELL_TYPE_SCALAR, kSize, gradient_at));
  if (c.has("normal")) pass.input("normal", test_image(QUELL_TYPE_NORMAL, kSize, normal_at));
  return pass;
}

double luminance(int x, int y) { return 0.2126 * color_at(x, y, 0) + 0.7152 * color_at(x, y, 1) + 0.0722 * color_at(x, y, 2); }

// The formula of the documentation in double: variance and color.
std::array<double, 4> expected(const Case& c, int x, int y) {
  double first = moment_at(x, y, 0), second = moment_at(x, y, 1), boost = 1;
  std::array<double, 3> color{color_at(x, y, 0), color_at(x, y, 1), color_at(x, y, 2)};
  const double length = c.has("length") ? length_at(x, y, 0) : 1;
  if (length < c.min_length && !(c.has("depth") && is_hole(x, y))) {
    double weights = 0, sum1 = 0, sum2 = 0;
    std::array<double, 3> sum{};
    for (int qy = std::max(0, y - 3); qy <= std::min(kSize.height - 1, y + 3); ++qy)
      for (int qx = std::max(0, x - 3); qx <= std::min(kSize.width - 1, x + 3); ++qx) {
        if (c.has("depth") && is_hole(qx, qy)) continue;
        double e = c.sigma_l > 0 ? std::abs(luminance(qx, qy) - luminance(x, y)) / c.sigma_l : 0, cosine = 1;
        if (c.has("depth") && c.has("depth_gradient") && (qx != x || qy != y))
          e += std::abs(double{depth_at(qx, qy, 0)} - depth_at(x, y, 0)) /
               (c.sigma_z * std::max(double{gradient_at(x, y, 0)}, 1e-8) * std::hypot(qx - x, qy - y));
        if (c.has("normal")) {
          cosine = 0;
          for (int k = 0; k < 3; ++k) cosine += double{normal_at(x, y, k)} * normal_at(qx, qy, k);
        }
        const double w = std::exp(-e) * std::pow(std::clamp(cosine, 0.0, 1.0), c.sigma_n);
        weights += w, sum1 += w * moment_at(qx, qy, 0), sum2 += w * moment_at(qx, qy, 1);
        for (int k = 0; k < 3; ++k) sum[static_cast<std::size_t>(k)] += w * color_at(qx, qy, k);
      }
    first = sum1 / weights, second = sum2 / weights;
    if (c.boost) boost = c.min_length / length;
    if (c.filter_color) color = {sum[0] / weights, sum[1] / weights, sum[2] / weights};
  }
  return {boost * std::max(0.0, second - first * first), color[0], color[1], color[2]};
}

// A weight errs by 4e-6 (2^x), 1.5e-6 (the power) and a few roundings of its exponent; a mean of moments up to 2 by up to twice
// that, and the boost raises it fourfold.
TEST(Variance, EqualsItsFormulaInDouble) {
  const std::vector<Case> cases{{},
                                {.sigma_l = 0.5, .sigma_z = 3, .boost = true, .filter_color = true},
                                {.without = {"depth"}},
                                {.without = {"depth_gradient"}, .filter_color = true},
                                {.without = {"normal"}},
                                {.without = {"length"}},
                                {.sigma_n = 8},
                                {.min_length = 0}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    PassTest pass = make(cases[i]);
    pass.run();
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const std::array<double, 4> want = expected(cases[i], x, y);
        ASSERT_NEAR(pass.output("variance").at(x, y), want[0], 1e-4) << "case " << i << " at " << x << "," << y;
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(pass.output("color").at(x, y, c), want[static_cast<std::size_t>(c) + 1], 3e-5)
              << "case " << i << " at " << x << "," << y;
      }
  }
}

TEST(Variance, OfAConstantIsZero) {
  PassTest pass("variance");
  pass.input("moments", test_image(QUELL_TYPE_MOMENTS, kSize, [](int, int, int c) { return c == 0 ? 3.0F : 9.0F; }));
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 3.0F; }));
  pass.run();
  for (int x = 0; x < kSize.width; ++x) EXPECT_NEAR(pass.output("variance").at(x, 8), 0, 2e-5);
}

TEST(Variance, IsNeverNegative) {
  PassTest pass("variance");
  pass.set("min_length", 0.0);
  pass.input("moments", test_image(QUELL_TYPE_MOMENTS, kSize, [](int, int, int c) { return c == 0 ? 3.0F : 8.0F; }));
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 3.0F; }));
  pass.run();
  EXPECT_EQ(pass.output("variance").at(3, 3), 0.0F);
}

// Of a coin that falls on 0 or 1 the variance is 1/4, whatever the pixel's own frame says.
TEST(Variance, OfAFirstFrameIsThatOfTheNeighborhood) {
  const auto coin = [](int x, int y, int) { return static_cast<float>((x + y) % 2); };
  PassTest pass("variance");
  pass.input("moments", test_image(QUELL_TYPE_MOMENTS, kSize, coin)).input("color", test_image(QUELL_TYPE_COLOR, kSize, coin));
  pass.run();
  // 24 or 25 of 49.
  EXPECT_NEAR(pass.output("variance").at(10, 8), 24.0 / 49 * 25 / 49, 1e-5);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(variance);
QUELL_CONFORMANCE_TEST(variance, .set("filter_color", true).set("sigma_l", 2.0).set("boost", "young"));
QUELL_CONFORMANCE_TEST(variance, .set("sigma_n", 8.0));
