#include <gtest/gtest.h>

#include <algorithm>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

constexpr Size kSize{37, 11};

float noise(int x, int y, int) { return static_cast<float>((x * x * 7 + y * 13 + x * y) % 31) / 8; }

double blurred(int x, int y, bool renormalizes) {
  double sum = 0, weights = 0;
  for (int qy = std::max(0, y - 1); qy <= std::min(kSize.height - 1, y + 1); ++qy)
    for (int qx = std::max(0, x - 1); qx <= std::min(kSize.width - 1, x + 1); ++qx) {
      const double w = (qx == x ? 0.5 : 0.25) * (qy == y ? 0.5 : 0.25);
      sum += w * noise(qx, qy, 0), weights += w;
    }
  return renormalizes ? sum / weights : sum;
}

TEST(VarianceBlur, IsTheGaussianOfThePaperInDouble) {
  for (const bool renormalizes : {true, false}) {
    PassTest pass("variance_blur");
    pass.set("border", renormalizes ? "renormalize" : "zero").input("variance", test_image(QUELL_TYPE_VARIANCE, kSize, noise));
    pass.run();
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x)  // a handful of roundings of values up to 4
        ASSERT_NEAR(pass.output("variance").at(x, y), blurred(x, y, renormalizes), 1.5e-6) << x << "," << y;
  }
}

TEST(VarianceBlur, KeepsAConstantUpToTheBorder) {
  PassTest pass("variance_blur");
  pass.input("variance", test_image(QUELL_TYPE_VARIANCE, kSize, [](int, int, int) { return 3.0F; }));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) ASSERT_NEAR(pass.output("variance").at(x, y), 3, 1e-6) << x << "," << y;
}

TEST(VarianceBlur, KeepsASinglePixel) {
  PassTest pass("variance_blur");
  pass.input("variance", test_image(QUELL_TYPE_VARIANCE, {1, 1}, [](int, int, int) { return 2.0F; }));
  pass.run();
  EXPECT_EQ(pass.output("variance").at(0, 0), 2.0F);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(variance_blur);
QUELL_CONFORMANCE_TEST(variance_blur, .set("border", "zero"));
