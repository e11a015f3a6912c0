#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

using testing::ElementsAre;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr Size kSize{37, 19};

using Value = std::function<float(int x, int y, int c)>;

// Whole numbers and their means are exact enough to tell one from another; every 13th pixel is bad in one plane, in clusters,
// too.
float spoilt(int x, int y, int c) {
  const int n = (x * x + 7 * y + x * y) % 13;
  if (n == 0 && c == x % 3) return std::array{kNan, kInfinity, -kInfinity, 900.0F}[static_cast<std::size_t>(y % 4)];
  if (x < 3 && y < 3) return kNan;  // the corner's window has no pixel left
  return static_cast<float>((5 * x + 11 * y + 3 * c) % 64) - 8;
}

struct Settings {
  bool neighbors = false;
  double max = 0;
  bool zero = false;
};

bool is_bad(const Value& in, const Settings& s, int x, int y) {
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(in(x, y, c)) || (s.max > 0 && in(x, y, c) > s.max)) return true;
  return false;
}
double clean(float value, const Settings& s) { return s.zero ? std::max(double{value}, 0.0) : double{value}; }

// The definition, pixel by pixel.
double reference(const Value& in, const Settings& s, Size size, int x, int y, int c) {
  if (!is_bad(in, s, x, y)) return clean(in(x, y, c), s);
  if (!s.neighbors) return 0;
  double sum = 0, count = 0;
  for (int ty = std::max(y - 1, 0); ty <= std::min(y + 1, size.height - 1); ++ty)
    for (int tx = std::max(x - 1, 0); tx <= std::min(x + 1, size.width - 1); ++tx)
      if (!is_bad(in, s, tx, ty)) sum += clean(in(tx, ty, c), s), count += 1;
  return count > 0 ? sum / count : 0;
}

PassTest pass_with(const Settings& s) {
  PassTest pass("sanitize");
  pass.set("replace", s.neighbors ? "neighbors" : "black").set("max", s.max).set("negative", s.zero ? "zero" : "keep");
  return pass;
}

class EverySetting : public testing::TestWithParam<std::tuple<bool, double, bool>> {};
INSTANTIATE_TEST_SUITE_P(Sanitize, EverySetting, testing::Combine(testing::Bool(), testing::Values(0.0, 40.0), testing::Bool()),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param) ? "Neighbors" : "Black") +
                                  (std::get<1>(test.param) > 0 ? "Bound" : "") + (std::get<2>(test.param) ? "Zero" : "");
                         });

TEST_P(EverySetting, AgreesWithTheDefinition) {
  const Settings settings{std::get<0>(GetParam()), std::get<1>(GetParam()), std::get<2>(GetParam())};
  for (const Size size : {Size{1, 1}, Size{1, 9}, Size{16, 2}, kSize}) {
    PassTest pass = pass_with(settings);
    pass.input("color", test_image(QUELL_TYPE_COLOR, size, spoilt));
    pass.run();
    double count = 0;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        count += is_bad(spoilt, settings, x, y) ? 1 : 0;
        for (int c = 0; c < 3; ++c)
          ASSERT_EQ(pass.output("color").at(x, y, c), static_cast<float>(reference(spoilt, settings, size, x, y, c)))
              << x << "," << y << "," << c;
      }
    EXPECT_THAT(pass.output_values("count"), ElementsAre(count));
  }
}

TEST(Sanitize, LeavesWhatIsFiniteBitForBitAndCountsNothing) {
  const Value all = [](int x, int y, int c) { return x == 3 ? kLargest : x == 4 ? -kLargest : spoilt(x + 3, 1, c + y) * 0.1F; };
  const Value finite = [&](int x, int y, int c) { return std::isfinite(all(x, y, c)) ? all(x, y, c) : -0.0F; };
  for (const bool neighbors : {false, true}) {
    PassTest pass = pass_with({neighbors});
    pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, finite));
    pass.run();
    EXPECT_THAT(pass.output_values("count"), ElementsAre(0.0));
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        ASSERT_EQ(pass.output("color").at(x, y, 1), finite(x, y, 1));
        ASSERT_EQ(std::signbit(pass.output("color").at(x, y, 1)), std::signbit(finite(x, y, 1)));
      }
  }
}

TEST(Sanitize, FillsASpikeInASlopeWithTheSlope) {
  const auto slope = [](int x, int y) { return 100 + 2 * static_cast<float>(x) + static_cast<float>(y); };
  PassTest pass = pass_with({.neighbors = true, .max = 1000});
  pass.input("color",
             test_image(QUELL_TYPE_COLOR, kSize, [&](int x, int y, int) { return x == 9 && y == 8 ? 1e6F : slope(x, y); }));
  pass.run();
  EXPECT_EQ(pass.output("color").at(9, 8), slope(9, 8)) << "the mean of eight neighbors on a plane is its middle";
  EXPECT_THAT(pass.output_values("count"), ElementsAre(1.0));
}

TEST(Sanitize, KeepsTheBoundItself) {
  PassTest pass = pass_with({.max = 1000});
  pass.input("color", test_image(QUELL_TYPE_COLOR, {2, 1}, [](int x, int, int) { return x == 0 ? 1000.0F : 1000.1F; }));
  pass.run();
  EXPECT_EQ(pass.output("color").at(0, 0), 1000.0F);
  EXPECT_EQ(pass.output("color").at(1, 0), 0.0F);
}

TEST(Sanitize, LooksThroughImagesOfAnyNumberOfPlanes) {
  for (const PortType type : {QUELL_TYPE_DEPTH, QUELL_TYPE_MOTION, QUELL_TYPE_NORMAL}) {
    PassTest pass("sanitize");
    pass.input("color", test_image(type, {5, 3}, [](int x, int y, int) { return x == 2 && y == 1 ? kNan : 7.0F; }));
    pass.run();
    EXPECT_EQ(pass.output_item("color").image()->type(), type);
    EXPECT_EQ(pass.output("color").at(2, 1), 0.0F);
    EXPECT_THAT(pass.output_values("count"), ElementsAre(1.0));
  }
}

TEST(Sanitize, CountsTheSameForAnyThreadsAndChunks) {
  const Size size{150, 143};
  double want = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) want += is_bad(spoilt, {.max = 40}, x, y) ? 1 : 0;
  ASSERT_GT(want, 1000);
  for (const int threads : {1, 4})
    for (const int grain : {1, 8, 1000}) {
      PassTest pass = pass_with({.max = 40});
      pass.threads(threads).grain(grain).input("color", test_image(QUELL_TYPE_COLOR, size, spoilt));
      pass.run();
      EXPECT_THAT(pass.output_values("count"), ElementsAre(want)) << threads << " threads, chunks of " << grain;
    }
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(sanitize);
QUELL_CONFORMANCE_TEST(sanitize, .set("max", 0.8).set("negative", "zero"));
QUELL_CONFORMANCE_TEST(sanitize, .set("max", 0.8).set("replace", "neighbors"));
