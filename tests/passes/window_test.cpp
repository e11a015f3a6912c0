#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"
#include "window_statistics.h"

namespace quell {
namespace {

constexpr Size kSize{37, 17};
constexpr int kFrames = 4;

// The frame in the middle is -1; the others drift away from it, each more than the one before, to the right more than to the
// left.
float color_of(int frame, int x, int y, int c) {
  return static_cast<float>(1 + scene::noise(x, y, 10 * frame + 40 + c) + 0.01 * x * (frame + 1));
}
float variance_of(int frame, int x, int y) { return static_cast<float>(0.02 + 0.2 * scene::noise(x, y, frame + 90)); }
bool valid_of(int frame, int x, int y) { return (x + 3 * y + frame) % 5 != 0; }

struct Case {
  std::set<std::string> without = {};
  int radius = 1;
  double k = 2;
  Size size = kSize;
  bool has(const std::string& input) const { return without.count(input) == 0; }
};

PassTest make(const Case& c) {
  PassTest pass("window");
  pass.set("radius", c.radius).set("k", c.k);
  const auto color = [](int i) { return [i](int x, int y, int k) { return color_of(i, x, y, k); }; };
  const auto variance = [](int i) { return [i](int x, int y, int) { return variance_of(i, x, y); }; };
  pass.input("color", test_image(QUELL_TYPE_COLOR, c.size, color(-1)));
  if (c.has("variance")) pass.input("variance", test_image(QUELL_TYPE_VARIANCE, c.size, variance(-1)));
  for (int i = 0; i < kFrames && c.has("frames"); ++i) {
    pass.input("frames", test_image(QUELL_TYPE_COLOR, c.size, color(i)));
    if (c.has("valid"))
      pass.input("valid",
                 test_image(QUELL_TYPE_MASK, c.size, [i](int x, int y, int) { return valid_of(i, x, y) ? 1.0F : 0.0F; }));
    if (c.has("variances")) pass.input("variances", test_image(QUELL_TYPE_VARIANCE, c.size, variance(i)));
  }
  return pass;
}

double luminance_of(int frame, int x, int y) {
  return scene::luminance(scene::at([frame](int px, int py, int c) { return color_of(frame, px, py, c); }, x, y));
}

double weight(const Case& c, int frame, int x, int y) {
  if (c.has("valid") && !valid_of(frame, x, y)) return 0;
  if (!c.has("variance")) return 1;
  double d = 0, v = 0;
  scene::around(c.size, x, y, c.radius, [&](int qx, int qy) {
    if (c.has("valid") && !valid_of(frame, qx, qy)) return;
    d += luminance_of(frame, qx, qy) - luminance_of(-1, qx, qy);
    v += double{variance_of(-1, qx, qy)} + variance_of(c.has("variances") ? frame : -1, qx, qy);
  });
  return std::exp(-d * d / (2 * c.k * c.k * v));
}

struct Expected {
  scene::Color color;
  double variance, length;
};

// The formula of the documentation.
Expected expected(const Case& c, int x, int y) {
  Expected e{{color_of(-1, x, y, 0), color_of(-1, x, y, 1), color_of(-1, x, y, 2)}, variance_of(-1, x, y), 0};
  double total = 1, squares = 1;
  for (int i = 0; i < kFrames && c.has("frames"); ++i) {
    const double w = weight(c, i, x, y);
    for (std::size_t k = 0; k < 3; ++k) e.color[k] += w * color_of(i, x, y, static_cast<int>(k));
    e.variance += w * w * variance_of(c.has("variances") ? i : -1, x, y);
    total += w, squares += w * w;
  }
  for (double& component : e.color) component /= total;
  return {e.color, c.has("variance") ? e.variance / total / total : 0, total * total / squares};
}

// A weight errs by 4e-6 (2^x) and by its exponent's: a difference of sums of up to 81 luminances, 2e-6 each, squared over the
// variance: 1e-4 where the exponent is not yet large.
TEST(Window, EqualsItsFormulaInDouble) {
  const std::array<Case, 10> cases{Case{},
                                   {.without = {"valid"}, .k = 1},
                                   {.without = {"variances"}, .radius = 0, .k = 0.5},
                                   {.without = {"variance"}},
                                   {.without = {"variance", "variances", "valid"}},
                                   {.without = {"frames"}},
                                   {.radius = 4, .k = 3},
                                   {.size = {1, 1}},
                                   {.radius = 3, .size = {5, 16}},
                                   {.size = {16, 3}}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    PassTest pass = make(cases[i]);
    pass.run();
    for (int y = 0; y < cases[i].size.height; ++y)
      for (int x = 0; x < cases[i].size.width; ++x) {
        const Expected want = expected(cases[i], x, y);
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(pass.output("color").at(x, y, c), want.color[static_cast<std::size_t>(c)], 1e-4)
              << "case " << i << " at " << x << "," << y;
        ASSERT_NEAR(pass.output("variance").at(x, y), want.variance, 1e-4) << "case " << i << " at " << x << "," << y;
        ASSERT_NEAR(pass.output("length").at(x, y), want.length, 5e-4) << "case " << i << " at " << x << "," << y;
      }
  }
}

// Noise around one mean, with its true variance: the weights stay near 1, and the noise of the mean is that of five frames.
TEST(Window, AveragesWhatDiffersByNoiseAlone) {
  constexpr Size kWide{160, 90};
  const auto gray = [](int frame) {
    return [frame](int x, int y, int) { return static_cast<float>(scene::noise(x, y, frame)); };
  };
  PassTest pass("window");
  const auto variance = [](int, int, int) { return 1.0F / 12; };
  pass.input("color", test_image(QUELL_TYPE_COLOR, kWide, gray(99)));
  pass.input("variance", test_image(QUELL_TYPE_VARIANCE, kWide, variance));
  for (int i = 0; i < kFrames; ++i) pass.input("frames", test_image(QUELL_TYPE_COLOR, kWide, gray(i)));
  pass.run();
  double sum = 0, squares = 0, length = 0, predicted = 0;
  constexpr double kCount = 160.0 * 90;
  for (int y = 0; y < kWide.height; ++y)
    for (int x = 0; x < kWide.width; ++x) {
      const double v = pass.output("color").at(x, y);
      sum += v, squares += v * v, length += pass.output("length").at(x, y), predicted += pass.output("variance").at(x, y);
    }
  const double observed = squares / kCount - sum * sum / kCount / kCount;
  EXPECT_NEAR(sum / kCount, 0.5, 0.005) << "no bias: four deviations of the mean";
  // Variance from 14,400 pixels is known to 2 % (two deviations); weights that go with differences widen it a little.
  EXPECT_NEAR(observed, 1.0 / 60, 0.06 / 60);
  EXPECT_NEAR(predicted / kCount, observed, 0.06 / 60);
  EXPECT_GT(length / kCount, 4.8);
}

TEST(Window, LeavesOutFramesOfAnotherLightAndWhatIsNotValid) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  PassTest pass("window");
  const auto constant = [](float value) { return [value](int, int, int) { return value; }; };
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, constant(2)));
  pass.input("variance", test_image(QUELL_TYPE_VARIANCE, kSize, constant(0.01F)));
  pass.input("frames", test_image(QUELL_TYPE_COLOR, kSize, constant(9)))
      .input("valid", test_image(QUELL_TYPE_MASK, kSize, constant(1)));
  pass.input("frames", test_image(QUELL_TYPE_COLOR, kSize, constant(kNan)));
  pass.input("valid", test_image(QUELL_TYPE_MASK, kSize, constant(0)));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      ASSERT_EQ(pass.output("color").at(x, y, 1), 2.0F) << x << "," << y;
      ASSERT_EQ(pass.output("length").at(x, y), 1.0F) << x << "," << y;
    }
}

TEST(Window, RefusesListsOfDifferentLengths) {
  PassTest pass("window");
  const auto one = [](int, int, int) { return 1.0F; };
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, one));
  pass.input("frames", test_image(QUELL_TYPE_COLOR, kSize, one)).input("frames", test_image(QUELL_TYPE_COLOR, kSize, one));
  pass.input("valid", test_image(QUELL_TYPE_MASK, kSize, one));
  EXPECT_THROW(pass.run(), Error);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(window);
QUELL_CONFORMANCE_TEST(window, .set("radius", 0).set("k", 0.5));
QUELL_CONFORMANCE_TEST(window, .set("radius", 3));
