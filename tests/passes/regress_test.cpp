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

using Plane = std::function<float(int x, int y, int c)>;

bool is_hole(int x, int y) { return x / 5 == 3 && y / 4 % 2 == 1; }
// Of a bumpy surface far from the origin, in units of which a block spans a few.
float normal(int x, int y, int c) {
  if (is_hole(x, y)) return 0;
  const double a = 0.8 * scene::noise(x, y, 50), b = 0.1 * x + 6 * scene::noise(x, y, 51);
  return static_cast<float>(c == 0 ? std::sin(a) * std::cos(b) : c == 1 ? std::sin(a) * std::sin(b) : std::cos(a));
}
float position(int x, int y, int c) {
  return static_cast<float>(c == 0 ? 100 + 0.1 * x : c == 1 ? -7 + 0.07 * y : 3 + 0.5 * scene::noise(x, y, 52));
}
float color(int x, int y, int c) { return static_cast<float>(1 + 0.02 * x + scene::noise(x, y, c)); }

struct Case {
  Size size{70, 50};
  int block = 32, frame = 0;
  bool moving = false, with_normal = true, with_position = true;
};

PassTest make(const Case& c, double noise, const Plane& of = color) {
  PassTest pass("regress");
  pass.set("block", c.block).set("placement", c.moving ? "moving" : "fixed").set("noise", noise).next_frame(c.frame);
  pass.input("color", test_image(QUELL_TYPE_COLOR, c.size, of));
  if (c.with_normal) pass.input("normal", test_image(QUELL_TYPE_NORMAL, c.size, normal));
  if (c.with_position) pass.input("position", test_image(QUELL_TYPE_POSITION, c.size, position));
  return pass;
}

// A x = b by elimination, with pivots.
std::vector<long double> solve(std::vector<std::vector<long double>> a, std::vector<long double> b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t best = i;
    for (std::size_t j = i; j < n; ++j)
      if (std::abs(a[j][i]) > std::abs(a[best][i])) best = j;
    std::swap(a[i], a[best]), std::swap(b[i], b[best]);
    for (std::size_t j = i + 1; j < n; ++j) {
      const long double factor = a[j][i] / a[i][i];
      for (std::size_t k = i; k < n; ++k) a[j][k] -= factor * a[i][k];
      b[j] -= factor * b[i];
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  return b;
}

// The normal equations of a block's pixels. Positions are taken from the block's middle: that changes no function of them.
double fit(const Case& c, const Plane& of, int left, int top, int x, int y, int channel) {
  const int right = std::min(left + c.block, c.size.width), bottom = std::min(top + c.block, c.size.height);
  const auto features = [&](int px, int py) {
    std::vector<long double> f{1};
    for (int k = 0; c.with_normal && k < 3; ++k) f.push_back(normal(px, py, k));
    for (int power = 1; c.with_position && power <= 2; ++power)
      for (int k = 0; k < 3; ++k)
        f.push_back(std::pow(static_cast<long double>(position(px, py, k)) - position(left + 5, top + 5, k), power));
    return f;
  };
  const std::size_t n = features(0, 0).size();
  std::vector<std::vector<long double>> squares(n, std::vector<long double>(n));
  std::vector<long double> products(n);
  for (int py = top; py < bottom; ++py)
    for (int px = left; px < right; ++px) {
      if (c.with_normal && is_hole(px, py)) continue;
      const std::vector<long double> f = features(px, py);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) squares[i][j] += f[i] * f[j];
        products[i] += f[i] * of(px, py, channel);
      }
    }
  const std::vector<long double> weights = solve(squares, products), own = features(x, y);
  long double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += weights[i] * own[i];
  return static_cast<double>(std::max(sum, 0.0L));
}

