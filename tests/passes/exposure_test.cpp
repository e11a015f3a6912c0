#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"
#include "window_statistics.h"

namespace quell {
namespace {

constexpr Size kSize{97, 71};
constexpr double kStep = 1.0 / 64;  // stops that a luminance's step may be off

// Over twelve stops, with some black, some that is no number, and a few fireflies.
float radiance(int x, int y, int c) {
  if (x % 11 == 3) return 0;
  if (x % 13 == 5) return std::numeric_limits<float>::quiet_NaN();
  if (x % 31 == 7) return 1e20F;
  return static_cast<float>(std::exp2(12 * scene::noise(x, y, 3) - 9) * (1 + 0.2 * c));
}

double exposure_of(PassTest& pass) {
  pass.run();
  return pass.output_values("exposure")[0];
}

// The formula of the documentation, in stops, on luminances as they are.
double aim(double low, double high) {
  std::vector<double> logs;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const double l = scene::luminance(scene::at(radiance, x, y));
      if (l > 0 && std::isfinite(l)) logs.push_back(std::log2(l));
    }
  std::ranges::sort(logs);
  const auto n = static_cast<double>(logs.size());
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const auto at = static_cast<double>(i);
    const double part = std::max(0.0, std::min(at + 1, n * high / 100) - std::max(at, n * low / 100));
    sum += part * logs[i], weight += part;
  }
  return std::log2(0.18) - sum / weight;
}

TEST(Exposure, BringsTheLogAverageToTheKey) {
  for (const auto& [low, high] : {std::pair(0.0, 100.0), std::pair(5.0, 95.0), std::pair(40.0, 60.0), std::pair(0.0, 50.0)}) {
    PassTest pass("exposure");
    pass.set("low", low).set("high", high).input("color", test_image(QUELL_TYPE_COLOR, kSize, radiance));
    EXPECT_NEAR(std::log2(exposure_of(pass)), aim(low, high), kStep) << low << " to " << high;
  }
}

TEST(Exposure, OfGrayIsTheKeyOverIt) {
  for (const float gray : {0.18F, 1.0F, 1e-5F, 3000.0F}) {
    PassTest pass("exposure");
    pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [=](int, int, int) { return gray; }));
    EXPECT_NEAR(std::log2(exposure_of(pass) * gray / 0.18), 0, kStep) << gray;
  }
}

TEST(Exposure, IsNotMovedByFirefliesAndHoles) {
  const auto gray_but = [](bool spoilt) {
    return [=](int x, int y, int) {
      return spoilt && (x + 97 * y) % 40 == 0 ? 1e30F : spoilt && (x + 97 * y) % 40 == 1 ? 1e-30F : 2.0F;
    };
  };
  PassTest clean("exposure"), spoilt("exposure");
  clean.input("color", test_image(QUELL_TYPE_COLOR, kSize, gray_but(false)));
  spoilt.input("color", test_image(QUELL_TYPE_COLOR, kSize, gray_but(true)));
  EXPECT_EQ(exposure_of(clean), exposure_of(spoilt)) << "2.5 % at either end, where 5 % are left out";
}

TEST(Exposure, KeepsToItsLimits) {
  PassTest pass("exposure");
  pass.set("min_stops", -1.0).set("max_stops", 2.0);
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 1e6F; }));
  EXPECT_EQ(exposure_of(pass), 0.5);
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 1e-6F; }));
  EXPECT_EQ(exposure_of(pass), 4.0);
}

// Of a distance of 4 stops, e^(-n / 5) is left after n frames.
TEST(Exposure, FollowsByTheExponentialOfTime) {
  PassTest pass("exposure");
  pass.set("adaptation", 5.0).feed_back("exposure", "previous");
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 1.0F; }));
  const double start = std::log2(exposure_of(pass));
  EXPECT_NEAR(start, std::log2(0.18), kStep) << "the first frame has nothing to come from";
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 1.0F / 16; }));
  for (int n = 1; n <= 12; ++n) EXPECT_NEAR(std::log2(exposure_of(pass)), start + 4 * (1 - std::exp(-n / 5.0)), 1e-9) << n;
}

TEST(Exposure, KeepsThePreviousOneInTheDark) {
  PassTest pass("exposure");
  pass.set("adaptation", 5.0).feed_back("exposure", "previous");
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 0.0F; }));
  EXPECT_EQ(exposure_of(pass), 1.0);
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 3.0F; }));
  const double lit = exposure_of(pass);
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return -1.0F; }));
  EXPECT_EQ(exposure_of(pass), lit);
}

TEST(Exposure, IsTheSameForAnyThreadsAndChunks) {
  PassTest pass("exposure");
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, radiance));
  const double want = exposure_of(pass);
  for (const int threads : {1, 4})
    for (const int grain : {1, 8, 1000}) {
      pass.threads(threads).grain(grain);
      EXPECT_EQ(exposure_of(pass), want) << threads << " threads, chunks of " << grain;
    }
}

TEST(Exposure, RefusesPercentilesThatLeaveNothing) {
  PassTest pass("exposure");
  pass.set("low", 60.0).set("high", 40.0).input("color", test_image(QUELL_TYPE_COLOR, kSize, radiance));
  EXPECT_THROW(pass.run(), Error);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(exposure);
QUELL_CONFORMANCE_TEST(exposure, .set("adaptation", 3.0).set("low", 0.0));
