#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

using Vec = std::array<double, 3>;

// Noise of 0 to 2, a black corner, and fireflies of all strengths, single and in pairs.
float color(int x, int y, int c) {
  if (x + y < 4) return 0;
  const double strength = scene::noise(x, y, 30);
  const bool is_firefly = strength > 0.95 || (x % 13 == 6 && y % 5 < 2);
  return static_cast<float>(scene::color(x, y, c) * (is_firefly ? 3 + 200 * scene::noise(x, y, 31) : 1) * (c == 1 ? 0.5 : 1));
}
Vec color_of(int x, int y) { return {color(x, y, 0), color(x, y, 1), color(x, y, 2)}; }
double luminance(const Vec& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

struct Case {
  Size size{37, 17};
  const char* method = "bound";
  bool channels = false;
  int radius = 3;
  double k = 2, floor = 1;
  bool exclude_center = true;
};

PassTest make(const Case& c) {
  PassTest pass("firefly");
  pass.set("method", c.method).set("measure", c.channels ? "channels" : "luminance").set("radius", c.radius);
  pass.set("k", c.k).set("floor", c.floor).set("exclude_center", c.exclude_center);
  pass.input("color", test_image(QUELL_TYPE_COLOR, c.size, color));
  return pass;
}

// The taps of a pixel's window: v of each.
template <class Value>
std::vector<double> window(const Case& c, int x, int y, int radius, bool exclude_center, const Value& v) {
  std::vector<double> taps;
  for (int qy = std::max(0, y - radius); qy <= std::min(c.size.height - 1, y + radius); ++qy)
    for (int qx = std::max(0, x - radius); qx <= std::min(c.size.width - 1, x + radius); ++qx)
      if (!exclude_center || qx != x || qy != y) taps.push_back(v(qx, qy));
  return taps;
}

double clamped(const Case& c, double own, const std::vector<double>& taps) {
  if (taps.size() < 2) return own;
  const auto n = static_cast<double>(taps.size());
  double mean = 0, variance = 0;
  for (const double v : taps) mean += v / n;
  for (const double v : taps) variance += (v - mean) * (v - mean) / (n - 1);
  const double upper = mean + c.k * std::sqrt(variance), lower = mean - c.k * std::sqrt(variance);
  if (std::string(c.method) == "bound") return std::min(own, std::max(upper, c.floor));
  return std::clamp(own, lower, upper);
}

Vec by_rank(const Case& c, int x, int y) {
  Vec most = color_of(x, y), least = most;
  double high = -1e30, low = 1e30;
  const double own = luminance(color_of(x, y));
  window(c, x, y, 1, true, [&](int qx, int qy) {
    const Vec tap = color_of(qx, qy);
    if (luminance(tap) > high) high = luminance(tap), most = tap;
    if (luminance(tap) < low) low = luminance(tap), least = tap;
    return 0.0;
  });
  return own > high ? most : own < low ? least : color_of(x, y);
}

Vec expected(const Case& c, int x, int y) {
  Vec own = color_of(x, y);
  if (std::string(c.method) == "rank") return by_rank(c, x, y);
  if (c.channels) {
    for (int k = 0; k < 3; ++k)
      own[static_cast<std::size_t>(k)] = clamped(
          c, color(x, y, k), window(c, x, y, c.radius, c.exclude_center, [&](int qx, int qy) { return color(qx, qy, k); }));
    return own;
  }
  const double before = luminance(own);
  const double after =
      clamped(c, before, window(c, x, y, c.radius, c.exclude_center, [](int qx, int qy) { return luminance(color_of(qx, qy)); }));
  if (before > 0)
    for (double& channel : own) channel *= std::max(after, 0.0) / before;
  return own;
}

// Roundings: of 49 sums of up to 600, each 6e-8, that mostly cancel, and a handful of a luminance and a quotient; a color of a
// small luminance that is raised, or of a large one in one channel alone, has a factor of 1 / 0.07 of it.
TEST(Firefly, EqualsItsFormulaInDouble) {
  const std::array<Case, 14> cases{Case{},
                                   {.exclude_center = false},
                                   {.k = 0.5, .floor = 0},
                                   {.method = "range", .k = 1},
                                   {.method = "range", .radius = 1, .k = 0.7},
                                   {.method = "range", .channels = true, .k = 1, .exclude_center = false},
                                   {.channels = true, .radius = 8},
                                   {.method = "rank"},
                                   {.size = {1, 1}, .exclude_center = false},
                                   {.size = {1, 9}, .k = 0.5, .floor = 0},
                                   {.size = {7, 5}, .method = "range", .radius = 8, .k = 0.5},
                                   {.size = {64, 6}, .method = "range", .k = 0.5},
                                   {.size = {3, 2}, .method = "rank"},
                                   {.size = {1, 1}, .method = "rank"}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    PassTest pass = make(cases[i]);
    pass.run();
    int changed = 0;
    for (int y = 0; y < cases[i].size.height; ++y)
      for (int x = 0; x < cases[i].size.width; ++x) {
        const Vec want = expected(cases[i], x, y), own = color_of(x, y);
        double difference = 0;
        for (int c = 0; c < 3; ++c) {
          const auto k = static_cast<std::size_t>(c);
          ASSERT_NEAR(pass.output("color").at(x, y, c), want[k], 2e-5 * want[k] + 2e-5)
              << "case " << i << " at " << x << "," << y;
          difference = std::max(difference, std::abs(want[k] - own[k]));
        }
        const float mask = pass.output("mask").at(x, y);
        ASSERT_TRUE(mask == 0 || mask == 1);
        const bool clearly = difference > 1e-4 * (1 + own[0] + own[1] + own[2]);
        ASSERT_TRUE(mask == 1 || !clearly) << "case " << i << " at " << x << "," << y;
        ASSERT_TRUE(mask == 0 || difference > 0) << "case " << i << " at " << x << "," << y;
        changed += mask > 0 ? 1 : 0;
      }
    EXPECT_TRUE(changed > 10 || cases[i].size.width < 37) << "case " << i;
  }
}

const auto kLonely = [](int x, int y, int) { return x == 20 && y == 9 ? 1e4F : 0.25F; };

TEST(Firefly, TakesALonelyOneDownToTheFloorOrToItsNeighbors) {
  for (const char* method : {"bound", "range", "rank"}) {
    PassTest pass("firefly");
    pass.set("method", method).input("color", test_image(QUELL_TYPE_COLOR, {41, 19}, kLonely)).run();
    const bool bound = std::string(method) == "bound";
    for (int y = 0; y < 19; ++y)
      for (int x = 0; x < 41; ++x) {
        const bool lonely = x == 20 && y == 9;
        ASSERT_EQ(pass.output("mask").at(x, y), lonely ? 1.0F : 0.0F) << method << " at " << x << "," << y;
        ASSERT_NEAR(pass.output("color").at(x, y), lonely && bound ? 1 : 0.25, lonely ? 1e-5 : 0) << x << "," << y;
      }
  }
}

// As its documentation says: (n - 1) / sqrt(n) = 6.857 deviations for n = 49.
TEST(Firefly, IsHiddenByItselfWhereTheCenterCounts) {
  const auto left_of_it = [](double k) {
    PassTest pass("firefly");
    pass.set("exclude_center", false).set("k", k).set("floor", 0.0);
    pass.input("color", test_image(QUELL_TYPE_COLOR, {41, 19}, kLonely)).run();
    return pass.output("color").at(20, 9);
  };
  EXPECT_NEAR(left_of_it(2), 0.25 + 9999.75 * (1 + 2 * 7) / 49, 0.1);
  EXPECT_LT(left_of_it(6.8), 1e4);
  EXPECT_EQ(left_of_it(6.9), 1e4F);
}

// Neighbors of 1e-3 and their deviation are found beside a firefly of 1e6.
TEST(Firefly, IsNotRoundedOffByWhatItClamps) {
  const auto dark = [](int x, int y, int) { return x == 20 && y == 9 ? 1e6F : static_cast<float>(1e-3 + 1e-4 * ((x + y) % 2)); };
  PassTest pass("firefly");
  pass.set("floor", 0.0).input("color", test_image(QUELL_TYPE_COLOR, {41, 19}, dark)).run();
  // 24 of 48 taps have 1.1e-3; sigma^2 = 48 (5e-5)^2 / 47.
  EXPECT_NEAR(pass.output("color").at(20, 9), 1.05e-3 + 2 * 5e-5 * std::sqrt(48.0 / 47), 1e-8);
}

TEST(Firefly, LeavesAConstantImageBitForBit) {
  for (const char* method : {"bound", "range", "rank"})
    for (const char* measure : {"luminance", "channels"}) {
      PassTest pass("firefly");
      pass.set("method", method).set("measure", measure).set("k", 0.0).set("floor", 0.0);
      pass.input("color", test_image(QUELL_TYPE_COLOR, {33, 9}, [](int, int, int c) { return 3.1F + static_cast<float>(c); }));
      pass.run();
      for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 33; ++x) {
          ASSERT_EQ(pass.output("color").at(x, y, 2), 5.1F) << method << " at " << x << "," << y;
          ASSERT_EQ(pass.output("mask").at(x, y), 0.0F) << method << " at " << x << "," << y;
        }
    }
}

