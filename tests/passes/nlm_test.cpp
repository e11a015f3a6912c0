#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"

namespace quell {
namespace {

using Plane = std::function<float(int x, int y, int c)>;

// An edge, and noise whose variance grows to the right.
float color(int x, int y, int c) {
  return static_cast<float>((x + 2 * y > 30 ? 2 : 1) + (0.2 + 0.02 * x) * (scene::noise(x, y, c) - 0.5));
}
float variance(int x, int y, int c) {
  const double width = 0.2 + 0.02 * x;
  return static_cast<float>(width * width / 12 * (0.5 + scene::noise(x, y, c + 9)));
}
float albedo(int x, int y, int c) { return static_cast<float>(0.2 * c + (y > 8 ? 0.5 : 0) + 0.05 * scene::noise(x, y, c + 3)); }
float depth(int x, int y, int c) { return scene::depth(x, y, c); }  // with holes at 1e10
float feature_variance(int x, int y, int) { return static_cast<float>(0.01 * scene::noise(x, y, 40)); }

struct Case {
  Size size{37, 17};
  int radius = 3, patch_radius = 1;
  double k = 1, alpha = 1;
  bool symmetric = false, by_channel = false, with_features = false, with_variances = false;
  double k_feature = 0.6, tau = 1e-3;
};

PassTest make(const Case& c) {
  PassTest pass("nlm");
  pass.set("radius", c.radius).set("patch_radius", c.patch_radius).set("k", c.k).set("alpha", c.alpha);
  pass.set("cancellation", c.symmetric ? "symmetric" : "conservative").set("k_feature", c.k_feature).set("tau", c.tau);
  pass.input("color", test_image(QUELL_TYPE_COLOR, c.size, color));
  pass.input("variance", test_image(c.by_channel ? QUELL_TYPE_COLOR : QUELL_TYPE_VARIANCE, c.size, variance));
  if (!c.with_features) return pass;
  pass.input("feature", test_image(QUELL_TYPE_ALBEDO, c.size, albedo));
  pass.input("feature", test_image(QUELL_TYPE_DEPTH, c.size, depth));
  for (int i = 0; i < 2 && c.with_variances; ++i)
    pass.input("feature_variance", test_image(QUELL_TYPE_VARIANCE, c.size, feature_variance));
  return pass;
}

bool contains(Size size, int x, int y) { return x >= 0 && y >= 0 && x < size.width && y < size.height; }

// Equation by equation, from the documentation.
double pixel_distance(const Case& c, int px, int py, int qx, int qy) {
  const auto value = [&](int x, int y, int channel) -> double {
    if (c.by_channel) return color(x, y, channel);
    return 0.2126 * color(x, y, 0) + 0.7152 * color(x, y, 1) + 0.0722 * color(x, y, 2);
  };
  double sum = 0;
  const int channels = c.by_channel ? 3 : 1;
  for (int i = 0; i < channels; ++i) {
    const double difference = value(px, py, i) - value(qx, qy, i), v = variance(px, py, i), w = variance(qx, qy, i);
    sum += (difference * difference - c.alpha * (v + (c.symmetric ? w : std::min(v, w)))) / (1e-10 + c.k * c.k * (v + w));
  }
  return sum / channels;
}

double patch_distance(const Case& c, int px, int py, int qx, int qy) {
  double sum = 0;
  int count = 0;
  for (int ny = -c.patch_radius; ny <= c.patch_radius; ++ny)
    for (int nx = -c.patch_radius; nx <= c.patch_radius; ++nx)
      if (contains(c.size, px + nx, py + ny) && contains(c.size, qx + nx, qy + ny))
        sum += pixel_distance(c, px + nx, py + ny, qx + nx, qy + ny), ++count;
  return sum / count;
}

double feature_distance(const Case& c, const Plane& f, int planes, int px, int py, int qx, int qy) {
  const int left = std::max(px - 1, 0), right = std::min(px + 1, c.size.width - 1);
  const int above = std::max(py - 1, 0), below = std::min(py + 1, c.size.height - 1);
  double squared = 0, gradient = 0;
  for (int i = 0; i < planes; ++i) {
    squared += std::pow(double{f(px, py, i)} - f(qx, qy, i), 2);
    // Depth alone has holes, whose edges are no slopes.
    const auto is_hole = [&](int x, int y) { return f(x, y, i) == 1e10F; };
    const int x0 = is_hole(left, py) ? px : left, x1 = is_hole(right, py) ? px : right;
    const int y0 = is_hole(px, above) ? py : above, y1 = is_hole(px, below) ? py : below;
    if (is_hole(px, py)) continue;
    if (x1 > x0) gradient += std::pow((double{f(x1, py, i)} - f(x0, py, i)) / (x1 - x0), 2);
    if (y1 > y0) gradient += std::pow((double{f(px, y1, i)} - f(px, y0, i)) / (y1 - y0), 2);
  }
  const double v = c.with_variances ? feature_variance(px, py, 0) : 0, w = c.with_variances ? feature_variance(qx, qy, 0) : 0;
  return (squared - (v + std::min(v, w))) / (c.k_feature * c.k_feature * std::max({c.tau, v, gradient}));
}

std::array<double, 3> expected(const Case& c, int x, int y) {
  std::array<double, 3> sum{};
  double weights = 0;
  for (int qy = std::max(0, y - c.radius); qy <= std::min(c.size.height - 1, y + c.radius); ++qy)
    for (int qx = std::max(0, x - c.radius); qx <= std::min(c.size.width - 1, x + c.radius); ++qx) {
      double e = std::max(0.0, patch_distance(c, x, y, qx, qy));
      if (c.with_features) {
        e = std::max(e, feature_distance(c, albedo, 3, x, y, qx, qy));
        e = std::max(e, feature_distance(c, depth, 1, x, y, qx, qy));
      }
      const double w = std::exp(-e);
      weights += w;
      for (int k = 0; k < 3; ++k) sum[static_cast<std::size_t>(k)] += w * color(qx, qy, k);
    }
  return {sum[0] / weights, sum[1] / weights, sum[2] / weights};
}

// A weight errs by 4e-6 (2^x) and roundings of its exponent, 6e-7 of it and of the terms that cancel in it; those of a pixel are
// of 1, so that a difference of 1e-7 in luminance, over a deviation of 0.04 (k = 0.3), is 1e-5 of an exponent of about 1. A mean
// of values of 1 to 2 errs by no more.
TEST(Nlm, EqualsItsFormulaInDouble) {
  const std::array<Case, 13> cases{Case{},
                                   {.k = 0.3, .symmetric = true},
                                   {.by_channel = true},
                                   {.radius = 5, .patch_radius = 3, .k = 0.45},
                                   {.radius = 4, .patch_radius = 0, .alpha = 0},
                                   {.with_features = true},
                                   {.k = 0.5, .by_channel = true, .with_features = true, .with_variances = true},
                                   {.with_features = true, .k_feature = 2, .tau = 0.1},
                                   {.size = {1, 1}, .with_features = true},
                                   {.size = {1, 20}, .radius = 7, .patch_radius = 3, .with_features = true},
                                   {.size = {3, 2}, .radius = 10, .patch_radius = 8},
                                   {.size = {150, 5}, .radius = 2, .patch_radius = 2, .with_features = true},
                                   {.size = {20, 20}, .radius = 0, .patch_radius = 0, .with_features = true}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    PassTest pass = make(cases[i]);
    pass.run();
    for (int y = 0; y < cases[i].size.height; ++y)
      for (int x = 0; x < cases[i].size.width; ++x) {
        const std::array<double, 3> want = expected(cases[i], x, y);
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(pass.output("color").at(x, y, c), want[static_cast<std::size_t>(c)], 3e-5)
              << "case " << i << " at " << x << "," << y;
      }
  }
}

constexpr Size kWide{80, 60};
float noisy(int x, int y, int c) { return static_cast<float>(scene::noise(x, y, c)); }
Image uniform_variance(double of) {
  return test_image(QUELL_TYPE_COLOR, kWide, [=](int, int, int) { return static_cast<float>(of); });
}

// Of pure noise, differences are what the variance expects: with the cancellation most weights are near 1, and 225 taps leave
// little. Without it they are about exp(-1 / 0.45^2) = 0.007, 224 of them as much as 1.6 beside the pixel's own 1, of which
// 1 / 2.6^2 of the variance is left.
TEST(Nlm, AveragesNoiseThatItsVarianceExplains) {
  const auto variance_left = [](double alpha) {
    PassTest pass("nlm");
    pass.set("k", 0.45).set("alpha", alpha).set("cancellation", "symmetric");
    pass.input("color", test_image(QUELL_TYPE_COLOR, kWide, noisy)).input("variance", uniform_variance(1.0 / 12)).run();
    double sum = 0, squares = 0;
    for (int y = 0; y < kWide.height; ++y)
      for (int x = 0; x < kWide.width; ++x) {
        const double v = pass.output("color").at(x, y);
        sum += v, squares += v * v;
      }
    const double n = kWide.width * kWide.height;
    return squares / n - sum * sum / n / n;
  };
  // At best 1 / 12 / 225; the weights' spread and the border, whose windows are down to a quarter, leave up to twice that.
  EXPECT_LT(variance_left(1), 2.0 / 12 / 225);
  EXPECT_NEAR(variance_left(0), 1.0 / 12 / (2.6 * 2.6), 0.3 / 12 / (2.6 * 2.6));
}

TEST(Nlm, KeepsAnEdgeThatIsNoNoise) {
  const auto edge = [](int x, int y, int c) { return static_cast<float>(0.1 * scene::noise(x, y, c) + (x < 40 ? 1 : 3)); };
  PassTest pass("nlm");
  pass.input("color", test_image(QUELL_TYPE_COLOR, kWide, edge)).input("variance", uniform_variance(0.01 / 12)).run();
  for (int y = 0; y < kWide.height; ++y)
    for (int x = 0; x < kWide.width; ++x)
      ASSERT_NEAR(pass.output("color").at(x, y), (x < 40 ? 1 : 3) + 0.05, 0.051) << x << "," << y;  // nothing of the other side
}

TEST(Nlm, NeverCrossesAnEdgeOfAFeature) {
  PassTest pass("nlm");
  const auto half = [](int x, int, int) { return x < 40 ? 0.0F : 1.0F; };
  pass.set("k", 100.0).input("variance", uniform_variance(100));
  pass.input("color", test_image(QUELL_TYPE_COLOR, kWide, half));
  pass.run();
  EXPECT_NEAR(pass.output("color").at(40, 30), 8.0 / 15, 1e-3);  // by colors alone, 8 columns of 15
  pass.input("feature", test_image(QUELL_TYPE_SCALAR, kWide, half)).set("k_feature", 0.3).run();
  // At the edge the gradient is 1/2: the other side weighs exp(-1 / (0.09 / 4)), elsewhere less.
  for (int x = 0; x < kWide.width; ++x) ASSERT_NEAR(pass.output("color").at(x, 30), half(x, 0, 0), 1e-6) << x;
}

// A wall before another one, and background above: the edge of the background is no slope that explains the step.
TEST(Nlm, TellsDepthsApartBesideTheBackground) {
  PassTest pass("nlm");
  const auto near_left = [](int x, int, int) { return x < 40 ? 0.0F : 1.0F; };
  pass.set("k", 100.0).input("variance", uniform_variance(100));
  pass.input("color", test_image(QUELL_TYPE_COLOR, kWide, near_left));
  pass.input("feature",
             test_image(QUELL_TYPE_DEPTH, kWide, [](int x, int y, int) { return y < 30 ? 1e10F : (x < 36 ? 2.0F : 9.0F); }));
  pass.run();
  // At x = 35 the step itself is in the gradient.
  for (int x = 0; x < 35; ++x) ASSERT_NEAR(pass.output("color").at(x, 30), 0, 1e-6) << x;
}

TEST(Nlm, TakesAVarianceBelowZeroAsNone) {
  const auto of = [](float v) {
    PassTest pass = make({.with_features = true});
    pass.disconnect("variance").input("variance", test_image(QUELL_TYPE_VARIANCE, {37, 17}, [v](int x, int y, int) {
                                        return x % 3 == y % 2 ? v : 1.0F;
                                      }));
    pass.run();
    return pass.output_item("color");
  };
  const Item negative = of(-5), none = of(0);
  for (int y = 0; y < 17; ++y)
    for (int x = 0; x < 37; ++x) ASSERT_EQ(negative.image()->floats().at(x, y), none.image()->floats().at(x, y)) << x << "," << y;
}

TEST(Nlm, LeavesAsItIsWhatHasNoVariance) {
  PassTest pass("nlm");
  pass.input("color", test_image(QUELL_TYPE_COLOR, kWide, noisy)).input("variance", uniform_variance(0)).run();
  for (int y = 0; y < kWide.height; ++y)
    for (int x = 0; x < kWide.width; ++x) ASSERT_NEAR(pass.output("color").at(x, y), noisy(x, y, 0), 1e-6) << x << "," << y;
}

TEST(Nlm, RefusesAVarianceTooFew) {
  PassTest pass = make({.with_features = true});
  pass.input("feature_variance", test_image(QUELL_TYPE_VARIANCE, {37, 17}, feature_variance));
  EXPECT_THAT([&] { pass.run(); }, ::testing::ThrowsMessage<Error>(::testing::HasSubstr("2 features and 1 variances")));
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(nlm, .set("radius", 3).set("patch_radius", 2));
QUELL_CONFORMANCE_TEST(nlm, .set("radius", 0).set("patch_radius", 0));
QUELL_CONFORMANCE_TEST(nlm, .set("cancellation", "symmetric").set("radius", 1).set("patch_radius", 1));
