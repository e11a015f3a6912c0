#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "window_statistics.h"

namespace quell {
namespace {

constexpr Size kSize{37, 17};

struct Case {
  std::set<std::string> without = {};
  int radius = 2;
  double k = 2;
  bool rgb = false, include_center = true;
  double min_length = 4;
  Size size = kSize;
  bool has(const std::string& input) const { return without.count(input) == 0; }
};

PassTest make(const Case& c) {
  PassTest pass("fast_history_clamp");
  pass.set("radius", c.radius).set("k", c.k).set("space", c.rgb ? "rgb" : "ycocg");
  pass.set("include_center", c.include_center).set("min_length", c.min_length);
  pass.input("color", test_image(QUELL_TYPE_COLOR, c.size, scene::other_color));
  pass.input("fast", test_image(QUELL_TYPE_COLOR, c.size, scene::color));
  if (c.has("length")) pass.input("length", test_image(QUELL_TYPE_SCALAR, c.size, scene::length));
  if (c.has("depth")) pass.input("depth", test_image(QUELL_TYPE_DEPTH, c.size, scene::depth));
  return pass;
}

struct Expected {
  scene::Color color;
  double clamped = 0;
};

// The formula of the documentation.
Expected expected(const Case& c, int x, int y) {
  const scene::Color slow = scene::at(scene::other_color, x, y), fast = scene::at(scene::color, x, y);
  if (c.has("depth") && scene::is_hole(x, y)) return {slow};
  if (c.has("length") && scene::length(x, y, 0) < c.min_length) return {slow};
  const auto convert = [&](const scene::Color& color) { return c.rgb ? color : scene::to_ycocg(color); };
  std::array<std::vector<double>, 3> window;
  scene::around(c.size, x, y, c.radius, [&](int qx, int qy) {
    if (c.has("depth") && scene::is_hole(qx, qy)) return;
    for (std::size_t i = 0; i < 3; ++i) window[i].push_back(convert(scene::at(scene::color, qx, qy))[i]);
  });
  scene::Color limited = convert(slow);
  for (std::size_t i = 0; i < 3; ++i) {
    const scene::MeanAndDeviation s = scene::statistics(window[i]);
    double lower = s.mean - c.k * s.deviation, upper = s.mean + c.k * s.deviation;
    if (c.include_center) lower = std::min(lower, convert(fast)[i]), upper = std::max(upper, convert(fast)[i]);
    limited[i] = std::clamp(limited[i], lower, upper);
  }
  const scene::Color result = c.rgb ? limited : scene::from_ycocg(limited);
  const double part = (scene::luma(result) - scene::luma(slow)) / (scene::luma(fast) - scene::luma(slow));
  return {result, std::clamp(part, 0.0, 1.0)};
}

// Sums of 25 differences up to 2, in float: some 1e-6; `clamped` divides such an error by a difference of luma, which is 1e-3 or
// more but for a few pixels.
TEST(FastHistoryClamp, EqualsItsFormulaInDouble) {
  const std::array<Case, 10> cases{Case{},
                                   {.without = {"depth"}, .k = 0.5},
                                   {.without = {"length"}, .k = 1, .rgb = true},
                                   {.without = {"length", "depth"}, .radius = 1, .k = 0.3, .include_center = false},
                                   {.radius = 0},
                                   {.radius = 5, .k = 0, .include_center = false},
                                   {.k = 100},
                                   {.size = {1, 1}},
                                   {.radius = 3, .k = 0.5, .size = {5, 16}},
                                   {.k = 1, .size = {16, 3}}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    PassTest pass = make(cases[i]);
    pass.run();
    int changed = 0;
    for (int y = 0; y < cases[i].size.height; ++y)
      for (int x = 0; x < cases[i].size.width; ++x) {
        const Expected want = expected(cases[i], x, y);
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(pass.output("color").at(x, y, c), want.color[static_cast<std::size_t>(c)], 1e-5)
              << "case " << i << " at " << x << "," << y;
        ASSERT_NEAR(pass.output("clamped").at(x, y), want.clamped, 2e-3) << "case " << i << " at " << x << "," << y;
        changed += want.clamped > 0 ? 1 : 0;
      }
    if (cases[i].size == kSize) { EXPECT_EQ(changed > 30, cases[i].k < 100) << "case " << i; }
  }
}

TEST(FastHistoryClamp, LeavesWhatLiesWithinBitForBit) {
  PassTest pass = make({.k = 100});
  pass.run();
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        ASSERT_EQ(pass.output("color").at(x, y, c), scene::other_color(x, y, c)) << x << "," << y;
        ASSERT_EQ(pass.output("clamped").at(x, y), 0.0F);
      }
}

// A light that went out: the fast history is dark, and constant, so the slow one follows all the way.
TEST(FastHistoryClamp, TakesTheSlowHistoryAlongWhereTheLightChanged) {
  const auto lamp = [](float radiance) { return [radiance](int, int, int) { return radiance; }; };
  PassTest pass("fast_history_clamp");
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, lamp(1000.0F)));
  pass.input("fast", test_image(QUELL_TYPE_COLOR, kSize, lamp(0.25F)));
  pass.run();
  for (int x = 0; x < kSize.width; ++x) {
    EXPECT_EQ(pass.output("color").at(x, 8, 1), 0.25F);
    EXPECT_EQ(pass.output("clamped").at(x, 8), 1.0F);
  }
}

// Differences to the center do not cancel: of values around 1e4 a float's squares would lose the deviation of 0.01 entirely.
TEST(FastHistoryClamp, KnowsASmallDeviationOfBrightColors) {
  const auto bright = [](int x, int y, int) { return 10000 + ((x + y) % 2 ? 0.03125F : -0.03125F); };
  PassTest pass("fast_history_clamp");
  pass.set("k", 3.0).set("space", "rgb");
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 20000.0F; }));
  pass.input("fast", test_image(QUELL_TYPE_COLOR, kSize, bright));
  pass.run();
  // 12 or 13 of 25 to each side: a mean within 0.00125, a deviation of 0.0312; and half of a float's step there, 0.0005.
  EXPECT_NEAR(pass.output("color").at(18, 8), 10000 + 3 * 0.03122, 0.00125 + 0.0005);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(fast_history_clamp);
QUELL_CONFORMANCE_TEST(fast_history_clamp, .set("space", "rgb").set("k", 0.2).set("radius", 3).set("min_length", 0.0));
