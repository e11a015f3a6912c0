#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <tuple>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

constexpr Size kSize{33, 17};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Image constant(float value, Size size = kSize) {
  return test_image(QUELL_TYPE_COLOR, size, [=](int, int, int) { return value; });
}

TEST(TemporalBlend, TakesTheNewFrameAloneWithoutHistory) {
  const Image color = test_image(QUELL_TYPE_COLOR, kSize, [](int x, int y, int c) { return x + 0.1F * y + 0.01F * c; });
  PassTest pass("temporal_blend");
  pass.input("color", color);
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(pass.output("color").at(x, y, c), color.floats().at(x, y, c));
}

TEST(TemporalBlend, TakesTheNewFrameAloneWhereTheHistoryIsNotValid) {
  for (const char* clamp : {"none", "neighborhood"}) {
    PassTest pass("temporal_blend");
    pass.set("clamp", clamp);
    pass.input("color", constant(0.1F));
    pass.input("history", test_image(QUELL_TYPE_COLOR, kSize, [](int x, int, int) { return x % 2 ? kNan : 0.1F; }));
    pass.input("valid", test_image(QUELL_TYPE_MASK, kSize, [](int x, int, int) { return x % 2 ? 0.0F : 1.0F; }));
    pass.run();
    for (int x = 0; x < kSize.width; ++x) EXPECT_EQ(pass.output("color").at(x, 4), 0.1F) << x;
  }
}

TEST(TemporalBlend, MixesByAlpha) {
  PassTest pass("temporal_blend");
  pass.set("clamp", "none").set("alpha", 0.25);
  pass.input("color", constant(1));
  pass.input("history", constant(5));
  pass.run();
  EXPECT_EQ(pass.output("color").at(0, 0), 4.0F);
  EXPECT_EQ(pass.output("color").at(32, 16, 2), 4.0F);
}

// 64 frames at rest, each pixel another noise: the running mean is their mean, within the roundings of 64 sums.
TEST(TemporalBlend, AveragesFramesAtRestExactlyWithARunningMean) {
  const auto noise = [](int x, int y, int c, int frame) {
    return static_cast<float>((x * 7 + y * 13 + c * 5 + frame * 29) % 37) / 9;
  };
  PassTest pass("temporal_blend");
  pass.set("alpha", 0.0).set("max_length", 64.0).set("clamp", "none");
  pass.feed_back("color", "history").feed_back("length", "length");
  for (int frame = 0; frame < 64; ++frame) {
    pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [&](int x, int y, int c) { return noise(x, y, c, frame); }));
    pass.run();
    ASSERT_EQ(pass.output("length").at(3, 3), static_cast<float>(frame + 1));
  }
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        double mean = 0;
        for (int frame = 0; frame < 64; ++frame) mean += noise(x, y, c, frame) / 64.0;
        ASSERT_NEAR(pass.output("color").at(x, y, c), mean, 1e-5) << x << "," << y;
      }
}

TEST(TemporalBlend, CountsFramesUpToTheLargestLength) {
  PassTest pass("temporal_blend");
  pass.set("alpha", 0.0).set("max_length", 4.0).set("clamp", "none");
  pass.input("color", constant(1)).input("history", constant(5));
  pass.input("length", test_image(QUELL_TYPE_SCALAR, kSize, [](int x, int, int) { return static_cast<float>(x); }));
  pass.run();
  for (int x = 0; x < kSize.width; ++x) {
    const double n = std::min(4, x + 1);
    EXPECT_EQ(pass.output("length").at(x, 2), n);
    EXPECT_NEAR(pass.output("color").at(x, 2), 1 / n + (1 - 1 / n) * 5, 1e-6) << x;
  }
}

