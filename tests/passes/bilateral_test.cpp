#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

using Vec = std::array<double, 3>;
using Colors = std::function<Vec(int x, int y)>;

struct Case {
  Size size;
  int radius;
  double sigma_coord, sigma_color;
  bool separable = false;
};

// Noise of 0 to 2 with an edge, and a few pixels that are far brighter.
float color(int x, int y, int c) {
  return static_cast<float>(scene::color(x, y, c) + (x + 2 * y > 30 ? 3 : 0) + (x % 11 == 5 && y % 5 == 2 ? 40 : 0));
}
Vec noisy(int x, int y) { return {color(x, y, 0), color(x, y, 1), color(x, y, 2)}; }

PassTest make(const Case& c) {
  PassTest pass("bilateral");
  pass.set("radius", c.radius).set("sigma_coord", c.sigma_coord).set("sigma_color", c.sigma_color);
  pass.set("separable", c.separable).input("color", test_image(QUELL_TYPE_COLOR, c.size, color));
  return pass;
}

Vec filtered(const Case& c, const Colors& colors, int radius_x, int radius_y, int x, int y) {
  Vec sum{};
  double weights = 0;
  for (int qy = std::max(0, y - radius_y); qy <= std::min(c.size.height - 1, y + radius_y); ++qy)
    for (int qx = std::max(0, x - radius_x); qx <= std::min(c.size.width - 1, x + radius_x); ++qx) {
      const Vec p = colors(x, y), q = colors(qx, qy);
      double contrast = 0;
      for (std::size_t k = 0; k < 3; ++k) contrast += (p[k] - q[k]) * (p[k] - q[k]);
      const double distance = (qx - x) * (qx - x) + (qy - y) * (qy - y);
      const double w = std::exp(-distance / (2 * c.sigma_coord * c.sigma_coord) - contrast / (2 * c.sigma_color * c.sigma_color));
      weights += w;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += w * q[k];
    }
  return {sum[0] / weights, sum[1] / weights, sum[2] / weights};
}

std::vector<Vec> filtered_everywhere(const Case& c, const Colors& colors, int radius_x, int radius_y) {
  std::vector<Vec> all;
  for (int y = 0; y < c.size.height; ++y)
    for (int x = 0; x < c.size.width; ++x) all.push_back(filtered(c, colors, radius_x, radius_y, x, y));
  return all;
}

std::vector<Vec> reference(const Case& c) {
  if (!c.separable) return filtered_everywhere(c, noisy, c.radius, c.radius);
  const std::vector<Vec> rows = filtered_everywhere(c, noisy, c.radius, 0);
  return filtered_everywhere(
      c, [&](int x, int y) { return rows[static_cast<std::size_t>(y * c.size.width + x)]; }, 0, c.radius);
}

// A weight exp(-E) errs by 3.8e-6 (2^x) and 3e-7 E (roundings of the exponent), where taps beyond E = 15 do not count; a mean by
// twice that, of differences within the window. The second of two filters errs by as much again.
TEST(Bilateral, EqualsItsFormulaInDouble) {
  for (const bool separable : {false, true})
    for (const Case& base : {Case{{1, 1}, 3, 3, 0.5},
                             {{15, 5}, 4, 2, 1},
                             {{16, 9}, 8, 3, 0.5},
                             {{33, 17}, 3, 10, 3},
                             {{3, 40}, 20, 6, 0.7},
                             {{150, 7}, 5, 3, 0.3},
                             {{40, 20}, 0, 3, 0.5},
                             {{37, 12}, 4, 1e6, 1e6}}) {
      Case c = base;
      c.separable = separable;
      PassTest pass = make(c);
      pass.run();
      const std::vector<Vec> want = reference(c);
      for (int y = 0; y < c.size.height; ++y)
        for (int x = 0; x < c.size.width; ++x)
          for (int k = 0; k < 3; ++k) {
            const double expected = want[static_cast<std::size_t>(y * c.size.width + x)][static_cast<std::size_t>(k)];
            ASSERT_NEAR(pass.output("color").at(x, y, k), expected, 3e-5 * expected + 1e-6)
                << x << "," << y << " of " << c.size.width << " x " << c.size.height << (separable ? " separable" : "");
          }
    }
}

TEST(Bilateral, KeepsAnEdgeAndSmoothsBesideIt) {
  const auto edge = [](int x, int y, int c) { return static_cast<float>(0.1 * scene::noise(x, y, c) + (x < 20 ? 1 : 5)); };
  for (const bool separable : {false, true}) {
    PassTest pass("bilateral");
    pass.set("separable", separable).input("color", test_image(QUELL_TYPE_COLOR, {40, 20}, edge)).run();
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 40; ++x)
        // The mean of 0.1 noise is 0.05; at a corner some 20 pixels weigh much, so that it varies by 0.1 / sqrt(12 20).
        ASSERT_NEAR(pass.output("color").at(x, y), (x < 20 ? 1 : 5) + 0.05, 4 * 0.0065) << x << "," << y;
  }
}

TEST(Bilateral, LeavesOutATapThatIsNotFinite) {
  for (const bool separable : {false, true}) {
    PassTest pass("bilateral");
    pass.set("separable", separable).input("color", test_image(QUELL_TYPE_COLOR, {20, 20}, [](int x, int y, int) {
                                             return x == 9 && y == 9 ? std::numeric_limits<float>::quiet_NaN() : 0.5F;
                                           }));
    pass.run();
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x)
        if (x == 9 && y == 9) {
          EXPECT_TRUE(std::isnan(pass.output("color").at(x, y)));
        } else {
          ASSERT_NEAR(pass.output("color").at(x, y), 0.5, 1e-6) << x << "," << y;
        }
  }
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(bilateral);
QUELL_CONFORMANCE_TEST(bilateral, .set("separable", true).set("radius", 4));
