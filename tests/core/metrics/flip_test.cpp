#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>

#include "quell/text/error.h"
#include "tests/core/metrics/flip_images.h"
#include "tests/core/metrics/flip_reference.h"
#include "tests/core/metrics/test_pairs.h"

namespace quell::flip_test {
namespace {

constexpr Size kSize{128, 96};

class FlipOnTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { test::use_vector_unit(GetParam()); }
  void TearDown() override { test::use_best_vector_unit(); }
};
INSTANTIATE_TEST_SUITE_P(All, FlipOnTarget, ::testing::ValuesIn(test::vector_units()),
                         [](const auto& target) { return test::name_of_vector_unit(target.param); });

double flip_of(const Vec& reference, const Vec& image) {
  return mean(run_flip(flat(kSize, reference), flat(kSize, image)).score);
}

// Figures that the paper's own program prints, with the means taken in double.
TEST_P(FlipOnTarget, HasThePublishedFiguresOfFlatPictures) {
  EXPECT_NEAR(flip_of({0, 0, 0}, {1, 1, 1}), 0.967388, 1e-5);
  EXPECT_NEAR(flip_of({0.5, 0.5, 0.5}, {0.6, 0.6, 0.6}), 0.196255, 1e-5);
  EXPECT_NEAR(flip_of({0, 1, 0}, {0, 0, 1}), 1.000000, 1e-5);
  EXPECT_NEAR(flip_of({1, 0, 0}, {0, 1, 0}), 0.986665, 1e-5);
}

TEST_P(FlipOnTarget, HasThePublishedFigureOfAShiftedChecker) {
  const auto checker = [](int shift) {
    return make_picture(kSize, [=](int x, int y) {
      const double value = ((x + shift) / 8 + y / 8) % 2 == 0 ? 0.2 : 0.8;
      return Vec{value, value, value};
    });
  };
  EXPECT_NEAR(mean(run_flip(checker(0), checker(1)).score), 0.192754, 1e-5);
}

TEST_P(FlipOnTarget, HasThePublishedFiguresOfOneWhitePixel) {
  const Image gray = flat(kSize, {0.5, 0.5, 0.5});
  const Image dotted = make_picture(kSize, [](int x, int y) { return x == 64 && y == 48 ? Vec{1, 1, 1} : Vec{0.5, 0.5, 0.5}; });
  const Result result = run_flip(gray, dotted);
  EXPECT_NEAR(mean(result.score), 0.000181, 1e-6);
  EXPECT_NEAR(result.map.floats().at(64, 48), 0.210963, 1e-6);
}

// What flip.h promises. Rounded colors: 1e-3 of HyAB, mostly from the dark, where the curve of Lab is 7.8 times as steep as light
// (5e-7 of light from the blur and two matrices, times 7.8, times 116 for L). Rounded features: 4e-7, of which 1.44e-7 are
// the published program's rounding, added on purpose, and the rest roundings of sums of 19 terms. 3e-6 of the error: two powers.
void expect_within(const Image& map, const std::vector<std::array<double, 2>>& ranges, const std::string& what) {
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const auto [low, high] = ranges[static_cast<std::size_t>(y * map.width() + x)];
      const double error = map.floats().at(x, y);
      ASSERT_GE(error, low * (1 - 3e-6)) << what << " at " << x << "," << y;
      ASSERT_LE(error, high * (1 + 3e-6)) << what << " at " << x << "," << y;
    }
}
std::vector<std::array<double, 2>> ranges_of(const std::vector<Expected>& pixels) {
  std::vector<std::array<double, 2>> ranges;
  for (const Expected& pixel : pixels) ranges.push_back(pixel.error_range(1e-3, 4e-7));
  return ranges;
}
std::string name_of(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

TEST_P(FlipOnTarget, MatchesThePaperInDoublePrecision) {
  for (const Size size : {Size{1, 1}, {2, 1}, {1, 7}, {37, 1}, {5, 4}, {16, 16}, {17, 23}, {65, 40}, {530, 5}, {20, 71}}) {
    const Image reference = make_scene(size, 1), image = make_wrong_scene(size, 2);
    const Result result = run_flip(reference, image);
    const std::vector<Expected> expected = reference_flip(reference, image, kPixelsPerDegree);
    expect_within(result.map, ranges_of(expected), name_of(size));
    double sum = 0;
    for (const Expected& pixel : expected) sum += pixel.error();
    // Most in a flat picture: e^(1 - f) is e |ln e| f <= 0.37 f more than e, and f = sqrt(1.44e-7).
    EXPECT_NEAR(mean(result.score), sum / static_cast<double>(expected.size()), 1.4e-4) << name_of(size);
    EXPECT_EQ(result.score.count, expected.size());
  }
}

TEST_P(FlipOnTarget, MatchesThePaperAtOtherDistances) {
  const Size size{41, 33};
  const Image reference = make_scene(size), image = make_wrong_scene(size);
  for (const double ppd : {1.0, 10.0, 30.0, 90.0, 200.0})
    expect_within(run_flip(reference, image, ppd).map, ranges_of(reference_flip(reference, image, ppd)), std::to_string(ppd));
}

TEST_P(FlipOnTarget, MatchesThePaperOnRadiance) {
  const Exposures exposures{-2.5, 4, 4};
  for (const Size size : {Size{1, 1}, {3, 5}, {33, 18}, {520, 3}}) {
    const auto brighter = [](const Image& image) {  // 0.004 to 60, and some negative
      return make_picture(image.size(), [&](int x, int y) {
        const double gain = 0.04 * std::exp2(x % 10);
        return Vec{gain * image.floats().at(x, y, 0), gain * image.floats().at(x, y, 1), gain * image.floats().at(x, y, 2)};
      });
    };
    const Image reference = brighter(make_scene(size)), image = brighter(make_wrong_scene(size));
    std::vector<std::array<double, 2>> ranges(static_cast<std::size_t>(size.width * size.height));
    for (int i = 0; i < exposures.count; ++i) {
      const double stop = exposures.start + i * (exposures.stop - exposures.start) / (exposures.count - 1);
      const auto at_stop = ranges_of(reference_flip_at(reference, image, stop, kPixelsPerDegree));
      for (std::size_t k = 0; k < ranges.size(); ++k)
        ranges[k] = {std::max(ranges[k][0], at_stop[k][0]), std::max(ranges[k][1], at_stop[k][1])};
    }
    expect_within(run_hdr_flip(reference, image, exposures).map, ranges, name_of(size));
  }
}

TEST_P(FlipOnTarget, IsZeroWhereNothingDiffers) {
  const Image scene = make_scene({300, 70}, 3), same = make_scene({300, 70});
  EXPECT_EQ(run_flip(scene, same).score.sum, 0);
  EXPECT_EQ(run_hdr_flip(scene, same, {-3, 3, 4}).score.sum, 0);
}

TEST_P(FlipOnTarget, IsTheSameEitherWayRound) {
  const Image a = make_scene({90, 50}), b = make_wrong_scene({90, 50});
  EXPECT_TRUE(same_bits(run_flip(a, b).map, run_flip(b, a).map));
}

// The picture is larger than a tile both ways.
TEST_P(FlipOnTarget, HasNoSeams) {
  const Result result = run_flip(flat({523, 70}, {0.3, 0.7, 0.2}), flat({523, 70}, {0.3, 0.6, 0.25}));
  const FloatImage map = result.map.floats();
  ASSERT_GT(map.at(0, 0), 0.01F);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) ASSERT_EQ(map.at(x, y), map.at(0, 0)) << x << "," << y;
}