TEST(TemporalBlend, TakesAlphaWhereAHistoryIsLongerThanItsInverse) {
  PassTest pass("temporal_blend");
  pass.set("alpha", 0.25).set("clamp", "none").input("color", constant(1)).input("history", constant(5));
  pass.input("length", test_image(QUELL_TYPE_SCALAR, kSize, [](int x, int, int) { return static_cast<float>(x); }));
  pass.run();
  EXPECT_EQ(pass.output("color").at(1, 2), 3.0F);   // 1 / 2
  EXPECT_EQ(pass.output("color").at(30, 2), 4.0F);  // 1 / 4
}

TEST(TemporalBlend, TrustsTheHistoryAsFarAsTheConfidenceSays) {
  PassTest pass("temporal_blend");
  pass.set("alpha", 0.5).set("clamp", "none").input("color", constant(1)).input("history", constant(5));
  pass.input("length", test_image(QUELL_TYPE_SCALAR, kSize, [](int, int, int) { return 8.0F; }));
  pass.input("confidence", test_image(QUELL_TYPE_SCALAR, kSize, [](int x, int, int) { return static_cast<float>(x - 1) / 4; }));
  pass.run();
  for (int x = 0; x < 8; ++x) {
    const double trust = std::clamp((x - 1) / 4.0, 0.0, 1.0);
    EXPECT_NEAR(pass.output("color").at(x, 2), 1 + trust * 0.5 * 4, 1e-6) << x;
    EXPECT_EQ(pass.output("length").at(x, 2), 1 + trust * 8) << x;
  }
}

TEST(TemporalBlend, BeginsToCountWhereTheHistoryIsNotValid) {
  PassTest pass("temporal_blend");
  pass.set("clamp", "none").input("color", constant(1)).input("history", constant(5));
  pass.input("length", test_image(QUELL_TYPE_SCALAR, kSize, [](int x, int, int) { return x % 2 ? kNan : 8.0F; }));
  pass.input("valid", test_image(QUELL_TYPE_MASK, kSize, [](int x, int, int) { return x % 2 ? 0.0F : 1.0F; }));
  pass.run();
  EXPECT_EQ(pass.output("length").at(3, 3), 1.0F);
  EXPECT_EQ(pass.output("color").at(3, 3), 1.0F);
  EXPECT_EQ(pass.output("length").at(4, 3), 9.0F);
}

TEST(TemporalBlend, KeepsAConstantImageBitForBit) {
  for (const char* spread : {"mean", "center"}) {
    PassTest pass("temporal_blend");
    pass.set("spread", spread);
    pass.input("color", constant(0.1F));
    pass.input("history", constant(0.1F));
    pass.run();
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) ASSERT_EQ(pass.output("color").at(x, y), 0.1F) << x << "," << y;
  }
}

TEST(TemporalBlend, KeepsAnEdgeThatTheHistoryHasToo) {
  // A window about a pixel beside a straight edge lies to p >= 4/7 on the pixel's own side, so that the pixel is (1 - p) of the
  // step off the mean, within sqrt(p (1 - p)) of it.
  const auto edge = [](int x, int, int) { return x < 16 ? 0.25F : 4.0F; };
  PassTest pass("temporal_blend");
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, edge));
  pass.input("history", test_image(QUELL_TYPE_COLOR, kSize, edge));
  pass.run();
  for (int x = 0; x < kSize.width; ++x) EXPECT_EQ(pass.output("color").at(x, 8), edge(x, 0, 0)) << x;
}

TEST(TemporalBlend, RemovesAGhostFromAFlatNeighborhood) {
  PassTest pass("temporal_blend");
  pass.input("color", constant(0.5F));
  pass.input("history", test_image(QUELL_TYPE_COLOR, kSize, [](int x, int, int) { return x < 16 ? 100.0F : 0.0F; }));
  pass.run();
  for (int x = 0; x < kSize.width; ++x) EXPECT_EQ(pass.output("color").at(x, 8), 0.5F) << x;
}

