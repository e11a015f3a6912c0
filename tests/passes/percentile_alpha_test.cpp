#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "window_statistics.h"

namespace quell {
namespace {

constexpr Size kSize{37, 21};  // blocks of 8: five columns of which the last has 5 pixels, three rows of which the last has 5

bool is_valid(int x, int y) { return !(x < 8 && y < 8) && (x + 3 * y) % 5 != 0; }
// Brighter on the left, and as it was on the right.
float previous_color(int x, int y, int c) { return static_cast<float>(2 * scene::noise(x, y, c + 30) + (x < 15 ? 6 : 0)); }

struct Case {
  std::set<std::string> without = {};
  int block = 8;
  double percentile = 75, tolerance = 0.5, sensitivity = 1, bright_percentile = 90, bound = 0;
  bool has(const std::string& input) const { return without.count(input) == 0; }
};

PassTest make(const Case& c) {
  PassTest pass("percentile_alpha");
  pass.set("block", c.block).set("percentile", c.percentile).set("tolerance", c.tolerance).set("sensitivity", c.sensitivity);
  pass.set("bright_percentile", c.bright_percentile).set("bound", c.bound);
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, scene::other_color));
  if (c.has("previous")) pass.input("previous", test_image(QUELL_TYPE_COLOR, kSize, previous_color));
  if (c.has("valid"))
    pass.input("valid", test_image(QUELL_TYPE_MASK, kSize, [](int x, int y, int) { return is_valid(x, y) ? 1.0F : 0.0F; }));
  return pass;
}

double percentile(std::vector<double> values, double percent) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(std::lround(static_cast<double>(values.size() - 1) * percent / 100))];
}

std::vector<double> luminances(const Case& c, const scene::Plane& image, int column, int row, bool of_valid) {
  std::vector<double> values;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      if (x / c.block == column && y / c.block == row && (!of_valid || !c.has("valid") || is_valid(x, y)))
        values.push_back(scene::luminance(scene::at(image, x, y)));
  return values;
}

double confidence_of_block(const Case& c, int column, int row) {
  if (!c.has("previous")) return 1;
  const std::vector<double> now = luminances(c, scene::other_color, column, row, true),
                            before = luminances(c, previous_color, column, row, true);
  if (now.empty()) return 1;
  const double p = percentile(now, c.percentile), q = percentile(before, c.percentile), m = std::max({p, q, 1e-6});
  return 1 - std::min(1.0, c.sensitivity * std::max(0.0, std::abs(p - q) - c.tolerance * m) / m);
}
double bound_of_block(const Case& c, int column, int row) {
  return c.bound * percentile(luminances(c, scene::other_color, column, row, false), c.bright_percentile);
}

// By tents around the centers of the blocks, those on the border reaching on.
template <class OfBlock>
double interpolated(const Case& c, const OfBlock& of_block, int x, int y) {
  const int columns = (kSize.width + c.block - 1) / c.block, rows = (kSize.height + c.block - 1) / c.block;
  const auto weight = [&](int pixel, int block, int blocks) {
    const double at = std::clamp((pixel + 0.5) / c.block - 0.5, 0.0, blocks - 1.0);
    return std::max(0.0, 1 - std::abs(at - block));
  };
  double sum = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double w = weight(x, column, columns) * weight(y, row, rows);
      if (w > 0) sum += w * of_block(c, column, row);
    }
  return sum;
}

// A few roundings of luminances up to 8, and of their quotients.
TEST(PercentileAlpha, EqualsItsFormulaInDouble) {
  const std::array<Case, 6> cases{Case{},
                                  {.without = {"valid"}, .percentile = 50, .tolerance = 0.1, .sensitivity = 0.7, .bound = 0.8},
                                  {.without = {"previous"}, .bound = 1.5},
                                  {.block = 5, .percentile = 100, .tolerance = 0, .bright_percentile = 40, .bound = 1},
                                  {.block = 64, .percentile = 0, .tolerance = 0, .bound = 0.3},
                                  {.block = 2, .sensitivity = 3}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    PassTest pass = make(c);
    pass.run();
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        ASSERT_NEAR(pass.output("confidence").at(x, y), interpolated(c, confidence_of_block, x, y), 5e-6)
            << "case " << i << " at " << x << "," << y;
        const scene::Color color = scene::at(scene::other_color, x, y);
        const double bound = interpolated(c, bound_of_block, x, y), l = scene::luminance(color);
        const double scale = c.bound > 0 && l > bound ? bound / l : 1;
        for (int k = 0; k < 3; ++k)
          ASSERT_NEAR(pass.output("color").at(x, y, k), scale * color[static_cast<std::size_t>(k)], 1e-5)
              << "case " << i << " at " << x << "," << y;
      }
  }
}

