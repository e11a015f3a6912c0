#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"
#include "quell/text/error.h"

namespace quell {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr Size kSize{37, 19};

using Value = std::function<float(int x, int y, int c)>;
using Rgb = std::array<double, 3>;
enum View { kNormalView, kDepthView, kMotionView, kErrorView, kLengthView, kRejectedView };

Image image(PortType type, const Value& value, Size size = kSize) { return test_image(type, size, value); }
float nothing(int, int, int) { return 0; }

PassTest with_motion(const Value& motion = nothing, Size size = kSize) {
  PassTest pass("validate");
  pass.input("motion", image(QUELL_TYPE_MOTION, motion, size));
  return pass;
}

// Code value, 0 to 255, of a pixel of a view; IEC 61966-2-1.
double code(const PassTest& pass, View view, int x, int y, int c) {
  const FloatImage out = pass.output("picture");
  const double light = out.at(view % 3 * out.width / 3 + x, view / 3 * out.height / 2 + y, c);
  return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
}

// Codes are whole numbers: half of one for rounding, and `more` for what the shade itself may err by. Floats of the table and of
// the shades err by 1e-6 of 255.
void expect_code(const PassTest& pass, View view, int x, int y, const Rgb& want, double more = 0) {
  for (int c = 0; c < 3; ++c) {
    const double got = code(pass, view, x, y, c);
    ASSERT_NEAR(got, std::round(got), 2e-3) << "not a value that a PNG has";
    ASSERT_NEAR(got, 255 * std::clamp(want[static_cast<std::size_t>(c)], 0.0, 1.0), 0.503 + 255 * more)
        << "view " << view << " at " << x << "," << y << "," << c;
  }
}
void expect_gray(const PassTest& pass, View view, int x, int y, double want, double more = 0) {
  expect_code(pass, view, x, y, {want, want, want}, more);
}
constexpr Rgb kRed{0.75, 0, 0};

TEST(Validate, IsThreeFramesWideAndTwoHigh) {
  PassTest pass = with_motion();
  pass.run();
  EXPECT_EQ(pass.output("picture").width, 3 * kSize.width);
  EXPECT_EQ(pass.output("picture").height, 2 * kSize.height);
}

TEST(Validate, ShowsNormalsFromBlackToWhite) {
  PassTest pass = with_motion();
  const auto normal = [](int x, int y, int c) { return std::sin(0.3F * static_cast<float>(x + 5 * y + 11 * c)); };
  pass.input("normal", image(QUELL_TYPE_NORMAL, normal));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      Rgb want{};
      for (int c = 0; c < 3; ++c) want[static_cast<std::size_t>(c)] = (double{normal(x, y, c)} + 1) / 2;
      expect_code(pass, kNormalView, x, y, want);
    }
}

// Depths of six octaves, with the few pixels beside the quantiles far off, and some without surface.
TEST(Validate, ShowsTheLogarithmOfDepthBetweenItsQuantiles) {
  const auto depth = [](int x, int y, int) {
    if (x == 5) return QUELL_NO_SURFACE_DEPTH;
    if (y == 7 && x < 3) return 1e-3F;
    if (y == 9 && x < 3) return 1e5F;
    return 2 * std::exp2(6 * static_cast<float>((x * 29 + y * 17) % 101) / 100);
  };
  PassTest pass = with_motion();
  pass.input("depth", image(QUELL_TYPE_DEPTH, depth));
  pass.run();
  std::vector<double> sorted;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      if (depth(x, y, 0) < 1e10F) sorted.push_back(depth(x, y, 0));
  std::ranges::sort(sorted);
  const double near = sorted[sorted.size() / 100], far = sorted[sorted.size() * 99 / 100], range = std::log2(far / near);
  // Each quantile errs by a bin of 1/128.
  const double error = 0.875 * 2 * std::log2(1 + 1 / 128.0) / range;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const double z = depth(x, y, 0);
      if (z >= 1e10)
        expect_gray(pass, kDepthView, x, y, 0);
      else
        expect_gray(pass, kDepthView, x, y, 1 - 0.875 * std::clamp(std::log2(z / near) / range, 0.0, 1.0), error);
    }
}

TEST(Validate, ShowsAWallAsWhite) {
  PassTest pass = with_motion();
  pass.input("depth", image(QUELL_TYPE_DEPTH, [](int x, int, int) { return x < 3 ? QUELL_NO_SURFACE_DEPTH : 4.0F; }));
  pass.run();
  expect_gray(pass, kDepthView, 2, 3, 0);
  expect_gray(pass, kDepthView, 20, 3, 1);
  pass.input("depth", image(QUELL_TYPE_DEPTH, [](int, int, int) { return QUELL_NO_SURFACE_DEPTH; }));
  pass.run();
  expect_gray(pass, kDepthView, 20, 3, 0);
}

TEST(Validate, ShowsTheFourDirectionsOfMotion) {
  static constexpr std::array<std::array<float, 2>, 6> kMotions{{{4, 0}, {0, 4}, {-4, 0}, {0, -4}, {0, 0}, {1, 0}}};
  PassTest pass =
      with_motion([](int x, int, int c) { return kMotions[static_cast<std::size_t>(x % 6)][static_cast<std::size_t>(c)]; });
  pass.set("max_motion", 4.0).run();
  const std::array<Rgb, 6> want{{{1, 0, 0}, {0.5, 1, 0}, {0, 1, 1}, {0.5, 0, 1}, {0, 0, 0}, {0.5, 0, 0}}};
  for (int x = 0; x < 6; ++x) expect_code(pass, kMotionView, x, 3, want[static_cast<std::size_t>(x)], 1e-5);
}