TEST(TemporalBlend, TakesTheDeviationAboutTheMeanOrAboutTheCenter) {
  // One 1 among 48 zeros: mean 1/49; variance (1/49)(48/49) about the mean, 48/49 about the 1. A history of 10 meets the limit.
  const Image color = test_image(QUELL_TYPE_COLOR, {15, 15}, [](int x, int y, int) { return x == 7 && y == 7 ? 1.0F : 0.0F; });
  const auto limit_at_center = [&](const char* spread) {
    PassTest pass("temporal_blend");
    pass.set("alpha", 0.0).set("spread", spread);
    pass.input("color", color);
    pass.input("history", constant(10, {15, 15}));
    pass.run();
    return pass.output("color").at(7, 7);
  };
  EXPECT_FLOAT_EQ(limit_at_center("mean"), static_cast<float>(1 / 49.0 + std::sqrt(48.0) / 49));
  EXPECT_FLOAT_EQ(limit_at_center("center"), static_cast<float>(1 / 49.0 + std::sqrt(48.0 / 49)));
}

TEST(TemporalBlend, DividesByThePixelsThatExistOrByTheFullWindow) {
  // A constant 1 about its own value has no spread; a corner's window has 16 pixels, an edge's 28, an inner one's 49.
  const auto blend = [&](const char* count, int x, int y) {
    PassTest pass("temporal_blend");
    pass.set("count", count).set("spread", "center");
    pass.input("color", constant(1));
    pass.input("history", constant(1));
    pass.run();
    return pass.output("color").at(x, y);
  };
  EXPECT_EQ(blend("existing", 0, 0), 1.0F);
  EXPECT_FLOAT_EQ(blend("full", 0, 0), 0.2F + 0.8F * 16 / 49);
  EXPECT_FLOAT_EQ(blend("full", 32, 16), 0.2F + 0.8F * 16 / 49);
  EXPECT_FLOAT_EQ(blend("full", 16, 0), 0.2F + 0.8F * 28 / 49);
  EXPECT_FLOAT_EQ(blend("full", 3, 3), 1.0F);
}

TEST(TemporalBlend, FollowsTheClosedFormOfTheExponentialAverage) {
  // Frame n of value v_n: a_n = (1 - alpha)^n v_0 + alpha sum (1 - alpha)^(n - i) v_i.
  const double alpha = 0.2;
  const auto value = [](int frame) { return static_cast<float>(1 + std::sin(frame)); };
  PassTest pass("temporal_blend");
  pass.set("clamp", "none").set("alpha", alpha);
  pass.feed_back("color", "history");
  for (int n = 0; n < 12; ++n) {
    pass.input("color", constant(value(n)));
    pass.run();
    double want = std::pow(1 - alpha, n) * value(0);
    for (int i = 1; i <= n; ++i) want += alpha * std::pow(1 - alpha, n - i) * value(i);
    // Each frame rounds to float once (6e-8 of at most 2), and forgets 1 - alpha of what came before: 1.2e-7 / alpha at most.
    EXPECT_NEAR(pass.output("color").at(11, 5), want, 6e-7) << n;
  }
}

TEST(TemporalBlend, SettlesOnTheNewValueAfterAChangeWithinTheClamp) {
  // History is clamped to the flat new frame at once: no trail at all.
  PassTest pass("temporal_blend");
  pass.feed_back("color", "history");
  for (const float value : {1.0F, 1.0F, 3.0F}) {
    pass.input("color", constant(value));
    pass.run();
    EXPECT_EQ(pass.output("color").at(3, 3), value);
  }
}

TEST(TemporalBlend, ReadsTheColorAsFarAsItClamps) {
  PassTest pass("temporal_blend");
  pass.input("color", constant(1));
  EXPECT_EQ(pass.radius("color"), 0);
  EXPECT_EQ(pass.in_place_of("color"), "color");
  pass.input("history", constant(1));
  pass.set("clamp_radius", 5);
  EXPECT_EQ(pass.radius("color"), 5);
  EXPECT_EQ(pass.in_place_of("color"), "history");
  pass.set("clamp", "none");
  EXPECT_EQ(pass.radius("color"), 0);
}

