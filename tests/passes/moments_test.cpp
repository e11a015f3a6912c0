#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

constexpr Size kSize{37, 5};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

float noise(int x, int y, int frame) { return static_cast<float>((x * 7 + y * 13 + frame * 29) % 31) / 8; }

Image gray(int frame) {
  return test_image(QUELL_TYPE_COLOR, kSize, [=](int x, int y, int) { return noise(x, y, frame); });
}

void feed_itself(PassTest& pass) { pass.feed_back("moments", "history").feed_back("length", "length"); }

TEST(Moments, OfTheFirstFrameAreItsOwn) {
  PassTest pass("moments");
  pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int c) { return c == 1 ? 2.0F : 0.0F; }));
  pass.run();
  EXPECT_FLOAT_EQ(pass.output("moments").at(5, 2, 0), 2 * 0.7152F);
  EXPECT_FLOAT_EQ(pass.output("moments").at(5, 2, 1), 4 * 0.7152F * 0.7152F);
  EXPECT_EQ(pass.output("length").at(5, 2), 1.0F);
}

// Each frame adds roundings of a few times 6e-8 of values up to 16.
TEST(Moments, FollowTheRecurrenceInDouble) {
  PassTest pass("moments");
  pass.set("alpha", 0.25).set("max_length", 6.0);
  feed_itself(pass);
  double first = 0, second = 0, length = 0;
  for (int frame = 0; frame < 12; ++frame) {
    pass.input("color", gray(frame));
    pass.run();
    const double l = noise(11, 3, frame);
    length = frame == 0 ? 1 : std::min(6.0, length + 1);
    const double a = frame == 0 ? 1 : std::max(0.25, 1 / length);
    first = a * l + (1 - a) * first;
    second = a * l * l + (1 - a) * second;
    EXPECT_NEAR(pass.output("moments").at(11, 3, 0), first, 1e-5);
    EXPECT_NEAR(pass.output("moments").at(11, 3, 1), second, 1e-5);
    EXPECT_EQ(pass.output("length").at(11, 3), length);
  }
}

TEST(Moments, AreThePlainMeanWhileTheHistoryIsYoung) {
  PassTest pass("moments");
  pass.set("alpha", 0.0).set("max_length", 64.0);
  feed_itself(pass);
  double sum = 0, squares = 0;
  for (int frame = 0; frame < 64; ++frame) {
    pass.input("color", gray(frame));
    pass.run();
    sum += noise(8, 1, frame), squares += std::pow(noise(8, 1, frame), 2);
  }
  EXPECT_NEAR(pass.output("moments").at(8, 1, 0), sum / 64, 1e-5);
  EXPECT_NEAR(pass.output("moments").at(8, 1, 1), squares / 64, 1e-5);
}

TEST(Moments, TakeAlphaAtOnceWithoutWarmUp) {
  PassTest pass("moments");
  pass.set("alpha", 0.25).set("warm_up", false);
  feed_itself(pass);
  for (const float value : {4.0F, 8.0F}) {
    pass.input("color", test_image(QUELL_TYPE_COLOR, kSize, [=](int, int, int) { return value; }));
    pass.run();
  }
  EXPECT_NEAR(pass.output("moments").at(0, 0, 0), 5, 2e-6);
  EXPECT_EQ(pass.output("length").at(0, 0), 2.0F);
}

TEST(Moments, BeginAnewWhereTheHistoryIsNotValid) {
  PassTest pass("moments");
  pass.input("color", gray(0));
  pass.input("history", test_image(QUELL_TYPE_MOMENTS, kSize, [](int x, int, int) { return x % 2 ? kNan : 3.0F; }));
  pass.input("length", test_image(QUELL_TYPE_SCALAR, kSize, [](int x, int, int) { return x % 2 ? kNan : 9.0F; }));
  pass.input("valid", test_image(QUELL_TYPE_MASK, kSize, [](int x, int, int) { return x % 2 ? 0.0F : 1.0F; }));
  pass.run();
  for (int x = 0; x < kSize.width; ++x) {
    EXPECT_EQ(pass.output("length").at(x, 2), x % 2 ? 1.0F : 10.0F);
    const double l = noise(x, 2, 0);
    EXPECT_NEAR(pass.output("moments").at(x, 2, 0), x % 2 ? l : 0.2 * l + 0.8 * 3, 2e-6);
  }
}

TEST(Moments, TakeAHistoryWithoutLengthForALongOne) {
  PassTest pass("moments");
  pass.input("color", gray(0)).input("history", test_image(QUELL_TYPE_MOMENTS, kSize, [](int, int, int) { return 3.0F; }));
  pass.run();
  EXPECT_EQ(pass.output("length").at(1, 1), 32.0F);
}

}  // namespace
}  // namespace quell

QUELL_CONFORMANCE_TEST(moments);
QUELL_CONFORMANCE_TEST(moments, .set("warm_up", false));
