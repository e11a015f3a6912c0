#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

constexpr Size kSize{37, 33};

// Planes 0.02 above or below each other: twice what 0.003 of a depth of 5 to 8 tolerates, or nothing.
float position(int x, int y, int c) { return static_cast<float>(c == 0 ? 0.01 * x : c == 1 ? 0.01 * y : y % 3 == 0 ? 0.06 : 0); }

struct Case {
  std::set<std::string> without = {};
  double min_length = 4, stride = 14, sigma_n = 8, sigma_z = 1, plane_relative = 0.003, plane_absolute = 0;
  Size size = kSize;
  bool has(const std::string& input) const { return without.count(input) == 0; }
};

PassTest make(const Case& c) {
  PassTest pass("history_fix");
  pass.set("min_length", c.min_length).set("stride", c.stride).set("sigma_n", c.sigma_n).set("sigma_z", c.sigma_z);
  pass.set("plane_relative", c.plane_relative).set("plane_absolute", c.plane_absolute);
  pass.input("image", test_image(QUELL_TYPE_COLOR, c.size, scene::color));
  pass.input("image",
             test_image(QUELL_TYPE_MOMENTS, c.size, [](int x, int y, int i) { return scene::other_color(x, y, i + 1); }));
  pass.input("length", test_image(QUELL_TYPE_SCALAR, c.size, scene::length));
  if (c.has("depth")) pass.input("depth", test_image(QUELL_TYPE_DEPTH, c.size, scene::depth));
  if (c.has("depth_gradient")) pass.input("depth_gradient", test_image(QUELL_TYPE_SCALAR, c.size, scene::gradient));
  if (c.has("normal")) pass.input("normal", test_image(QUELL_TYPE_NORMAL, c.size, scene::normal));
  if (c.has("position")) pass.input("position", test_image(QUELL_TYPE_POSITION, c.size, position));
  if (c.has("id")) pass.input_ids("id", c.size, scene::id);
  return pass;
}

using Plane = std::function<float(int x, int y, int c)>;

double product(const Plane& a, int ax, int ay, const Plane& b, int bx, int by) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += double{a(ax, ay, k)} * b(bx, by, k);
  return sum;
}

double weight(const Case& c, int x, int y, int qx, int qy) {
  if (c.has("id") && scene::id(x, y) != scene::id(qx, qy)) return 0;
  if (c.has("depth") && scene::is_hole(qx, qy)) return 0;
  double w = 1;
  if (c.has("normal")) w = std::pow(std::max(product(scene::normal, x, y, scene::normal, qx, qy), 0.0), c.sigma_n);
  if (c.has("normal") && c.has("position")) {
    const double height = product(scene::normal, x, y, position, qx, qy) - product(scene::normal, x, y, position, x, y);
    const double tolerance = c.plane_relative * (c.has("depth") ? scene::depth(x, y, 0) : 0) + c.plane_absolute;
    return std::abs(height) <= tolerance ? w : 0;
  }
  if (c.has("depth") && c.has("depth_gradient"))
    w *= std::exp(-std::abs(double{scene::depth(x, y, 0)} - scene::depth(qx, qy, 0)) /
                  (c.sigma_z * std::max(double{scene::gradient(x, y, 0)}, 1e-8) * std::hypot(qx - x, qy - y)));
  return w;
}

// The formula of the documentation.
double expected(const Case& c, const Plane& image, int x, int y, int channel) {
  const double own = image(x, y, channel), length = scene::length(x, y, 0);
  if (length >= c.min_length || (c.has("depth") && scene::is_hole(x, y))) return own;
  const int stride = static_cast<int>(std::nearbyint(c.stride / (1 + length)));
  double sum = own, weights = 1;
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx) {
      const int qx = x + dx * stride, qy = y + dy * stride;
      if ((dx == 0 && dy == 0) || qx < 0 || qy < 0 || qx >= c.size.width || qy >= c.size.height) continue;
      const double w = weight(c, x, y, qx, qy);
      sum += w * image(qx, qy, channel), weights += w;
    }
  return stride > 0 ? sum / weights : own;
}

