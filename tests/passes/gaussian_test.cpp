#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"

namespace quell {
namespace {

// Straight from the formula, over the square and in double.
double expected(Size size, double sigma, int radius, int x, int y, int c) {
  double sum = 0, weights = 0;
  for (int qy = std::max(0, y - radius); qy <= std::min(size.height - 1, y + radius); ++qy)
    for (int qx = std::max(0, x - radius); qx <= std::min(size.width - 1, x + radius); ++qx) {
      const double w = std::exp(-((qx - x) * (qx - x) + (qy - y) * (qy - y)) / (2 * sigma * sigma));
      sum += w * scene::color(qx, qy, c), weights += w;
    }
  return sum / weights;
}

struct Case {
  double sigma;
  int radius;  // of the parameter
  int window;  // what it means
};

// Roundings: of a weight, a product and a running sum of at most 1, in each direction, and two gains: 2 (3 + 1) 6e-8 and the
// running sums' 6e-8 sqrt(taps), of values up to 2.
TEST(Gaussian, EqualsItsFormulaInDouble) {
  for (const Size size : {Size{1, 1}, {15, 5}, {16, 9}, {33, 17}, {67, 3}, {3, 40}, {150, 20}})
    for (const Case& c : {Case{2, -1, 6}, {0.5, -1, 2}, {1.1, -1, 4}, {5, 3, 3}, {3, 0, 0}, {10, 40, 40}, {0.01, -1, 1}}) {
      PassTest pass("gaussian");
      pass.set("sigma", c.sigma).set("radius", c.radius).input("image", test_image(QUELL_TYPE_COLOR, size, scene::color));
      pass.run();
      EXPECT_EQ(pass.radius("image"), c.window);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
          for (int k = 0; k < 3; ++k)
            ASSERT_NEAR(pass.output("image").at(x, y, k), expected(size, c.sigma, c.window, x, y, k), 2e-6)
                << x << "," << y << " of " << size.width << " x " << size.height << ", sigma " << c.sigma;
    }
}

TEST(Gaussian, LeavesAConstantConstantUpToTheBorder) {
  PassTest pass("gaussian");
  pass.set("sigma", 4.0).input("image", test_image(QUELL_TYPE_VARIANCE, {29, 13}, [](int, int, int) { return 1e4F; }));
  pass.run();
  for (int y = 0; y < 13; ++y)
    for (int x = 0; x < 29; ++x) ASSERT_NEAR(pass.output("image").at(x, y), 1e4, 1e4 * 1e-6) << x << "," << y;
}

// Far from borders nothing is lost, and the variance of the spot is sigma^2 in each direction: for a window of 8 sigma, and a
// sigma at which sampling does not show.
TEST(Gaussian, MakesASpotOfItsOwnVariance) {
  PassTest pass("gaussian");
  pass.set("sigma", 3.0).set("radius", 24);
  pass.input("image",
             test_image(QUELL_TYPE_SCALAR, {61, 59}, [](int x, int y, int) { return x == 30 && y == 28 ? 1.0F : 0.0F; }));
  pass.run();
  double sum = 0, across = 0, down = 0;
  for (int y = 0; y < 59; ++y)
    for (int x = 0; x < 61; ++x) {
      const double v = pass.output("image").at(x, y);
      sum += v, across += v * (x - 30) * (x - 30), down += v * (y - 28) * (y - 28);
    }
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_NEAR(across, 9, 1e-4);
  EXPECT_NEAR(down, 9, 1e-4);
}

TEST(Gaussian, RefusesWhatAMeanHasNoMeaningFor) {
  PassTest pass("gaussian");
  EXPECT_THROW(pass.input("image", test_image(QUELL_TYPE_NORMAL, {3, 3}, scene::normal)).run(), Error);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(gaussian);
QUELL_CONFORMANCE_TEST(gaussian, .set("sigma", 7.0).set("radius", 20));
