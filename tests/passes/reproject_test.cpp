#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "quell/testing/conformance.h"
#include "quell/testing/pass_test.h"

namespace quell {
namespace {

constexpr Size kSize{33, 17};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Different in every pixel and channel.
float value(int x, int y, int c) { return static_cast<float>(1 + x + 100 * y + 10000 * c); }

Image color(Size size = kSize) { return test_image(QUELL_TYPE_COLOR, size, value); }

Image motion(float dx, float dy, Size size = kSize) {
  return test_image(QUELL_TYPE_MOTION, size, [=](int, int, int c) { return c == 0 ? dx : dy; });
}

PassTest make(const char* fetch, const Image& history, const Image& vectors) {
  PassTest pass("reproject");
  pass.set("fetch", fetch);
  pass.input("history", history);
  pass.input("motion", vectors);
  return pass;
}

class EveryFetch : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Reproject, EveryFetch, testing::Values("bilinear", "nearest", "truncate", "catmull_rom"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(EveryFetch, ReturnsTheHistoryUntouchedAtRest) {
  PassTest pass = make(GetParam(), color(), motion(0, 0));
  pass.run();
  const FloatImage out = pass.output("history"), valid = pass.output("valid");
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      ASSERT_EQ(valid.at(x, y), 1.0F);
      for (int c = 0; c < 3; ++c) ASSERT_EQ(out.at(x, y, c), value(x, y, c)) << x << "," << y;
    }
}

TEST_P(EveryFetch, MovesByWholePixelsAndIsInvalidOffTheScreen) {
  PassTest pass = make(GetParam(), color(), motion(3, -2));
  pass.run();
  const FloatImage out = pass.output("history"), valid = pass.output("valid");
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      // Truncation takes points less than a pixel off the upper border as on it; here they are 0.5 off, in row 1.
      const bool kept_by_truncation = y == 1 && std::string(GetParam()) == "truncate";
      const bool on_screen = x + 3 < kSize.width && (y - 2 >= 0 || kept_by_truncation);
      ASSERT_EQ(valid.at(x, y), on_screen ? 1.0F : 0.0F) << x << "," << y;
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(out.at(x, y, c), on_screen ? value(x + 3, std::max(y - 2, 0), c) : 0.0F) << x << "," << y;
    }
}

TEST_P(EveryFetch, HasNothingWithoutAHistory) {
  PassTest pass("reproject");
  pass.set("fetch", GetParam());
  pass.input("motion", motion(0, 0));
  pass.run();
  const FloatImage valid = pass.output("valid"), rejected = pass.output("rejected");
  ASSERT_EQ(valid.width, kSize.width);
  ASSERT_EQ(valid.height, kSize.height);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      ASSERT_EQ(valid.at(x, y), 0.0F);
      ASSERT_EQ(rejected.at(x, y), 1.0F);
    }
}

TEST_P(EveryFetch, HasNothingWhereThereIsNoSurface) {
  PassTest pass = make(GetParam(), color(), motion(0, 0));
  pass.input_ids("id", kSize, [](int, int) { return QUELL_NO_ID; });
  pass.run();
  EXPECT_EQ(pass.output("valid").at(5, 5), 0.0F);
  EXPECT_EQ(pass.output("history").at(5, 5), 0.0F);
  // A background that was background before is no history either.
  pass.input_ids("previous_id", kSize, [](int, int) { return QUELL_NO_ID; });
  pass.run();
  EXPECT_EQ(pass.output("valid").at(5, 5), 0.0F);
  EXPECT_EQ(pass.output("history").at(5, 5), 0.0F);
}

TEST_P(EveryFetch, IsInvalidWhereTheMotionLeadsNowhere) {
  const float bad[] = {kNan, kInfinity, -kInfinity, 1e6F, -1e6F, 3e38F, -3e38F, 2.2e9F, -2.2e9F, 5e9F};
  const Image vectors = test_image(QUELL_TYPE_MOTION, {20, 3}, [&](int x, int y, int c) {
    return y == 1 && x % 2 == c ? bad[x / 2] : 0.0F;  // once in x, once in y
  });
  PassTest pass = make(GetParam(), color({20, 3}), vectors);
  pass.run();
  for (int x = 0; x < 20; ++x) {
    EXPECT_EQ(pass.output("valid").at(x, 1), 0.0F) << x;
    EXPECT_EQ(pass.output("history").at(x, 1), 0.0F) << x;
    EXPECT_EQ(pass.output("valid").at(x, 0), 1.0F) << x;
    EXPECT_EQ(pass.output("history").at(x, 2), value(x, 2, 0)) << x;
  }
}

