#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "window_statistics.h"

namespace quell {
namespace {

constexpr Size kSize{37, 17};

float frame_color(int x, int y, int c) { return static_cast<float>(4 * scene::noise(x, y, c + 9)); }

struct Case {
  std::set<std::string> without = {};
  int radius = 2;
  double sensitivity = 0.25, k_fast = 4.5, k_color = 0.5;
  Size size = kSize;
  bool has(const std::string& input) const { return without.count(input) == 0; }
};

PassTest make(const Case& c) {
  PassTest pass("antilag");
  pass.set("radius", c.radius).set("sensitivity", c.sensitivity).set("k_fast", c.k_fast).set("k_color", c.k_color);
  pass.set("max_length", 20.0);
  pass.input("slow", test_image(QUELL_TYPE_COLOR, c.size, scene::other_color));
  pass.input("fast", test_image(QUELL_TYPE_COLOR, c.size, scene::color));
  if (c.has("color")) pass.input("color", test_image(QUELL_TYPE_COLOR, c.size, frame_color));
  if (c.has("length")) pass.input("length", test_image(QUELL_TYPE_SCALAR, c.size, scene::length));
  if (c.has("depth")) pass.input("depth", test_image(QUELL_TYPE_DEPTH, c.size, scene::depth));
  return pass;
}

scene::MeanAndDeviation of_window(const Case& c, const scene::Plane& image, int x, int y) {
  std::vector<double> window;
  scene::around(c.size, x, y, c.radius, [&](int qx, int qy) {
    if (!c.has("depth") || !scene::is_hole(qx, qy)) window.push_back(scene::luminance(scene::at(image, qx, qy)));
  });
  return scene::statistics(window);
}

// The formula of the documentation.
double confidence(const Case& c, int x, int y) {
  if (c.has("depth") && scene::is_hole(x, y)) return 1;
  const double l = scene::luminance(scene::at(scene::other_color, x, y));
  const scene::MeanAndDeviation fast = of_window(c, scene::color, x, y), frame = of_window(c, frame_color, x, y);
  const double m = c.has("color") ? frame.mean : fast.mean;
  const double t = c.k_fast * fast.deviation + (c.has("color") ? c.k_color * frame.deviation : 0);
  return 1 - std::min(1.0, c.sensitivity * std::max(0.0, std::abs(l - m) - t) / (std::max({l, m, 0.0}) + t + 1e-6));
}

// Sums of 25 luminances, in float: some 2e-6 of values up to 4, times the sensitivity; lengths of up to 20 multiply that.
TEST(Antilag, EqualsItsFormulaInDouble) {
  const std::array<Case, 9> cases{Case{.k_fast = 0.5},
                                  {.without = {"color"}, .sensitivity = 2, .k_fast = 1},
                                  {.without = {"length"}, .sensitivity = 1, .k_fast = 0.1, .k_color = 0.2},
                                  {.without = {"depth"}, .radius = 0, .sensitivity = 0.7},
                                  {.radius = 4, .sensitivity = 5, .k_fast = 0, .k_color = 0},
                                  {.sensitivity = 0},
                                  {.size = {1, 1}},
                                  {.radius = 3, .k_fast = 0.5, .size = {5, 16}},
                                  {.k_fast = 0.5, .size = {16, 3}}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    PassTest pass = make(cases[i]);
    pass.run();
    int doubted = 0;
    for (int y = 0; y < cases[i].size.height; ++y)
      for (int x = 0; x < cases[i].size.width; ++x) {
        const double want = confidence(cases[i], x, y);
        const double length = cases[i].has("length") ? scene::length(x, y, 0) : 20;
        ASSERT_NEAR(pass.output("confidence").at(x, y), want, 1e-5) << "case " << i << " at " << x << "," << y;
        ASSERT_NEAR(pass.output("length").at(x, y), 1 + want * (length - 1), 2e-4) << "case " << i << " at " << x << "," << y;
        doubted += want < 1 ? 1 : 0;
      }
    if (cases[i].size == kSize) { EXPECT_EQ(doubted > 20, cases[i].sensitivity > 0) << "case " << i; }
  }
}

TEST(Antilag, TrustsAHistoryThatIsAsThePresent) {
  const auto gray = [](int, int, int) { return 3.0F; };
  PassTest pass("antilag");
  for (const char* input : {"slow", "fast", "color"}) pass.input(input, test_image(QUELL_TYPE_COLOR, kSize, gray));
  pass.set("sensitivity", 1000.0).run();
  // Three means of one luminance differ by a rounding, 2e-7 of 3, a thousandfold.
  for (int x = 0; x < kSize.width; ++x) EXPECT_NEAR(pass.output("confidence").at(x, 3), 1, 3e-4);
}

// The light went out: |1 - 0| over 1, times the sensitivity.
TEST(Antilag, DoubtsAHistoryOfALightThatWentOut) {
  PassTest pass("antilag");
  pass.input("slow", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 1.0F; }));
  for (const char* input : {"fast", "color"})
    pass.input(input, test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 0.0F; }));
  pass.input("length", test_image(QUELL_TYPE_SCALAR, kSize, [](int, int, int) { return 21.0F; }));
  pass.run();
  EXPECT_NEAR(pass.output("confidence").at(4, 4), 0.75, 1e-6);
  EXPECT_NEAR(pass.output("length").at(4, 4), 16, 1e-5);
  pass.set("sensitivity", 1.5).run();
  EXPECT_EQ(pass.output("confidence").at(4, 4), 0.0F);
  EXPECT_EQ(pass.output("length").at(4, 4), 1.0F);
}

TEST(Antilag, TakesNoiseForNoise) {
  PassTest pass("antilag");
  const auto noisy = [](int x, int y, int c) { return static_cast<float>(scene::noise(x, y, c)); };
  pass.input("slow", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 0.5F; }));
  pass.input("fast", test_image(QUELL_TYPE_COLOR, kSize, noisy)).input("color", test_image(QUELL_TYPE_COLOR, kSize, noisy));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) ASSERT_EQ(pass.output("confidence").at(x, y), 1.0F) << x << "," << y;
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(antilag);
QUELL_CONFORMANCE_TEST(antilag, .set("k_fast", 0.0).set("k_color", 0.0).set("sensitivity", 2.0).set("radius", 1));
