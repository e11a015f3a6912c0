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

// Normals that face anywhere, with holes.
bool counts(int x, int y) { return x >= 0 && y >= 0 && x < kSize.width && y < kSize.height && (x / 3 + y / 2) % 4 != 3; }
float holed_normal(int x, int y, int c) {
  if (!counts(x, y)) return 0;
  const double a = std::fmod(x * x * 7.31 + y * 13.17, 29), b = std::fmod(x * 5.77 + y * y * 3.41, 23);
  const Vec n{std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
  return static_cast<float>(n[static_cast<std::size_t>(c)]);
}
// Of one component, without sign.
double difference(int ax, int ay, int bx, int by, int c) {
  return counts(ax, ay) && counts(bx, by) ? std::abs(double{holed_normal(ax, ay, c)} - holed_normal(bx, by, c)) : 0;
}
// Along the axis (dx, dy).
double central(int x, int y, int dx, int dy, int c) {
  if (counts(x - dx, y - dy) && counts(x + dx, y + dy)) return difference(x - dx, y - dy, x + dx, y + dy, c) / 2;
  return difference(x, y, x - dx, y - dy, c) + difference(x, y, x + dx, y + dy, c);  // one of which is 0
}
double quad(int x, int y, int dx, int dy, int c) {
  const int side = (dx * x + dy * y) % 2 == 0 ? 1 : -1;
  return difference(x, y, x + side * dx, y + side * dy, c);
}

void expect_length_of_both_axes(const char* differences, double (*along)(int, int, int, int, int)) {
  PassTest pass("normal_gradient");
  pass.set("differences", differences);
  const FloatImage out = gradient_of(pass, holed_normal);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      double squares = 0;
      for (int c = 0; c < 3; ++c) squares += std::pow(along(x, y, 1, 0, c) + along(x, y, 0, 1, c), 2);
      ASSERT_NEAR(out.at(x, y), counts(x, y) ? std::sqrt(squares) : 0, 1e-6) << differences << " at " << x << "," << y;
    }
}
TEST(NormalGradient, TakesCentralDifferences) { expect_length_of_both_axes("central", central); }
TEST(NormalGradient, TakesDifferencesWithinQuads) { expect_length_of_both_axes("quad", quad); }

// A right angle between columns 20 and 21, within a quad.
TEST(NormalGradient, SeesAnEdgeWhereItsDifferencesCrossIt) {
  const double root2 = std::sqrt(2.0);
  for (const auto& [differences, want] : {std::pair{"central", root2 / 2}, std::pair{"quad", root2}}) {
    PassTest pass("normal_gradient");
    pass.set("differences", differences);
    const FloatImage out = gradient_of(pass, [](int x, int, int c) { return c == (x < 21 ? 0 : 1) ? 1.0F : 0.0F; });
    for (int x = 0; x < kSize.width; ++x)
      EXPECT_FLOAT_EQ(out.at(x, 5), x == 20 || x == 21 ? static_cast<float>(want) : 0.0F) << x;
  }
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(normal_gradient);
QUELL_CONFORMANCE_TEST(normal_gradient, .set("differences", "central"));
QUELL_CONFORMANCE_TEST(normal_gradient, .set("differences", "quad"));