// The hue of HSV as it is defined: by sextants (Smith, "Color Gamut Transform Pairs", SIGGRAPH 1978).
Rgb hsv(double turns, double value) {
  const double sextant = std::fmod(6 * turns, 6.0), f = sextant - std::floor(sextant), up = f * value, down = (1 - f) * value;
  switch (static_cast<int>(sextant)) {
    case 0:
      return {value, up, 0};
    case 1:
      return {down, value, 0};
    case 2:
      return {0, value, up};
    case 3:
      return {0, down, value};
    case 4:
      return {up, 0, value};
    default:
      return {value, 0, down};
  }
}

TEST(Validate, ShowsMotionOfEveryDirectionAsHue) {
  const auto motion = [](int x, int y, int c) {
    const double angle = 0.17 * x, length = 0.5 * y;
    return static_cast<float>(length * (c == 0 ? std::cos(angle) : std::sin(angle)));
  };
  PassTest pass = with_motion(motion);
  pass.set("max_motion", 8.0).run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const double dx = motion(x, y, 0), dy = motion(x, y, 1);
      const double turns = std::atan2(dy, dx) / (2 * std::numbers::pi);
      expect_code(pass, kMotionView, x, y, hsv(turns < 0 ? turns + 1 : turns, std::min(std::sqrt(std::hypot(dx, dy) / 8), 1.0)),
                  1e-5);
    }
}

TEST(Validate, ShowsHowFarTheHistoryIsOffAndWhereThereIsNone) {
  const auto now = [](int x, int y, int c) { return 0.01F * static_cast<float>(x + y + 3 * c); };
  const auto before = [](int x, int y, int c) { return 0.01F * static_cast<float>((x * y + c) % 40); };
  for (const PortType type : {QUELL_TYPE_ALBEDO, QUELL_TYPE_POSITION, QUELL_TYPE_DEPTH}) {
    PassTest pass = with_motion();
    pass.set("max_error", 0.5).input("image", image(type, now)).input("history", image(type, before));
    pass.input("valid", image(QUELL_TYPE_MASK, [](int x, int y, int) { return (x + y) % 7 == 0 ? 0.0F : 1.0F; }));
    pass.run();
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        double squares = 0;
        for (int c = 0; c < (type == QUELL_TYPE_DEPTH ? 1 : 3); ++c)
          squares += std::pow(double{now(x, y, c)} - before(x, y, c), 2);
        const double shade = std::sqrt(squares) / 0.5;
        expect_code(pass, kErrorView, x, y, (x + y) % 7 == 0 ? kRed : Rgb{shade, shade, shade});
      }
  }
}

TEST(Validate, ShowsHowFarTheHistoryReachesAndWhatWasRejected) {
  const auto length = [](int x, int, int) { return static_cast<float>(x); };
  const auto rejected = [](int x, int y, int) { return static_cast<float>((x + y) % 9) / 8; };
  PassTest pass = with_motion();
  pass.set("max_length", 16).input("length", image(QUELL_TYPE_SCALAR, length));
  pass.input("rejected", image(QUELL_TYPE_SCALAR, rejected));
  for (const bool with_valid : {false, true}) {
    if (with_valid) pass.input("valid", image(QUELL_TYPE_MASK, [](int x, int, int) { return x % 3 == 0 ? 0.0F : 1.0F; }));
    pass.run();
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const double share = rejected(x, y, 0);
        expect_gray(pass, kLengthView, x, y, x / 16.0);
        expect_code(pass, kRejectedView, x, y, with_valid && x % 3 == 0 ? kRed : Rgb{share, share, share});
      }
  }
}

TEST(Validate, ShowsWhatIsAbsentAsGrayWithADiagonal) {
  PassTest pass = with_motion();
  pass.input("image", image(QUELL_TYPE_ALBEDO, nothing));  // whose history is absent, as in a first frame
  pass.run();
  for (const View view : {kNormalView, kDepthView, kErrorView, kLengthView, kRejectedView}) {
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(18, 9), std::pair(36, 18)}) expect_gray(pass, view, x, y, 0.75);
    for (const auto& [x, y] : {std::pair(36, 0), std::pair(18, 2), std::pair(0, 18)}) expect_gray(pass, view, x, y, 0.5);
  }
  expect_gray(pass, kMotionView, 0, 0, 0);
}

TEST(Validate, ShowsWhatIsNoNumberAsBlack) {
  const auto bad = [](int, int, int) { return kNan; };
  PassTest pass = with_motion(bad);
  pass.input("normal", image(QUELL_TYPE_NORMAL, bad)).input("depth", image(QUELL_TYPE_DEPTH, bad));
  pass.input("image", image(QUELL_TYPE_ALBEDO, bad)).input("history", image(QUELL_TYPE_ALBEDO, nothing));
  pass.input("length", image(QUELL_TYPE_SCALAR, bad)).input("rejected", image(QUELL_TYPE_SCALAR, bad));
  pass.run();
  for (const View view : {kNormalView, kDepthView, kMotionView, kErrorView, kLengthView, kRejectedView})
    expect_gray(pass, view, 3, 4, 0);
}

TEST(Validate, RefusesAHistoryOfAnotherTypeAndImagesOfAnotherSize) {
  PassTest pass = with_motion();
  pass.input("image", image(QUELL_TYPE_ALBEDO, nothing)).input("history", image(QUELL_TYPE_DEPTH, nothing));
  EXPECT_THROW(pass.run(), Error);
  PassTest other = with_motion();
  other.input("normal", image(QUELL_TYPE_NORMAL, nothing, {5, 5}));
  EXPECT_THROW(other.run(), Error);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(validate);