TEST(TemporalBlend, KeepsWhatIsNoNumberWithinTheWindow) {
  for (const float bad : {kNan, std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> spread(0, 1);
    const Image color = test_image(QUELL_TYPE_COLOR, kSize, [&](int, int, int) { return spread(random); });
    const auto run_on = [](const Image& image) {
      PassTest pass("temporal_blend");
      pass.input("color", image);
      pass.input("history", constant(2));
      pass.run();
      return pass.output_item("color");
    };
    const Item clean = run_on(color);
    const Image spoilt_color = test_image(
        QUELL_TYPE_COLOR, kSize, [&](int x, int y, int c) { return x == 9 && y == 8 ? bad : color.floats().at(x, y, c); });
    const Item spoilt = run_on(spoilt_color);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        if (std::abs(x - 9) <= 3 && std::abs(y - 8) <= 3) continue;
        ASSERT_EQ(spoilt.image()->floats().at(x, y), clean.image()->floats().at(x, y)) << x << "," << y;
      }
  }
}

// The formula, pixel by pixel, in double and in two passes over the window.
double reference(const FloatImage& color, double history, int x, int y, int c, int radius, double k, bool about_center, bool full,
                 double alpha) {
  double count = 0, sum = 0, squares = 0;
  const auto each = [&](const auto& body) {
    for (int ty = y - radius; ty <= y + radius; ++ty)
      for (int tx = x - radius; tx <= x + radius; ++tx)
        if (color.contains(tx, ty)) body(double{color.at(tx, ty, c)});
  };
  each([&](double v) { sum += v, count += 1; });
  if (full) count = (2 * radius + 1) * (2 * radius + 1);
  const double mean = sum / count, about = about_center ? double{color.at(x, y, c)} : mean;
  each([&](double v) { squares += (v - about) * (v - about); });
  const double reach = k * std::sqrt(squares / count);
  return alpha * color.at(x, y, c) + (1 - alpha) * std::clamp(history, mean - reach, mean + reach);
}

class EveryVariant : public testing::TestWithParam<std::tuple<bool, bool, int>> {};
INSTANTIATE_TEST_SUITE_P(TemporalBlend, EveryVariant,
                         testing::Combine(testing::Bool(), testing::Bool(), testing::Values(0, 1, 3)), [](const auto& test) {
                           return std::string(std::get<0>(test.param) ? "center" : "mean") +
                                  (std::get<1>(test.param) ? "Full" : "Existing") + std::to_string(std::get<2>(test.param));
                         });

TEST_P(EveryVariant, AgreesWithTheDoubleReference) {
  const auto [center, full, radius] = GetParam();
  std::mt19937 random(5);
  std::lognormal_distribution<float> radiance(0, 2);  // as skewed as a path tracer's
  const double k = 1.5, alpha = 0.125;
  // A raised level with little spread is where a difference of moments would cancel.
  for (const float level : {0.0F, 1000.0F})
    for (const Size size : {Size{1, 1}, Size{1, 9}, Size{15, 2}, kSize}) {
      const auto draw = [&](int, int, int) { return level + radiance(random); };
      const Image color = test_image(QUELL_TYPE_COLOR, size, draw), history = test_image(QUELL_TYPE_COLOR, size, draw);
      PassTest pass("temporal_blend");
      pass.set("alpha", alpha).set("clamp_k", k).set("clamp_radius", radius);
      pass.set("spread", center ? "center" : "mean").set("count", full ? "full" : "existing");
      pass.input("color", color);
      pass.input("history", history);
      pass.run();
      float largest = 0;
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
          for (int c = 0; c < 3; ++c) largest = std::max(largest, color.floats().at(x, y, c));
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
          for (int c = 0; c < 3; ++c) {
            const double want = reference(color.floats(), history.floats().at(x, y, c), x, y, c, radius, k, center, full, alpha);
            // Sums of at most 49 doubles, three of them of size 49 L^2 at most four times: variance within 80 * 1.1e-16 L^2, its
            // root within 1e-7 L; times k, and 6e-8 of the value for the float it ends in.
            ASSERT_NEAR(pass.output("color").at(x, y, c), want, k * 1e-7 * largest + 6e-8 * std::abs(want)) << x << "," << y;
          }
    }
}