TEST_P(EveryFetch, SeesTheSameObjectOnly) {
  // The left half was object 1, the right half object 2; both moved 4 pixels to the right.
  PassTest pass = make(GetParam(), color(), motion(-4, 0));
  pass.input_ids("id", kSize, [](int x, int) { return x < 20 ? 1U : 2U; });
  pass.input_ids("previous_id", kSize, [](int x, int) { return x < 12 ? 1U : 2U; });
  pass.run();
  for (int x = 0; x < kSize.width; ++x) {
    // Columns 4 to 15 fetch object 1 from columns 0 to 11; 16 to 19 would fetch object 2 instead.
    const bool on_border = x == 3 && std::string(GetParam()) == "truncate";
    const bool same = (x >= 4 && x < 16) || x >= 20 || on_border;
    EXPECT_EQ(pass.output("valid").at(x, 8), same ? 1.0F : 0.0F) << x;
    EXPECT_EQ(pass.output("history").at(x, 8), same ? value(std::max(x - 4, 0), 8, 0) : 0.0F) << x;
  }
}

TEST(Reproject, IsBilinearByDefaultAndAveragesTwoPixelsAtHalfAPixel) {
  PassTest pass("reproject");
  pass.input("history", color());
  pass.input("motion", motion(0.5F, 0));
  pass.run();
  const FloatImage out = pass.output("history");
  EXPECT_EQ(out.at(7, 3), value(7, 3, 0) + 0.5F);
  EXPECT_EQ(out.at(kSize.width - 1, 3), value(kSize.width - 1, 3, 0));  // the tap outside is left out
  EXPECT_EQ(pass.output("valid").at(kSize.width - 1, 3), 1.0F);
}

TEST(Reproject, LeavesTapsOfOtherObjectsOutAndRenormalizes) {
  PassTest pass = make("bilinear", color(), motion(0.25F, 0.25F));
  pass.input_ids("id", kSize, [](int, int) { return 1U; });
  pass.input_ids("previous_id", kSize, [](int x, int y) { return x == 8 && y == 8 ? 2U : 1U; });
  pass.run();
  // Weights 9/16, 3/16, 3/16 and, left out, 1/16 of (8, 8).
  const double want = (9 * value(7, 7, 0) + 3 * value(8, 7, 0) + 3 * value(7, 8, 0)) / 15.0;
  EXPECT_EQ(pass.output("history").at(7, 7), static_cast<float>(want));
  EXPECT_EQ(pass.output("valid").at(7, 7), 1.0F);
}

TEST(Reproject, TestsNothingWithoutPreviousIds) {
  PassTest pass = make("bilinear", color(), motion(0, 0));
  pass.input_ids("id", kSize, [](int x, int) { return x == 3 ? QUELL_NO_ID : 1U; });
  pass.run();
  EXPECT_EQ(pass.output("valid").at(2, 2), 1.0F);
  EXPECT_EQ(pass.output("valid").at(3, 2), 0.0F);
}

TEST(Reproject, DiffersBetweenNearestAndTruncationAtTheLeftAndUpperBorderAlone) {
  // Points from 2 pixels left of and above the screen to 2 pixels right of and below it.
  const Size size{9, 9};
  for (float shift = -2.75F; shift <= 2.75F; shift += 0.25F) {
    PassTest nearest = make("nearest", color(size), motion(shift, shift, size));
    PassTest truncate = make("truncate", color(size), motion(shift, shift, size));
    nearest.run();
    truncate.run();
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const float px = x + 0.5F + shift, py = y + 0.5F + shift;
        const bool off = px < 0 || py<0, taken = px> - 1 && py > -1 && px < 9 && py < 9;
        ASSERT_EQ(truncate.output("valid").at(x, y), taken ? 1.0F : 0.0F) << px << "," << py;
        ASSERT_EQ(nearest.output("valid").at(x, y), taken && !off ? 1.0F : 0.0F) << px << "," << py;
        const float fetched = taken ? value(static_cast<int>(px), static_cast<int>(py), 0) : 0.0F;
        ASSERT_EQ(truncate.output("history").at(x, y), fetched) << px << "," << py;
        ASSERT_EQ(nearest.output("history").at(x, y), off ? 0.0F : fetched) << px << "," << py;
      }
  }
}