// Where blocks of 32 pixels begin, from the published offsets less 16.
int origin(const Case& c, bool down) {
  if (!c.moving) return 0;
  const std::array<std::array<int, 2>, 16> begin{{{-30, -30},
                                                  {-12, -22},
                                                  {-24, -2},
                                                  {-8, -16},
                                                  {-26, -24},
                                                  {-14, -4},
                                                  {-4, -28},
                                                  {-26, -16},
                                                  {-4, -2},
                                                  {-24, -32},
                                                  {-10, -10},
                                                  {-18, -18},
                                                  {-10, -30},
                                                  {-32, -4},
                                                  {-2, -20},
                                                  {-22, -12}}};
  return begin[static_cast<std::size_t>(c.frame % 16)][down ? 1 : 0];
}

int block_begin(int at, int from, int block, int size) {
  const int begin = from + (at - from) / block * block;
  return std::clamp(begin, 0, std::max(size - block, 0));
}

// Both solve the same equations, in double and in long double: what differs are roundings of the result to float, and of
// conditions that the normal equations square, some 1e7 times 1e-19.
TEST(Regress, EqualsTheNormalEquations) {
  for (const Case& c : {Case{},
                        {.moving = true},
                        {.frame = 1, .moving = true},
                        {.frame = 9, .moving = true},
                        {.frame = 31, .moving = true},
                        {.with_normal = false},
                        {.with_position = false},
                        {.with_normal = false, .with_position = false},
                        {.size = {33, 40}, .block = 16},
                        {.size = {20, 45}},
                        {.size = {64, 32}}}) {
    PassTest pass = make(c, 0);
    pass.run();
    for (int y = 0; y < c.size.height; y += 3)
      for (int x = 0; x < c.size.width; ++x) {
        const int left = block_begin(x, origin(c, false), c.block, c.size.width);
        const int top = block_begin(y, origin(c, true), c.block, c.size.height);
        const double want = c.with_normal && is_hole(x, y) ? color(x, y, y % 3) : fit(c, color, left, top, x, y, y % 3);
        ASSERT_NEAR(pass.output("color").at(x, y, y % 3), want, 2e-6 * want)
            << x << "," << y << " of " << c.size.width << " x " << c.size.height << " in frame " << c.frame;
      }
  }
}

float quadratic(int x, int y, int c) {
  const double px = position(x, y, 0) - 100, py = position(x, y, 1) + 7, pz = position(x, y, 2) - 3;
  return static_cast<float>(5 + 0.3 * normal(x, y, c) + 0.1 * px + 0.02 * px * px - 0.5 * py + 0.1 * py * py + 0.2 * c * pz * pz);
}

TEST(Regress, ReturnsWhatIsALinearFunctionOfFeatures) {
  for (const double noise : {0.0, 0.01}) {
    PassTest pass = make({.moving = true}, noise, quadratic);
    pass.run();
    double squares = 0;
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 70; ++x) {
        const double difference = pass.output("color").at(x, y) - quadratic(x, y, 0);
        squares += difference * difference;
        // Roundings: of a color of about 5, which the fit averages, and of positions around 100, to 4e-6, times their weights.
        ASSERT_NEAR(difference, 0, noise == 0 ? 5e-6 : 0.1) << x << "," << y;
      }
    // Noise of 0.01 / sqrt(3) in features with weights up to 2.5 (the range of a block's positions, 3.1, makes 0.8 and 0.6 of it;
    // s and s^2 are so much alike that they share it unevenly) has to be small against the color's own spread of 0.5.
    EXPECT_LT(std::sqrt(squares / 3500), 0.02);
  }
}

