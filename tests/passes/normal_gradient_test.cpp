#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

constexpr Size kSize{37, 11};
using Vec = std::array<double, 3>;

FloatImage gradient_of(PassTest& pass, const std::function<float(int, int, int)>& normal) {
  pass.input("normal", test_image(QUELL_TYPE_NORMAL, kSize, normal));
  pass.run();
  return pass.output("gradient");
}

TEST(NormalGradient, OfAPlaneIsZero) {
  PassTest pass("normal_gradient");
  const FloatImage out = gradient_of(pass, [](int, int, int c) { return c == 2 ? 1.0F : 0.0F; });
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) ASSERT_EQ(out.at(x, y), 0.0F) << x << "," << y;
}

// A normal that turns by 0.01 rad a pixel about an axis changes by 2 sin(0.005).
TEST(NormalGradient, OfACylinderIsItsTurn) {
  PassTest pass("normal_gradient");
  const FloatImage out = gradient_of(pass, [](int x, int, int c) {
    const double angle = 0.01 * x;
    return static_cast<float>(c == 0 ? std::sin(angle) : c == 2 ? std::cos(angle) : 0);
  });
  for (int x = 0; x < kSize.width; ++x) EXPECT_NEAR(out.at(x, 5), 2 * std::sin(0.005), 3e-7) << x;
}

TEST(NormalGradient, DoesNotSeeAnEdgeFromEitherSide) {
  PassTest pass("normal_gradient");
  const FloatImage out = gradient_of(pass, [](int x, int, int c) { return c == (x < 20 ? 0 : 1) ? 1.0F : 0.0F; });
  for (int x = 0; x < kSize.width; ++x) EXPECT_EQ(out.at(x, 5), 0.0F) << x;
}

// The definition, pixel by pixel, on normals that face anywhere, with holes.
TEST(NormalGradient, IsTheLengthOfBothChanges) {
  const auto is_hole = [](int x, int y) { return (x / 3 + y / 2) % 4 == 3; };
  const auto normal = [=](int x, int y, int c) {
    if (is_hole(x, y)) return 0.0F;
    const double a = std::fmod(x * x * 7.31 + y * 13.17, 29), b = std::fmod(x * 5.77 + y * y * 3.41, 23);  // no two alike
    const Vec n{std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
    return static_cast<float>(n[static_cast<std::size_t>(c)]);
  };
  PassTest pass("normal_gradient");
  const FloatImage out = gradient_of(pass, normal);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      Vec width{};
      for (const auto& [ax, ay] : {std::pair{1, 0}, std::pair{0, 1}}) {
        Vec nearest{};
        double shortest = std::numeric_limits<double>::infinity();
        for (const int side : {-1, 1}) {
          const int qx = x + side * ax, qy = y + side * ay;
          if (qx < 0 || qy < 0 || qx >= kSize.width || qy >= kSize.height || is_hole(qx, qy)) continue;
          Vec change{};
          double length = 0;
          for (int c = 0; c < 3; ++c) {
            change[static_cast<std::size_t>(c)] = double{normal(qx, qy, c)} - normal(x, y, c);
            length += std::pow(change[static_cast<std::size_t>(c)], 2);
          }
          if (length < shortest) shortest = length, nearest = change;
        }
        for (std::size_t c = 0; c < 3; ++c) width[c] += std::abs(nearest[c]);
      }
      const double want = is_hole(x, y) ? 0 : std::sqrt(width[0] * width[0] + width[1] * width[1] + width[2] * width[2]);
      ASSERT_NEAR(out.at(x, y), want, 1e-6) << x << "," << y;
    }
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(normal_gradient);