TEST(Firefly, KeepsTheHueByLuminance) {
  const auto red = [](int x, int y, int c) { return x == 9 && y == 4 ? (c == 0 ? 800.0F : 40.0F) : 0.5F; };
  PassTest pass("firefly");
  pass.input("color", test_image(QUELL_TYPE_COLOR, {19, 9}, red)).run();
  const FloatImage out = pass.output("color");
  EXPECT_NEAR(luminance({out.at(9, 4, 0), out.at(9, 4, 1), out.at(9, 4, 2)}), 1, 1e-6);
  EXPECT_NEAR(out.at(9, 4, 0) / out.at(9, 4, 1), 20, 1e-5);
}

// Above the floor, too, which must not take the place of limits that are not known.
TEST(Firefly, ChangesNothingByWhatIsNotANumber) {
  const auto broken = [](int x, int y, int) { return x == 5 && y == 5 ? std::numeric_limits<float>::quiet_NaN() : 2.5F; };
  for (const char* method : {"bound", "range", "rank"}) {
    PassTest pass("firefly");
    pass.set("method", method).input("color", test_image(QUELL_TYPE_COLOR, {12, 12}, broken)).run();
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 12; ++x) {
        const float got = pass.output("color").at(x, y);
        ASSERT_TRUE(x == 5 && y == 5 ? std::isnan(got) : got == 2.5F) << method << " at " << x << "," << y << ": " << got;
      }
  }
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(firefly);
QUELL_CONFORMANCE_TEST(firefly, .set("method", "range").set("measure", "channels").set("k", 0.5).set("radius", 2));
QUELL_CONFORMANCE_TEST(firefly, .set("method", "rank"));
