#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "noise.h"
#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

constexpr Size kSize{37, 17};

// Both with fractions of a quarter, so that sums are exact.
float quarters(int x, int y, int seed) { return static_cast<float>(std::floor(40 * scene::noise(x, y, seed)) - 20) / 4; }
float motion_at(int x, int y, int c) {
  return x == 5 && y == 5 ? std::numeric_limits<float>::quiet_NaN() : quarters(x, y, c + 3);
}
float forward_at(int x, int y, int c) { return x == 20 ? 1e6F : quarters(x, y, c + 7); }
bool valid_at(int x, int y) { return (x + 2 * y) % 3 == 0; }
std::uint32_t previous_id_at(int x, int y) { return scene::is_hole(x, y) ? QUELL_NO_ID : 4U; }

using Vector = std::array<double, 2>;

// The paper's formula: y is where x would have been, z where its occluder is now, and x' keeps x's place beside it.
bool find_dual(bool with_id, bool with_valid, int px, int py, Vector& result) {
  const Vector x{px + 0.5, py + 0.5};
  const Vector motion{motion_at(px, py, 0), motion_at(px, py, 1)};
  result = motion;
  if (std::isnan(motion[0]) || (with_valid && valid_at(px, py))) return false;
  const Vector y{x[0] + motion[0], x[1] + motion[1]};
  const int qx = static_cast<int>(std::floor(y[0])), qy = static_cast<int>(std::floor(y[1]));
  if (qx < 0 || qy < 0 || qx >= kSize.width || qy >= kSize.height || qx == 20) return false;
  if (with_id && previous_id_at(qx, qy) == QUELL_NO_ID) return false;
  for (std::size_t i = 0; i < 2; ++i) {
    const double z = y[i] + forward_at(qx, qy, static_cast<int>(i));
    const double there = y[i] + (x[i] - z);
    result[i] = there - x[i];
  }
  return true;
}

TEST(DualMotion, EqualsThePapersFormula) {
  for (const bool with_id : {true, false})
    for (const bool with_valid : {true, false}) {
      PassTest pass("dual_motion");
      pass.input("motion", test_image(QUELL_TYPE_MOTION, kSize, motion_at));
      pass.input("forward_motion", test_image(QUELL_TYPE_MOTION, kSize, forward_at));
      if (with_id) pass.input_ids("previous_id", kSize, previous_id_at);
      if (with_valid)
        pass.input("valid", test_image(QUELL_TYPE_MASK, kSize, [](int x, int y, int) { return valid_at(x, y) ? 1.0F : 0.0F; }));
      pass.run();
      int found = 0;
      for (int y = 0; y < kSize.height; ++y)
        for (int x = 0; x < kSize.width; ++x) {
          Vector want;
          const bool is_dual = find_dual(with_id, with_valid, x, y, want);
          found += is_dual ? 1 : 0;
          ASSERT_EQ(pass.output("dual").at(x, y), is_dual ? 1.0F : 0.0F) << x << "," << y;
          for (std::size_t i = 0; i < 2; ++i) {
            const float got = pass.output("motion").at(x, y, static_cast<int>(i));
            ASSERT_TRUE(got == want[i] || (std::isnan(got) && std::isnan(want[i]))) << x << "," << y;
          }
        }
      EXPECT_GT(found, 150);
    }
}

TEST(DualMotion, KeepsTheMotionWhileTheOtherIsAbsent) {
  PassTest pass("dual_motion");
  pass.input("motion", test_image(QUELL_TYPE_MOTION, kSize, quarters));
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      ASSERT_EQ(pass.output("motion").at(x, y, 1), quarters(x, y, 1));
      ASSERT_EQ(pass.output("dual").at(x, y), 0.0F);
    }
}

// A bar of five pixels runs right by three a frame before a wall at rest. The wall that it lays bare, behind its left end, finds
// the wall that was left of the bar in the frame before, at the same distance from it.
TEST(DualMotion, FindsTheWallBesideABarThatMovesOn) {
  constexpr int kBefore = 10, kNow = 13, kLong = 5;
  const auto is_bar_before = [](int x) { return x >= kBefore && x < kBefore + kLong; };
  PassTest pass("dual_motion");
  const auto bar_moves = [](bool is_bar, float by, int c) { return is_bar && c == 0 ? by : 0.0F; };
  pass.input("motion", test_image(QUELL_TYPE_MOTION, kSize,
                                  [&](int x, int, int c) { return bar_moves(x >= kNow && x < kNow + kLong, -3, c); }));
  pass.input("forward_motion",
             test_image(QUELL_TYPE_MOTION, kSize, [&](int x, int, int c) { return bar_moves(is_bar_before(x), 3, c); }));
  // The wall is not where the bar was.
  pass.input("valid",
             test_image(QUELL_TYPE_MASK, kSize, [&](int x, int, int) { return x >= kBefore && x < kNow ? 0.0F : 1.0F; }));
  pass.run();
  for (int x = kBefore; x < kNow; ++x) {
    EXPECT_EQ(pass.output("dual").at(x, 8), 1.0F);
    const float to = static_cast<float>(x) + pass.output("motion").at(x, 8);
    EXPECT_EQ(to, static_cast<float>(x - 3));
    EXPECT_FALSE(is_bar_before(static_cast<int>(to)));
    EXPECT_EQ(kNow - x, kBefore - static_cast<int>(to)) << "at the same distance from the bar";
  }
  EXPECT_EQ(pass.output("motion").at(kNow, 8), -3.0F) << "the bar itself has a history";
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(dual_motion);
