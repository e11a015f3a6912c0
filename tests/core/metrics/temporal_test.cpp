// Metrics of a frame and the one before it. Their definitions in double are compared in compare_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "quell/metrics/comparison.h"
#include "tests/core/metrics/test_pairs.h"

namespace quell {
namespace {

using namespace test;

constexpr Size kSize{24, 16};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Image motion(float dx, float dy) {
  return test_image(QUELL_TYPE_MOTION, kSize, [=](int, int, int c) { return c == 0 ? dx : dy; });
}
/// A pattern that lies `shift` pixels to the right.
Image pattern(double shift) {
  return test_image(QUELL_TYPE_COLOR, kSize, [=](int x, int y, int c) {
    return static_cast<float>(0.5 + 0.4 * std::sin(0.4 * (x - shift) + 0.9 * y + c));
  });
}

TEST(TemporalMetrics, AreThoseThatCannotBeToldOfAFirstFrame) {
  const CompareInput first{make_pair(kSize), {}, motion(0, 0)};
  for (const MetricInfo& metric : metrics()) EXPECT_EQ(score(first, metric.metric) == Score{}, metric.is_temporal) << metric.name;
}

TEST(Tpsnr, SeesNoErrorThatStays) {
  const CompareInput input{{gray(kSize, 0.5F), gray(kSize, 0.75F)}, ImagePair{gray(kSize, 0.25F), gray(kSize, 0.5F)}, {}};
  EXPECT_EQ(figure(input, Metric::tpsnr), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(figure(input, Metric::psnr), -20 * std::log10(0.25), 1e-12);
}

TEST(Tpsnr, SeesAnErrorThatComesAndGoes) {
  const CompareInput input{{gray(kSize, 0.5F), gray(kSize, 0.75F)}, ImagePair{gray(kSize, 0.5F), gray(kSize, 0.25F)}, {}};
  EXPECT_NEAR(figure(input, Metric::tpsnr), -20 * std::log10(0.5), 1e-12);
}

TEST(Warped, IsWhatTheImageFlickersMoreThanItsReference) {
  const CompareInput more{{gray(kSize, 0.5F), gray(kSize, 0.75F)}, ImagePair{gray(kSize, 0.375F), gray(kSize, 0.25F)}, {}};
  EXPECT_NEAR(figure(more, Metric::warped), 0.5 - 0.125, 1e-15);
  const CompareInput less{{gray(kSize, 0.5F), gray(kSize, 0.25F)}, ImagePair{gray(kSize, 0.375F), gray(kSize, 0.25F)}, {}};
  EXPECT_NEAR(figure(less, Metric::warped), -0.125, 1e-15);
}

// What moves to the right by 3 lay 3 to the left: its motion, previous minus current, is -3.
TEST(Warped, FollowsTheMotion) {
  const Image now = pattern(3), before = pattern(0);
  const ImagePair still{gray(kSize, 0.5F), now}, still_before{gray(kSize, 0.5F), before};
  const Score got = score({still, still_before, motion(-3, 0)}, Metric::warped);
  EXPECT_NEAR(got.sum, 0, 1e-4);
  EXPECT_EQ(got.count, static_cast<std::uint64_t>((kSize.width - 3) * kSize.height));
  EXPECT_GT(figure({still, still_before, motion(3, 0)}, Metric::warped), 0.1);
  EXPECT_GT(figure({still, still_before, {}}, Metric::warped), 0.1);
}

TEST(Warped, LooksBetweenPixels) {
  const auto ramp = [](double shift) {
    return test_image(QUELL_TYPE_COLOR, kSize, [=](int x, int y, int) { return static_cast<float>((x + y + shift) / 64); });
  };
  const ImagePair now{gray(kSize, 0), ramp(0.75)}, before{gray(kSize, 0), ramp(0)};
  const Score got = score({now, before, motion(0.5F, 0.25F)}, Metric::warped);
  EXPECT_NEAR(got.sum, 0, 1e-6);
  EXPECT_EQ(got.count, static_cast<std::uint64_t>((kSize.width - 1) * (kSize.height - 1)));
}

TEST(Warped, LeavesOutWhatCameIntoThePicture) {
  const ImagePair pair = make_pair(kSize);
  for (const auto& [dx, dy] : {std::pair{24.0F, 0.0F}, {0.0F, -16.0F}, {1e30F, 0.0F}, {0.0F, kNan}, {-1e30F, 1e30F}})
    EXPECT_EQ(score({pair, pair, motion(dx, dy)}, Metric::warped), Score{}) << dx << ", " << dy;
  EXPECT_EQ(score({pair, pair, motion(23, -15)}, Metric::warped).count, 1U);  // the lower left corner
}

TEST(Warped, LeavesOutWhatIsFetchedFromAPixelThatIsNotFinite) {
  ImagePair now = make_pair(kSize), before = make_pair(kSize, 2);
  before.image.writable_floats().at(10, 8, 1) = kNan;
  constexpr std::uint64_t kAll = std::uint64_t{24} * 16;
  EXPECT_EQ(score({now, before, {}}, Metric::warped).count, kAll - 1);
  EXPECT_EQ(score({now, before, motion(0, 0)}, Metric::warped).count, kAll - 1);          // neighbors have weight 0
  EXPECT_EQ(score({now, before, motion(0.5F, 0)}, Metric::warped).count, kAll - 16 - 2);  // and the last column
  EXPECT_EQ(score({now, before, {}}, Metric::tpsnr).count, kAll - 1);
  now.reference.writable_floats().at(3, 3, 0) = kNan;
  EXPECT_EQ(score({now, before, {}}, Metric::warped).count, kAll - 2);
  EXPECT_EQ(score({now, before, {}}, Metric::tpsnr).count, kAll - 2);
}

}  // namespace
}  // namespace quell
