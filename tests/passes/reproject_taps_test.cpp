// What makes a tap of the history count, and what is done where few are left.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

constexpr Size kSize{33, 17};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

float value(int x, int y, int c) { return static_cast<float>(1 + x + 100 * y + 10000 * c); }

Image image(PortType type, const std::function<float(int, int, int)>& pixel) { return test_image(type, kSize, pixel); }
Image flat(PortType type, float a, float b = 0, float c = 0) {
  return image(type, [=](int, int, int k) { return k == 0 ? a : k == 1 ? b : c; });
}

PassTest make(float dx, float dy) {
  PassTest pass("reproject");
  pass.input("history", image(QUELL_TYPE_COLOR, value)).input("motion", flat(QUELL_TYPE_MOTION, dx, dy));
  return pass;
}

TEST(ReprojectTaps, FetchSeveralImagesOfAnyTypeByTheSameTaps) {
  PassTest pass = make(0.5F, 0);
  pass.input("history", image(QUELL_TYPE_MOMENTS, [](int x, int y, int c) { return -value(x, y, c); }));
  pass.input("history", image(QUELL_TYPE_SCALAR, [](int x, int, int) { return static_cast<float>(x); }));
  pass.run();
  EXPECT_EQ(pass.output("history", 0).at(7, 3, 2), value(7, 3, 2) + 0.5F);
  EXPECT_EQ(pass.output("history", 1).at(7, 3, 1), -value(7, 3, 1) - 0.5F);
  EXPECT_EQ(pass.output("history", 2).at(7, 3), 7.5F);
}

TEST(ReprojectTaps, CountWhereTheDepthIsNearEnough) {
  PassTest pass = make(0, 0);
  pass.set("depth_slope", 2.0).set("depth_relative", 0.01).set("depth_absolute", 0.25);
  pass.input("depth", flat(QUELL_TYPE_DEPTH, 100)).input("depth_gradient", flat(QUELL_TYPE_SCALAR, 0.5F));
  // Tolerated: 2 0.5 + 0.01 100 + 0.25 = 2.25, of which each part is needed.
  pass.input("previous_depth", image(QUELL_TYPE_DEPTH, [](int x, int, int) { return 100 + 0.25F * static_cast<float>(x - 16); }));
  pass.run();
  for (int x = 0; x < kSize.width; ++x) EXPECT_EQ(pass.output("valid").at(x, 3), std::abs(x - 16) <= 9 ? 1.0F : 0.0F) << x;
  pass.disconnect("depth_gradient");
  pass.run();
  for (int x = 0; x < kSize.width; ++x) EXPECT_EQ(pass.output("valid").at(x, 3), std::abs(x - 16) <= 5 ? 1.0F : 0.0F) << x;
}

TEST(ReprojectTaps, CountWhereTheNormalIsNearEnough) {
  PassTest pass = make(0, 0);
  pass.set("normal_slope", 2.0).set("normal_absolute", 0.25);
  pass.input("normal", flat(QUELL_TYPE_NORMAL, 0, 0, 1)).input("normal_gradient", flat(QUELL_TYPE_SCALAR, 0.125F));
  // The length of the difference, not a component of it: 3/40 x and 4/40 x make x / 8.
  pass.input("previous_normal", image(QUELL_TYPE_NORMAL, [](int x, int, int c) {
               return c == 0 ? 0.075F * static_cast<float>(x) : c == 1 ? 0.1F * static_cast<float>(x) : 1.0F;
             }));
  pass.run();
  for (int x = 0; x < kSize.width; ++x)
    if (x != 4) {  // there they are equal, but for roundings
      EXPECT_EQ(pass.output("valid").at(x, 3), x < 4 ? 1.0F : 0.0F) << x;
    }
}

TEST(ReprojectTaps, CountWhereThePositionIsOnThePlane) {
  PassTest pass = make(0, 0);
  pass.set("plane_absolute", 0.25);
  pass.input("normal", flat(QUELL_TYPE_NORMAL, 0, 0, 1)).input("position", flat(QUELL_TYPE_POSITION, 0, 0, 5));
  pass.input("previous_position", image(QUELL_TYPE_POSITION, [](int x, int, int c) {
               return c == 2 ? 5 + 0.125F * static_cast<float>(x - 16) : 1000.0F;  // far, but on the plane
             }));
  pass.run();
  for (int x = 0; x < kSize.width; ++x) EXPECT_EQ(pass.output("valid").at(x, 3), std::abs(x - 16) <= 2 ? 1.0F : 0.0F) << x;
}

TEST(ReprojectTaps, DoNotCountWhereAGuideIsNoNumber) {
  PassTest pass = make(0, 0);
  pass.input("depth", flat(QUELL_TYPE_DEPTH, 1));
  pass.input("previous_depth", image(QUELL_TYPE_DEPTH, [](int x, int, int) { return x == 5 ? kNan : 1.0F; }));
  pass.run();
  EXPECT_EQ(pass.output("valid").at(5, 3), 0.0F);
  EXPECT_EQ(pass.output("valid").at(6, 3), 1.0F);
}

TEST(ReprojectTaps, AreLeftOutAndTheOthersRenormalized) {
  PassTest pass = make(0.25F, 0.25F);
  pass.input("depth", flat(QUELL_TYPE_DEPTH, 1));
  pass.input("previous_depth", image(QUELL_TYPE_DEPTH, [](int x, int y, int) { return x == 8 && y == 8 ? 2.0F : 1.0F; }));
  pass.run();
  EXPECT_EQ(pass.output("history").at(7, 7),
            static_cast<float>((9 * value(7, 7, 0) + 3 * value(8, 7, 0) + 3 * value(7, 8, 0)) / 15.0));
  EXPECT_EQ(pass.output("rejected").at(7, 7), 0.0625F);
  EXPECT_EQ(pass.output("rejected").at(3, 3), 0.0F);
}

