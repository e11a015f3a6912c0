// What compare() hands to FLIP. FLIP itself is tested in flip_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "quell/metrics/comparison.h"
#include "tests/core/metrics/test_pairs.h"

namespace quell {
namespace {

using namespace test;

constexpr Size kSize{32, 24};

BufferPool& pool() {
  static BufferPool one;
  return one;
}

/// The image with a function of each value.
Image map_pixels(const Image& image, double (*function)(double)) {
  return test_image(QUELL_TYPE_COLOR, image.size(), [&](int x, int y, int c) {
    return static_cast<float>(function(static_cast<double>(image.floats().at(x, y, c))));
  });
}

TEST(CompareByFlip, LooksAtTheLightOfTheDisplay) {
  const ImagePair pair = make_pair(kSize);
  const auto light = [](double x) { return to_light(to_display(DisplayTransform::reinhard, x)); };
  const Image reference = map_pixels(pair.reference, light), image = map_pixels(pair.image, light);
  const Score want = flip({reference.floats(), image.floats(), {}}, kPixelsPerDegree, {}, pool(), run_serially);
  EXPECT_NEAR(figure({pair, {}, {}}, Metric::flip, DisplayTransform::reinhard), value(Metric::flip, want), 1e-5);
  EXPECT_GT(value(Metric::flip, want), 0.01);
}

// The srgb transform and an sRGB display undo each other.
TEST(CompareByFlip, TakesRadianceAsLightWithTheSrgbTransform) {
  const ImagePair pair = make_pair(kSize);
  const Score want = flip({pair.reference.floats(), pair.image.floats(), {}}, kPixelsPerDegree, {}, pool(), run_serially);
  EXPECT_NEAR(figure({pair, {}, {}}, Metric::flip, DisplayTransform::srgb), value(Metric::flip, want), 1e-5);
}

TEST(CompareByFlip, ChoosesExposuresForAReferenceAlone) {
  const ImagePair pair = make_pair(kSize);
  const Exposures exposures = choose_exposures(std::array{luminance_range(pair.reference.floats(), pool(), run_serially)});
  const Score want =
      hdr_flip({pair.reference.floats(), pair.image.floats(), {}}, exposures, kPixelsPerDegree, {}, pool(), run_serially);
  EXPECT_EQ(score({pair, {}, {}}, Metric::hdr_flip), want);
}

TEST(CompareByFlip, TakesTheExposuresThatItIsGiven) {
  const ImagePair pair = make_pair(kSize);
  const Exposures given{-1, 2, 3};
  const FrameScores got = compare({pair, {}, {}}, {.metrics = {Metric::hdr_flip}, .exposures = given}, false, pool());
  const Score want =
      hdr_flip({pair.reference.floats(), pair.image.floats(), {}}, given, kPixelsPerDegree, {}, pool(), run_serially);
  EXPECT_EQ(got.scores[0], want);
}

TEST(CompareByFlip, TellsTheErrorOfEachPixelWhenAskedTo) {
  const ImagePair pair = make_pair(kSize);
  const CompareOptions both{.metrics = {Metric::hdr_flip, Metric::flip}};
  const FrameScores got = compare({pair, {}, {}}, both, true, pool());
  const auto mean = [](const Image& map) {
    double sum = 0;
    for (int y = 0; y < map.height(); ++y)
      for (int x = 0; x < map.width(); ++x) sum += static_cast<double>(map.floats().at(x, y));
    return sum / (map.width() * map.height());
  };
  EXPECT_NEAR(mean(got.hdr_flip_map), value(Metric::hdr_flip, got.scores[0]), 1e-6);
  EXPECT_NEAR(mean(got.flip_map), value(Metric::flip, got.scores[1]), 1e-6);
  EXPECT_FALSE(compare({pair, {}, {}}, both, false, pool()).flip_map);
  EXPECT_FALSE(compare({pair, {}, {}}, {.metrics = {Metric::mse, Metric::flip}}, true, pool()).hdr_flip_map);
}

TEST(CompareByFlip, LeavesOutPixelsThatAreNotFinite) {
  ImagePair pair = make_pair(kSize);
  pair.image.writable_floats().at(5, 5, 0) = std::numeric_limits<float>::quiet_NaN();
  pair.reference.writable_floats().at(9, 5, 0) = std::numeric_limits<float>::infinity();
  for (const Metric metric : {Metric::flip, Metric::hdr_flip}) {
    const Score got = score({pair, {}, {}}, metric);
    EXPECT_EQ(got.count, static_cast<std::uint64_t>(kSize.width * kSize.height - 2));
    EXPECT_TRUE(std::isfinite(got.sum));
  }
}

}  // namespace
}  // namespace quell