// A weight errs by 4e-6 (2^x) and a few roundings of its exponent, the logarithm's times a power of up to 40 among them; a mean
// of values up to 5 by twice that.
TEST(HistoryFix, EqualsItsFormulaInDouble) {
  const std::array<Case, 12> cases{Case{},
                                   {.without = {"position"}},
                                   {.without = {"position", "id"}, .sigma_z = 3},
                                   {.without = {"depth"}, .plane_absolute = 0.03},
                                   {.without = {"depth_gradient", "position"}},
                                   {.without = {"normal", "id"}},
                                   {.without = {"depth", "depth_gradient", "normal", "position", "id"}},
                                   {.min_length = 7, .stride = 5, .sigma_n = 40},
                                   {.stride = 0.5, .sigma_n = 0},
                                   {.size = {1, 1}},
                                   {.min_length = 9, .size = {5, 16}},
                                   {.stride = 4, .size = {16, 3}}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    PassTest pass = make(cases[i]);
    pass.run();
    int changed = 0;
    for (int y = 0; y < cases[i].size.height; ++y)
      for (int x = 0; x < cases[i].size.width; ++x) {
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(pass.output("image", 0).at(x, y, c), expected(cases[i], scene::color, x, y, c), 5e-5)
              << "case " << i << " at " << x << "," << y;
        for (int c = 0; c < 2; ++c)
          ASSERT_NEAR(pass.output("image", 1).at(x, y, c),
                      expected(
                          cases[i], [](int px, int py, int k) { return scene::other_color(px, py, k + 1); }, x, y, c),
                      5e-5)
              << "case " << i << " at " << x << "," << y;
        changed += pass.output("image", 0).at(x, y) != scene::color(x, y, 0) ? 1 : 0;
      }
    if (cases[i].size == kSize) { EXPECT_EQ(changed > 200, cases[i].stride > 1) << "case " << i; }
  }
}

TEST(HistoryFix, LeavesLongHistoriesAndConstantsBitForBit) {
  PassTest pass = make({});
  pass.disconnect("image").input("image", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 0.1F; }));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) ASSERT_EQ(pass.output("image").at(x, y, 2), 0.1F) << x << "," << y;
  PassTest old = make({.min_length = 1});
  old.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) ASSERT_EQ(old.output("image").at(x, y), scene::color(x, y, 0)) << x << "," << y;
}

// Of noise of variance 1/12, the mean of 25 independent taps has 1/300; near the border there are fewer.
TEST(HistoryFix, AveragesTwentyFiveTapsInTheOpen) {
  const auto grain = [](int x, int y, int c) { return static_cast<float>(scene::noise(x, y, c)); };
  constexpr Size kWide{200, 60};
  PassTest pass("history_fix");
  pass.input("image", test_image(QUELL_TYPE_COLOR, kWide, grain));
  pass.input("length", test_image(QUELL_TYPE_SCALAR, kWide, [](int, int, int) { return 1.0F; }));
  pass.run();
  double sum = 0, squares = 0, count = 0;
  for (int y = 14; y < kWide.height - 14; ++y)
    for (int x = 14; x < kWide.width - 14; ++x) {
      const double value = pass.output("image").at(x, y);
      sum += value, squares += value * value, count += 1;
    }
  // 5,500 pixels that share taps: about 1,000 independent ones, whose variance is known to 10 % (two deviations: 9 %).
  EXPECT_NEAR(squares / count - sum * sum / count / count, 1.0 / 300, 0.1 / 300);
}

TEST(HistoryFix, NeverCrossesARightAngleCreaseOrABoundaryOfObjects) {
  const auto half = [](int x, int, int) { return x < 18 ? 1.0F : 5.0F; };
  PassTest crease("history_fix"), objects("history_fix");
  for (PassTest* pass : {&crease, &objects}) {
    pass->input("image", test_image(QUELL_TYPE_COLOR, kSize, half));
    pass->input("length", test_image(QUELL_TYPE_SCALAR, kSize, [](int, int, int) { return 1.0F; }));
  }
  crease.input("normal",
               test_image(QUELL_TYPE_NORMAL, kSize, [](int x, int, int c) { return c == (x < 18 ? 0 : 2) ? 1.0F : 0.0F; }));
  objects.input_ids("id", kSize, [](int x, int) { return x < 18 ? 3U : 4U; });
  for (PassTest* pass : {&crease, &objects}) {
    pass->run();
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) ASSERT_EQ(pass->output("image").at(x, y), half(x, y, 0)) << x << "," << y;
  }
}

TEST(HistoryFix, DoesNotLetInWhatDoesNotCount) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  PassTest pass = make({.without = {"position", "id"}});
  pass.disconnect("image").input(
      "image", test_image(QUELL_TYPE_COLOR, kSize, [](int x, int y, int) { return scene::is_hole(x, y) ? kNan : 2.0F; }));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      if (scene::is_hole(x, y)) continue;
      ASSERT_EQ(pass.output("image").at(x, y), 2.0F) << x << "," << y;
    }
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(history_fix);
QUELL_CONFORMANCE_TEST(history_fix, .set("stride", 3.0).set("sigma_n", 0.0).set("min_length", 100.0));
