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

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(depth_gradient);