TEST(Reproject, KeepsAConstantImageBitForBit) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> spread(-2, 2);
  const Image vectors = test_image(QUELL_TYPE_MOTION, kSize, [&](int, int, int) { return spread(random); });
  PassTest pass = make("bilinear", test_image(QUELL_TYPE_COLOR, kSize, [](int, int, int) { return 0.1F; }), vectors);
  pass.run();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      ASSERT_EQ(pass.output("history").at(x, y), pass.output("valid").at(x, y) > 0 ? 0.1F : 0.0F) << x << "," << y;
}

TEST(Reproject, DoesNotSpreadWhatIsNoNumberToPixelsThatDoNotFetchIt) {
  Image history = color();
  history.writable_floats().at(10, 8) = kNan;
  history.writable_floats().at(20, 8) = kInfinity;
  PassTest pass = make("bilinear", history, motion(1, 0));  // a weight of 0 falls on the neighbors
  pass.run();
  for (int x = 0; x < kSize.width - 1; ++x) EXPECT_EQ(std::isfinite(pass.output("history").at(x, 8)), x != 9 && x != 19) << x;
}

TEST(Reproject, FetchesImagesOfAnyFloatType) {
  for (const quell_type type : {QUELL_TYPE_SCALAR, QUELL_TYPE_MOMENTS, QUELL_TYPE_NORMAL, QUELL_TYPE_DEPTH}) {
    PassTest pass = make("bilinear", test_image(type, kSize, value), motion(-1, 0));
    pass.run();
    const FloatImage out = pass.output("history");
    ASSERT_EQ(out.channels, type == QUELL_TYPE_MOMENTS ? 2 : type == QUELL_TYPE_NORMAL ? 3 : 1);
    EXPECT_EQ(out.at(5, 5, out.channels - 1), value(4, 5, out.channels - 1));
  }
}

TEST(Reproject, AgreesWithTentWeightsOverTheWholeHistory) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> spread(-4, 4);
  std::uniform_int_distribution<std::uint32_t> object(0, 2);
  const auto draw_id = [&](int, int) { return object(random) == 0 ? QUELL_NO_ID : object(random); };
  for (const Size size : {Size{1, 1}, Size{1, 7}, Size{16, 1}, kSize}) {
    const Image vectors = test_image(QUELL_TYPE_MOTION, size, [&](int, int, int) { return spread(random); });
    const Image history = color(size);
    const Image id = test_ids(size, draw_id), previous_id = test_ids(size, draw_id);
    PassTest pass = make("bilinear", history, vectors);
    pass.set("min_weight", 0.0);
    pass.input("id", id);
    pass.input("previous_id", previous_id);
    pass.run();
    const FloatImage out = pass.output("history"), valid = pass.output("valid"), v = vectors.floats();
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        double weights = 0, sum = 0;
        for (int ty = 0; ty < size.height; ++ty)
          for (int tx = 0; tx < size.width; ++tx) {
            const double w = std::max(0.0, 1 - std::abs(x + double{v.at(x, y, 0)} - tx)) *
                             std::max(0.0, 1 - std::abs(y + double{v.at(x, y, 1)} - ty));
            const std::uint32_t wanted = id.ids().at(x, y);
            if (wanted == QUELL_NO_ID || previous_id.ids().at(tx, ty) != wanted) continue;
            weights += w;
            sum += w * value(tx, ty, 1);
          }
        ASSERT_EQ(valid.at(x, y), weights > 0 ? 1.0F : 0.0F) << x << "," << y;
        // Rounded to float once, and weights of float times what the four taps differ by.
        const double want = weights > 0 ? sum / weights : 0;
        ASSERT_NEAR(out.at(x, y, 1), want, 6e-8 * want + 3e-7 * 101) << x << "," << y;
      }
  }
}

QUELL_CONFORMANCE_TEST(reproject)

}  // namespace
}  // namespace quell