// Every feature the same everywhere: nothing but noise tells pixels apart. Of noise of variance 1/12 each of nine weights can
// explain 1 / 1024, at the block's middle nothing.
TEST(Regress, OfConstantFeaturesIsTheMean) {
  for (const double noise : {0.0, 1e-4, 1e-2}) {
    PassTest pass("regress");
    pass.set("noise", noise).set("placement", "fixed");
    pass.input("color", test_image(QUELL_TYPE_COLOR, {64, 32},
                                   [](int x, int y, int c) { return static_cast<float>(scene::noise(x, y, c)); }));
    pass.input("normal", test_image(QUELL_TYPE_NORMAL, {64, 32}, [](int, int, int c) { return c == 2 ? 1.0F : 0.0F; }));
    pass.input("position",
               test_image(QUELL_TYPE_POSITION, {64, 32}, [](int, int, int c) { return 4.0F + static_cast<float>(c); }));
    pass.run();
    for (int block = 0; block < 2; ++block) {
      double mean = 0;
      for (int y = 0; y < 32; ++y)
        for (int x = 32 * block; x < 32 * block + 32; ++x) mean += scene::noise(x, y, 1) / 1024;
      // A weight of noise in the noise has the deviation sqrt(1/12) / (noise / sqrt(3)) / 32, the mean of that noise the
      // deviation noise / sqrt(3) / 32: nine products of 2.8e-4.
      for (int x = 32 * block; x < 32 * block + 32; ++x)
        ASSERT_NEAR(pass.output("color").at(x, 9, 1), mean, noise == 0 ? 1e-6 : 4 * 3 * 2.8e-4) << x << ", noise " << noise;
    }
  }
}

// Plane walls, seen straight on: normals are constant, a coordinate is, and a feature is the sum of others.
TEST(Regress, TakesFeaturesThatDependOnEachOther) {
  const auto wall = [](int x, int y, int c) {
    return static_cast<float>(c == 0 ? 0.1 * x : c == 1 ? 0.05 * y : 0.1 * x + 0.05 * y);
  };
  const auto slope = [](int x, int y, int) { return static_cast<float>(1 + 0.01 * x + 0.02 * y); };
  for (const double noise : {0.0, 0.01}) {
    PassTest pass("regress");
    pass.set("noise", noise).input("color", test_image(QUELL_TYPE_COLOR, {64, 64}, slope));
    pass.input("normal", test_image(QUELL_TYPE_NORMAL, {64, 64}, [](int, int, int c) {
                 return c == 0 ? 0.6F : c == 1 ? 0.8F : 0.0F;
               }));
    pass.input("position", test_image(QUELL_TYPE_POSITION, {64, 64}, wall)).run();
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        ASSERT_NEAR(pass.output("color").at(x, y), slope(x, y, 0), noise == 0 ? 1e-5 : 0.03) << x << "," << y;
  }
}

TEST(Regress, MovesItsBlocksFromFrameToFrameAndIsNeverNegative) {
  const auto step = [](int x, int, int) { return x == 40 ? 30.0F : 0.0F; };
  const auto run = [&](int frame) {
    PassTest pass = make({.frame = frame, .moving = true}, 0, step);
    pass.run();
    return pass.output_item("color");
  };
  const Item first = run(0), second = run(1), again = run(16);
  int differences = 0;
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 70; ++x) {
      ASSERT_EQ(first.image()->floats().at(x, y), again.image()->floats().at(x, y));
      ASSERT_GE(first.image()->floats().at(x, y), 0.0F);
      differences += first.image()->floats().at(x, y) != second.image()->floats().at(x, y) ? 1 : 0;
    }
  EXPECT_GT(differences, 1000);
}

TEST(Regress, AveragesWhereThereAreTooFewPixels) {
  PassTest pass = make({.size = {5, 7}}, 0.01);  // 35 pixels for ten features
  pass.run();
  double mean = 0;
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 5; ++x) mean += color(x, y, 2) / 35.0;
  EXPECT_NEAR(pass.output("color").at(1, 6, 2), mean, 1e-6);
}

TEST(Regress, LeavesOutWhatIsNotFinite) {
  PassTest pass = make(
      {}, 0, [](int x, int y, int c) { return x == 8 && y == 9 ? std::numeric_limits<float>::infinity() : quadratic(x, y, c); });
  pass.run();
  EXPECT_TRUE(std::isinf(pass.output("color").at(8, 9)));
  EXPECT_NEAR(pass.output("color").at(9, 9), quadratic(9, 9, 0), 1e-5);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(regress);
QUELL_CONFORMANCE_TEST(regress, .set("placement", "fixed").set("block", 8));