TEST(PercentileAlpha, DoubtsTheHistoryWhereTheLightChangedAndNowhereElse) {
  PassTest pass("percentile_alpha");
  constexpr Size kWide{96, 24};
  pass.set("tolerance", 0.3).set("sensitivity", 2.0);
  pass.input("color", test_image(QUELL_TYPE_COLOR, kWide, [](int x, int, int) { return x < 48 ? 8.0F : 1.0F; }));
  pass.input("previous", test_image(QUELL_TYPE_COLOR, kWide, [](int, int, int) { return 1.0F; }));
  pass.run();
  EXPECT_EQ(pass.output("confidence").at(20, 12), 0.0F);  // 2 (7 - 0.3 8) / 8 is more than 1
  EXPECT_EQ(pass.output("confidence").at(80, 12), 1.0F);
}

// One pixel of 64 is no percentile but the last.
TEST(PercentileAlpha, IsNotMovedByAFireflyButDarkensIt) {
  const auto spike = [](int x, int y, int) { return x == 12 && y == 12 ? 1e4F : 0.5F; };
  PassTest pass("percentile_alpha");
  pass.set("bound", 2.0);
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, spike));
  pass.input("previous", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 0.5F; }));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      ASSERT_EQ(pass.output("confidence").at(x, y), 1.0F);
      ASSERT_NEAR(pass.output("color").at(x, y), x == 12 && y == 12 ? 1.0F : 0.5F, 2e-7) << x << "," << y;
    }
}

// The luminances of a block are -20, -19, ..., 43, in disorder: what overshoots below 0 is in order, too.
TEST(PercentileAlpha, OrdersWhatIsNegative) {
  const auto value = [](int x, int y, int) { return static_cast<float>((x + 8 * y) * 37 % 64 - 20); };
  for (const int index : {0, 3, 19, 20, 21, 32, 63}) {
    const auto trust = [&](int previous) {
      PassTest pass("percentile_alpha");
      pass.set("percentile", index * 100 / 63.0).set("tolerance", 0.0).set("sensitivity", 1.0);
      pass.input("color", test_image(QUELL_TYPE_COLOR, {8, 8}, value));
      pass.input("previous", test_image(QUELL_TYPE_COLOR, {8, 8}, [=](int, int, int) { return static_cast<float>(previous); }));
      pass.run();
      return pass.output("confidence").at(5, 2);
    };
    EXPECT_EQ(trust(index - 20), 1) << index;
    EXPECT_LT(trust(index - 21), 1 - 1.0 / 64) << index;
    EXPECT_LT(trust(index - 19), 1 - 1.0 / 64) << index;
  }
}

TEST(PercentileAlpha, CountsWhatIsNotFiniteAsDark) {
  PassTest pass("percentile_alpha");
  pass.set("percentile", 50.0).set("tolerance", 0.0);
  pass.input("color", test_image(QUELL_TYPE_COLOR, {16, 16}, [](int x, int y, int) {
               return (x + y) % 3 == 0 ? std::numeric_limits<float>::quiet_NaN() : 4.0F;
             }));
  pass.input("previous", test_image(QUELL_TYPE_COLOR, {16, 16}, [](int, int, int) { return 4.0F; }));
  pass.run();
  EXPECT_EQ(pass.output("confidence").at(7, 7), 1.0F);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(percentile_alpha);
QUELL_CONFORMANCE_TEST(percentile_alpha, .set("block", 3).set("tolerance", 0.0).set("bound", 1.0));