// The same in either space, with either limit, in double: components of Karis' transform, the window's limits, and back.
using Color = std::array<double, 3>;

Color to_space(bool ycocg, const FloatImage& image, int x, int y) {
  const double r = image.at(x, y, 0), g = image.at(x, y, 1), b = image.at(x, y, 2);
  return ycocg ? Color{(r + 2 * g + b) / 4, (r - b) / 2, (2 * g - r - b) / 4} : Color{r, g, b};
}
Color from_space(bool ycocg, const Color& v) { return ycocg ? Color{v[0] + v[1] - v[2], v[0] + v[2], v[0] - v[1] - v[2]} : v; }

Color limited(const FloatImage& color, const FloatImage& history, int x, int y, int radius, bool ycocg, bool range, double k) {
  Color result{};
  const Color before = to_space(ycocg, history, x, y);
  for (std::size_t c = 0; c < 3; ++c) {
    double count = 0, sum = 0, squares = 0, low = std::numeric_limits<double>::infinity(), high = -low;
    const auto each = [&](const auto& body) {
      for (int ty = y - radius; ty <= y + radius; ++ty)
        for (int tx = x - radius; tx <= x + radius; ++tx)
          if (color.contains(tx, ty)) body(to_space(ycocg, color, tx, ty)[c]);
    };
    each([&](double v) { count += 1, sum += v, low = std::min(low, v), high = std::max(high, v); });
    const double mean = sum / count;
    each([&](double v) { squares += (v - mean) * (v - mean); });
    const double reach = k * std::sqrt(squares / count);
    result[c] = range ? std::clamp(before[c], low, high) : std::clamp(before[c], mean - reach, mean + reach);
  }
  return from_space(ycocg, result);
}

class EveryLimit : public testing::TestWithParam<std::tuple<bool, bool, int>> {};
INSTANTIATE_TEST_SUITE_P(TemporalBlend, EveryLimit, testing::Combine(testing::Bool(), testing::Bool(), testing::Values(0, 1, 3)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param) ? "Ycocg" : "Rgb") +
                                  (std::get<1>(test.param) ? "Range" : "Deviations") + std::to_string(std::get<2>(test.param));
                         });

TEST_P(EveryLimit, AgreesWithTheDoubleReference) {
  const auto [ycocg, range, radius] = GetParam();
  std::mt19937 random(7);
  std::lognormal_distribution<float> radiance(0, 2);
  const double k = 1.5, alpha = 0.125;
  for (const Size size : {Size{1, 1}, Size{1, 9}, Size{15, 2}, kSize}) {
    const auto draw = [&](int, int, int) { return radiance(random); };
    const Image color = test_image(QUELL_TYPE_COLOR, size, draw), history = test_image(QUELL_TYPE_COLOR, size, draw);
    PassTest pass("temporal_blend");
    pass.set("alpha", alpha).set("clamp_k", k).set("clamp_radius", radius);
    pass.set("clamp", range ? "range" : "neighborhood").set("space", ycocg ? "ycocg" : "rgb");
    pass.input("color", color).input("history", history);
    pass.input("valid", test_image(QUELL_TYPE_MASK, size, [](int x, int y, int) { return (x + y) % 5 == 4 ? 0.0F : 1.0F; }));
    pass.run();
    float largest = 0;
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) largest = std::max(largest, color.floats().at(x, y, c));
    // Deviations: see above. The window's components in YCoCg are floats, 6e-8 L off, as then are its limits, deviations k times
    // that; three of them come back as one channel.
    const double limit = (range ? 0 : k * 1e-7) + (ycocg ? 6e-8 * (range ? 1 : 1 + k) : 0);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const Color before = limited(color.floats(), history.floats(), x, y, radius, ycocg, range, k);
        for (int c = 0; c < 3; ++c) {
          const double now = color.floats().at(x, y, c), mixed = alpha * now + (1 - alpha) * before[static_cast<std::size_t>(c)];
          const double want = (x + y) % 5 == 4 ? now : mixed;
          ASSERT_NEAR(pass.output("color").at(x, y, c), want, (ycocg ? 3 : 1) * limit * largest + 6e-8 * std::abs(want))
              << x << "," << y << "," << c;
        }
      }
  }
}

