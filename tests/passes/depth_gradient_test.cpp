#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

constexpr Size kSize{37, 11};

FloatImage gradient_of(PassTest& pass, const std::function<float(int, int, int)>& depth) {
  pass.input("depth", test_image(QUELL_TYPE_DEPTH, kSize, depth));
  pass.run();
  return pass.output("gradient");
}

TEST(DepthGradient, OfAPlaneIsItsLargerSlopeEverywhere) {
  PassTest pass("depth_gradient");
  const FloatImage out =
      gradient_of(pass, [](int x, int y, int) { return 100 + 0.25F * static_cast<float>(x) - 0.5F * static_cast<float>(y); });
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) ASSERT_EQ(out.at(x, y), 0.5F) << x << "," << y;
}

TEST(DepthGradient, DoesNotSeeAnEdgeFromEitherSide) {
  PassTest pass("depth_gradient");
  const FloatImage out = gradient_of(pass, [](int x, int, int) { return x < 20 ? 2.0F : 50.0F; });
  for (int x = 0; x < kSize.width; ++x) EXPECT_EQ(out.at(x, 5), 0.0F) << x;
}

// The definition, pixel by pixel, on depths with holes. Differences of floats are rounded once.
TEST(DepthGradient, IsTheLargerOfTheSmallerOneSidedDifferences) {
  const auto depth = [](int x, int y, int) {
    if ((x / 3 + y / 2) % 4 == 3) return QUELL_NO_SURFACE_DEPTH;
    return 5 + static_cast<float>((x * x * 7 + y * 13) % 29) / 8;
  };
  PassTest pass("depth_gradient");
  const FloatImage out = gradient_of(pass, depth);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      double want = 0;
      for (const auto& [ax, ay] : {std::pair{1, 0}, std::pair{0, 1}}) {
        double smaller = std::numeric_limits<double>::infinity();
        for (const int side : {-1, 1}) {
          const int qx = x + side * ax, qy = y + side * ay;
          if (qx < 0 || qy < 0 || qx >= kSize.width || qy >= kSize.height || depth(qx, qy, 0) >= 1e10F) continue;
          smaller = std::min(smaller, std::abs(double{depth(qx, qy, 0)} - depth(x, y, 0)));
        }
        if (!std::isinf(smaller)) want = std::max(want, smaller);
      }
      if (depth(x, y, 0) >= 1e10F) want = 0;
      ASSERT_EQ(out.at(x, y), static_cast<float>(want)) << x << "," << y;
    }
}

// Depths with holes; whole eighths, so that differences and halves of them are exact.
float holed_depth(int x, int y) {
  if ((x / 3 + y / 2) % 4 == 3) return QUELL_NO_SURFACE_DEPTH;
  return 5 + static_cast<float>((x * x * 7 + y * 13) % 29) / 8;
}
bool counts(int x, int y) { return x >= 0 && y >= 0 && x < kSize.width && y < kSize.height && holed_depth(x, y) < 1e10F; }
double difference(int ax, int ay, int bx, int by) {
  return counts(ax, ay) && counts(bx, by) ? std::abs(double{holed_depth(ax, ay)} - holed_depth(bx, by)) : 0;
}
// Along the axis (dx, dy).
double central(int x, int y, int dx, int dy) {
  if (counts(x - dx, y - dy) && counts(x + dx, y + dy)) return difference(x - dx, y - dy, x + dx, y + dy) / 2;
  return difference(x, y, x - dx, y - dy) + difference(x, y, x + dx, y + dy);  // one of which is 0
}
double quad(int x, int y, int dx, int dy) {
  const int side = (dx * x + dy * y) % 2 == 0 ? 1 : -1;
  return difference(x, y, x + side * dx, y + side * dy);
}

void expect_larger_of_both_axes(const char* differences, double (*along)(int, int, int, int)) {
  PassTest pass("depth_gradient");
  pass.set("differences", differences);
  const FloatImage out = gradient_of(pass, [](int x, int y, int) { return holed_depth(x, y); });
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const double want = counts(x, y) ? std::max(along(x, y, 1, 0), along(x, y, 0, 1)) : 0;
      ASSERT_EQ(out.at(x, y), static_cast<float>(want)) << differences << " at " << x << "," << y;
    }
}
TEST(DepthGradient, TakesCentralDifferences) { expect_larger_of_both_axes("central", central); }
TEST(DepthGradient, TakesDifferencesWithinQuads) { expect_larger_of_both_axes("quad", quad); }

// Quads begin at even columns, so that the edge before column 20 lies between two of them, and that before 21 in one; central
// differences see both, from both sides.
TEST(DepthGradient, SeesAnEdgeWhereItsDifferencesCrossIt) {
  for (const int edge : {20, 21}) {
    const auto depth = [=](int x, int, int) { return x < edge ? 2.0F : 50.0F; };
    PassTest central_pass("depth_gradient"), quad_pass("depth_gradient");
    central_pass.set("differences", "central");
    quad_pass.set("differences", "quad");
    const FloatImage by_center = gradient_of(central_pass, depth), by_quad = gradient_of(quad_pass, depth);
    for (int x = 0; x < kSize.width; ++x) {
      EXPECT_EQ(by_center.at(x, 5), x == edge - 1 || x == edge ? 24.0F : 0.0F) << x;
      EXPECT_EQ(by_quad.at(x, 5), edge == 21 && (x == 20 || x == 21) ? 48.0F : 0.0F) << x;
    }
  }
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(depth_gradient);
QUELL_CONFORMANCE_TEST(depth_gradient, .set("differences", "central"));
QUELL_CONFORMANCE_TEST(depth_gradient, .set("differences", "quad"));
