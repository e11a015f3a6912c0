#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/metrics/flip_images.h"
#include "tests/core/metrics/flip_reference.h"

namespace quell::flip_test {
namespace {

Image gray(Size size, const std::function<double(int x, int y)>& value) {
  return make_picture(size, [&](int x, int y) { return Vec{value(x, y), value(x, y), value(x, y)}; });
}
LuminanceRange range_of(const Image& image) {
  BufferPool pool;
  pool.fill(0xff);
  return luminance_range(image.floats(), pool, run_serially);
}

TEST(LuminanceRange, IsTheMiddleValueAndTheLargest) {
  const LuminanceRange odd = range_of(gray({5, 1}, [](int x, int) { return 5.0 - x; }));
  EXPECT_NEAR(odd.median, 3, 1e-6);
  EXPECT_NEAR(odd.largest, 5, 1e-6);
  const LuminanceRange even = range_of(gray({2, 2}, [](int x, int y) { return std::exp2(2 * x + y); }));  // 1 2 4 8
  EXPECT_NEAR(even.median, 3, 1e-6);
  EXPECT_NEAR(even.largest, 8, 1e-6);
}

TEST(LuminanceRange, IsThatOfLightAsSeen) {
  EXPECT_NEAR(range_of(flat({3, 3}, {1, 0, 0})).median, 0.2126, 1e-4);  // BT.709
  EXPECT_NEAR(range_of(flat({3, 3}, {0, 1, 0})).largest, 0.7152, 1e-4);
  EXPECT_NEAR(range_of(flat({3, 3}, {0, 0, 1})).median, 0.0722, 1e-4);
}

TEST(LuminanceRange, LeavesOutBlackSoThatAMostlyBlackPictureHasAMedian) {
  const LuminanceRange range = range_of(gray({100, 300}, [](int x, int y) {
    return x == 99 && y % 3 == 0 ? 1.0 + y : y == 7 ? -1.0 : 0.0;
  }));
  EXPECT_NEAR(range.median, 149.5, 1e-4);  // of 1, 4, ... 298
  EXPECT_NEAR(range.largest, 298, 1e-4);
}

TEST(LuminanceRange, IsZeroOfABlackPicture) {
  const LuminanceRange range = range_of(flat({7, 9}, {0, 0, 0}));
  EXPECT_EQ(range.median, 0);
  EXPECT_EQ(range.largest, 0);
}

TEST(Exposures, ReachFromTheBrightestPixelToTheMedian) {
  const LuminanceRange frame{.median = 0.02, .largest = 30};
  const Exposures exposures = choose_exposures(std::array{frame});
  EXPECT_NEAR(exposures.start, reference_stop(30), 1e-9);
  EXPECT_NEAR(exposures.stop, reference_stop(0.02), 1e-9);
  EXPECT_EQ(exposures.count, 11);  // log2(1500) = 10.55
}

TEST(Exposures, AreAtLeastTwo) {
  const Exposures exposures = choose_exposures(std::array{LuminanceRange{.median = 1, .largest = 1.5}});
  EXPECT_EQ(exposures.count, 2);
  EXPECT_NEAR(exposures.stop - exposures.start, std::log2(1.5), 1e-12);
  EXPECT_EQ(choose_exposures(std::array{LuminanceRange{.median = 2, .largest = 2}}).count, 2);
}

TEST(Exposures, ShowEveryFrameOfASequence) {
  const std::array<LuminanceRange, 4> frames{{{.median = 0.5, .largest = 4},
                                              {.median = 0.125, .largest = 1},
                                              {.median = 0, .largest = 0},
                                              {.median = 2, .largest = 16}}};
  const Exposures exposures = choose_exposures(frames);
  EXPECT_NEAR(exposures.start, reference_stop(16), 1e-9);
  EXPECT_NEAR(exposures.stop, reference_stop(0.125), 1e-9);
  EXPECT_EQ(exposures.count, 7);
}

TEST(Exposures, OfABlackSequenceAreFrom0To0) {
  const std::array<LuminanceRange, 2> black{};
  EXPECT_EQ(choose_exposures(black), (Exposures{0, 0, 2}));
  EXPECT_EQ(choose_exposures({}), (Exposures{0, 0, 2}));
  const Image nothing = flat({20, 20}, {0, 0, 0});
  EXPECT_EQ(run_hdr_flip(nothing, nothing, choose_exposures(black)).score.sum, 0);
}

}  // namespace
}  // namespace quell::flip_test