TEST_P(FlipOnTarget, SeesAPartAsItSeesTheWhole) {
  const Size size{570, 80};
  const Image reference = make_scene(size), image = make_wrong_scene(size);
  const auto part = [](const Image& whole) {
    return make_picture({100, 60}, [&](int x, int y) {
      const FloatImage view = whole.floats();
      return Vec{view.at(x + 460, y + 15, 0), view.at(x + 460, y + 15, 1), view.at(x + 460, y + 15, 2)};
    });
  };
  const Image whole_map = run_flip(reference, image).map, part_map = run_flip(part(reference), part(image)).map;
  for (int y = 10; y < 50; ++y)  // what filters reach from there lies in the part
    for (int x = 10; x < 90; ++x) ASSERT_EQ(part_map.floats().at(x, y), whole_map.floats().at(x + 460, y + 15)) << x << "," << y;
}

// In any order, on any threads.
TEST_P(FlipOnTarget, GivesTheSameBitsHoweverItIsRun) {
  const Parallel backwards = [](int count, const std::function<void(int i)>& body) {
    for (int i = count - 1; i >= 0; --i) body(i);
  };
  const Parallel shuffled = [](int count, const std::function<void(int i)>& body) {
    std::vector<int> order(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) order[static_cast<std::size_t>(i)] = i;
    std::ranges::shuffle(order, std::mt19937(1));
    for (const int i : order) body(i);
  };
  const Parallel threads = [](int count, const std::function<void(int i)>& body) {
    std::vector<std::jthread> all;
    for (int t = 0; t < 3; ++t)
      all.emplace_back([=, &body] {
        for (int i = t; i < count; i += 3) body(i);
      });
  };
  const Size size{1100, 100};
  const Image reference = make_scene(size), image = make_wrong_scene(size);
  const Result serial = run_flip(reference, image), hdr = run_hdr_flip(reference, image, {-1, 2, 3});
  BufferPool pool;
  const LuminanceRange range = luminance_range(reference.floats(), pool, run_serially);
  for (const Parallel& parallel : {backwards, shuffled, threads}) {
    const Result other = run_flip(reference, image, kPixelsPerDegree, {}, parallel);
    EXPECT_EQ(other.score, serial.score);
    EXPECT_TRUE(same_bits(other.map, serial.map));
    const Result other_hdr = run_hdr_flip(reference, image, {-1, 2, 3}, kPixelsPerDegree, parallel);
    EXPECT_EQ(other_hdr.score, hdr.score);
    EXPECT_TRUE(same_bits(other_hdr.map, hdr.map));
    const LuminanceRange other_range = luminance_range(reference.floats(), pool, parallel);
    EXPECT_EQ(other_range.median, range.median);
    EXPECT_EQ(other_range.largest, range.largest);
  }
}