// Of the four taps at 1/16 of a pixel only the one of weight 1/256 is left.
TEST(ReprojectTaps, MakeNoHistoryOfTooLittleWeight) {
  for (const double min_weight : {0.003, 0.005}) {
    PassTest pass = make(0.0625F, 0.0625F);
    pass.set("min_weight", min_weight);
    pass.input_ids("id", kSize, [](int, int) { return 1U; });
    pass.input_ids("previous_id", kSize, [](int x, int y) { return x == 8 && y == 8 ? 1U : 2U; });
    pass.run();
    EXPECT_EQ(pass.output("valid").at(7, 7), min_weight < 0.004 ? 1.0F : 0.0F);
    EXPECT_EQ(pass.output("history").at(7, 7), min_weight < 0.004 ? value(8, 8, 0) : 0.0F);
    EXPECT_EQ(pass.output("rejected").at(7, 7), 255.0F / 256);
  }
}

TEST(ReprojectTaps, AreLookedForInAWindowWhereAllFail) {
  PassTest pass = make(0, 0);
  pass.set("rescue", "3x3");
  pass.input_ids("id", kSize, [](int, int) { return 1U; });
  pass.input_ids("previous_id", kSize, [](int x, int y) { return (x == 8 && y == 7) || (x == 9 && y == 9) ? 1U : 2U; });
  pass.run();
  EXPECT_EQ(pass.output("history").at(8, 8), (value(8, 7, 0) + value(9, 9, 0)) / 2);  // two of nine
  EXPECT_EQ(pass.output("valid").at(8, 8), 1.0F);
  EXPECT_EQ(pass.output("rejected").at(8, 8), 1.0F);
  EXPECT_EQ(pass.output("history").at(7, 6), value(8, 7, 0));  // one of nine
  EXPECT_EQ(pass.output("valid").at(20, 8), 0.0F);             // none
}

TEST(ReprojectTaps, OfCatmullAndRomKeepALineAndASineBetterThanBilinearOnes) {
  for (const char* fetch : {"bilinear", "catmull_rom"}) {
    PassTest pass("reproject");
    pass.set("fetch", fetch).input("motion", flat(QUELL_TYPE_MOTION, 0.5F, 0));
    pass.input("history", image(QUELL_TYPE_SCALAR, [](int x, int, int) { return static_cast<float>(x); }));
    pass.input("history", image(QUELL_TYPE_SCALAR, [](int x, int, int) { return static_cast<float>(std::sin(0.8 * x)); }));
    pass.run();
    double error = 0;
    for (int x = 2; x < kSize.width - 3; ++x) {
      EXPECT_NEAR(pass.output("history", 0).at(x, 8), x + 0.5, 1e-5);
      // Only where the sine does not turn: elsewhere the spline is limited.
      if (std::abs(std::sin(0.8 * (x + 0.5))) < 0.7)
        error = std::max(error, std::abs(pass.output("history", 1).at(x, 8) - std::sin(0.8 * (x + 0.5))));
    }
    if (std::string(fetch) == "catmull_rom")
      EXPECT_LT(error, 0.02);
    else
      EXPECT_GT(error, 0.04);
  }
}

// The spline in double from its four cubics, limited to the taps in the middle.
TEST(ReprojectTaps, OfCatmullAndRomAreItsSpline) {
  const auto noise = [](int x, int y, int) { return static_cast<float>((x * x * 7 + y * 13 + x * y) % 31) / 8; };
  PassTest pass("reproject");
  pass.set("fetch", "catmull_rom").input("motion", flat(QUELL_TYPE_MOTION, 0.375F, -0.25F));
  pass.input("history", image(QUELL_TYPE_SCALAR, noise));
  pass.run();
  const auto spline = [](double p0, double p1, double p2, double p3, double f) {
    return p1 + 0.5 * f * (p2 - p0 + f * (2 * p0 - 5 * p1 + 4 * p2 - p3 + f * (3 * (p1 - p2) + p3 - p0)));
  };
  for (int y = 2; y < kSize.height - 2; ++y)
    for (int x = 1; x < kSize.width - 2; ++x) {
      std::array<double, 4> column{};
      for (int j = 0; j < 4; ++j) {
        const int row = y - 2 + j;  // the point lies between rows y - 1 and y
        column[static_cast<std::size_t>(j)] =
            spline(noise(x - 1, row, 0), noise(x, row, 0), noise(x + 1, row, 0), noise(x + 2, row, 0), 0.375);
      }
      const auto [low, high] = std::minmax({noise(x, y - 1, 0), noise(x + 1, y - 1, 0), noise(x, y, 0), noise(x + 1, y, 0)});
      const double want = std::clamp(spline(column[0], column[1], column[2], column[3], 0.75), double{low}, double{high});
      ASSERT_NEAR(pass.output("history").at(x, y), want, 1e-6) << x << "," << y;
    }
}

}  // namespace

QUELL_CONFORMANCE_TEST(reproject, .set("fetch", "catmull_rom"))
QUELL_CONFORMANCE_TEST(reproject, .set("rescue", "3x3"))

}  // namespace quell