TEST(TemporalBlend, KeepsWhatLiesInTheRangeAndNothingElse) {
  // Values of the window: 0, 1 and one 9, in every 3 x 3 pixels that hold the center.
  const Image color = test_image(QUELL_TYPE_COLOR, {9, 9},
                                 [](int x, int y, int) { return x == 4 && y == 4 ? 9.0F : static_cast<float>((x + y) % 2); });
  const auto limited_to = [&](float history, int x) {
    PassTest pass("temporal_blend");
    pass.set("alpha", 0.0).set("clamp", "range").set("clamp_radius", 1);
    pass.input("color", color).input("history", constant(history, {9, 9}));
    pass.run();
    return pass.output("color").at(x, 4);
  };
  EXPECT_EQ(limited_to(5, 5), 5.0F) << "far beyond the deviations, within the range";
  EXPECT_EQ(limited_to(5, 6), 1.0F) << "the 9 is out of reach";
  EXPECT_EQ(limited_to(100, 4), 9.0F);
  EXPECT_EQ(limited_to(-3, 4), 0.0F);
}

TEST(TemporalBlend, TellsHuesApartInYcocgThatTheirChannelsDoNot) {
  // Grays from 0 to 1 permit each channel all of it, hence red; of differences of color they have none.
  const Image grays = test_image(QUELL_TYPE_COLOR, kSize, [](int x, int, int) { return static_cast<float>(x % 2); });
  const Image red = test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int c) { return c == 0 ? 1.0F : 0.0F; });
  for (const bool ycocg : {false, true}) {
    PassTest pass("temporal_blend");
    pass.set("alpha", 0.0).set("clamp", "range").set("space", ycocg ? "ycocg" : "rgb");
    pass.input("color", grays).input("history", red);
    pass.run();
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(pass.output("color").at(9, 9, c), ycocg ? 0.25F : c == 0 ? 1.0F : 0.0F) << "the luma of red, as gray";
  }
}

TEST(TemporalBlend, DoesWithoutTheSpaceWhereNothingIsLimited) {
  for (const char* space : {"rgb", "ycocg"}) {
    PassTest pass("temporal_blend");
    pass.set("alpha", 0.25).set("clamp", "none").set("space", space).input("color", constant(1)).input("history", constant(5));
    pass.run();
    EXPECT_EQ(pass.output("color").at(7, 7), 4.0F);
    EXPECT_EQ(pass.radius("color"), 0);
  }
}

QUELL_CONFORMANCE_TEST(temporal_blend)
QUELL_CONFORMANCE_TEST(temporal_blend, .set("clamp", "range"))
QUELL_CONFORMANCE_TEST(temporal_blend, .set("space", "ycocg"))
QUELL_CONFORMANCE_TEST(temporal_blend, .set("clamp", "range").set("space", "ycocg").set("clamp_radius", 1))
QUELL_CONFORMANCE_TEST(temporal_blend, .set("clamp", "none"))
QUELL_CONFORMANCE_TEST(temporal_blend, .set("spread", "center").set("count", "full").set("clamp_radius", 1))

}  // namespace
}  // namespace quell