TEST(Flip, CountsOnlyThePixelsThatItIsTold) {
  const Size size{300, 40};
  const Image reference = make_scene(size), image = make_wrong_scene(size);
  const auto does_count = [](int x, int y) { return (x + 3 * y) % 5 != 0; };
  const Image counts = make_plane(
      size, [&](int x, int y) { return does_count(x, y) ? 1.0F : 0.0F; }, 2);
  const Result all = run_flip(reference, image), some = run_flip(reference, image, kPixelsPerDegree, counts);
  EXPECT_TRUE(same_bits(all.map, some.map));
  double sum = 0;
  std::uint64_t pixels = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if (does_count(x, y)) {
        sum += all.map.floats().at(x, y);
        ++pixels;
      }
  EXPECT_EQ(some.score.count, pixels);
  EXPECT_NEAR(some.score.sum, sum, 1e-9);
  const Image none = make_plane(size, [](int, int) { return 0.0F; });
  EXPECT_EQ(run_flip(reference, image, kPixelsPerDegree, none).score, Score{});
}

TEST(Flip, NeedsNoMap) {
  const Image reference = make_scene(kSize), image = make_wrong_scene(kSize);
  BufferPool pool;
  const FlipImages images{reference.floats(), image.floats(), {}};
  EXPECT_EQ(flip(images, kPixelsPerDegree, {}, pool, run_serially), run_flip(reference, image).score);
  EXPECT_EQ(hdr_flip(images, {-1, 1, 2}, kPixelsPerDegree, {}, pool, run_serially),
            run_hdr_flip(reference, image, {-1, 1, 2}).score);
}

TEST(Flip, ClampsLightTo0To1) {
  const Image dark = flat(kSize, {0, 0, 0}), bright = flat(kSize, {1, 1, 1});
  EXPECT_TRUE(same_bits(run_flip(flat(kSize, {-3, -1, -1e30}), flat(kSize, {7, 1e30, 2})).map, run_flip(dark, bright).map));
}

TEST(HdrFlip, StaysWithin0To1ForAnyRadiance) {
  const auto radiance = [](int x, int y) {
    constexpr std::array<double, 6> kValues{0, 1e-38, 3e38, -3e38, 1, 1e-45};
    return kValues[static_cast<std::size_t>(x * 5 + y * 7) % 6];
  };
  const Image reference = make_picture({60, 40}, [&](int x, int y) { return Vec{radiance(x, y), radiance(y, x), 1}; });
  const Image image = make_picture({60, 40}, [&](int x, int y) { return Vec{radiance(y, x), 1, radiance(x, y)}; });
  const Result result = run_hdr_flip(reference, image, {-500, 500, 5});
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) {
      ASSERT_GE(result.map.floats().at(x, y), 0);
      ASSERT_LE(result.map.floats().at(x, y), 1);
    }
}

TEST(HdrFlip, IsTheSameForOneExposureGivenTwice) {
  const Image reference = make_scene(kSize), image = make_wrong_scene(kSize);
  EXPECT_EQ(run_hdr_flip(reference, image, {1, 1, 2}).score, run_hdr_flip(reference, image, {1, 1, 1}).score);
}

TEST(HdrFlip, RefusesExposuresThatAreNoneOrTooMany) {
  const Image image = flat({4, 4}, {1, 1, 1});
  const auto run = [&](Exposures exposures) { return [&, exposures] { run_hdr_flip(image, image, exposures); }; };
  using ::testing::HasSubstr;
  EXPECT_THAT(run({0, 1, 0}), ::testing::ThrowsMessage<Error>(HasSubstr("at least one")));
  EXPECT_THAT(run({0, 1, 2000000000}), ::testing::ThrowsMessage<Error>(HasSubstr("at most 1000")));
  EXPECT_THAT(run({0, std::numeric_limits<double>::infinity(), 2}), ::testing::ThrowsMessage<Error>(HasSubstr("stops")));
  EXPECT_THAT(run({-1e308, 1e308, 2}), ::testing::ThrowsMessage<Error>(HasSubstr("stops are not within -1000..1000")));
}

TEST(Flip, RefusesDistancesThatAreNone) {
  const Image image = flat({4, 4}, {1, 1, 1});
  for (const double ppd : {0.0, -5.0, 1e9, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THAT([&] { run_flip(image, image, ppd); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("is not within 1..1000")));
}

}  // namespace
}  // namespace quell::flip_test
