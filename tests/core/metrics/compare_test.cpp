// Metrics of single frames against their definitions in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "quell/metrics/comparison.h"
#include "tests/core/metrics/naive.h"
#include "tests/core/metrics/test_pairs.h"

namespace quell {
namespace {

using namespace test;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr std::array kSizes{Size{1, 1},   Size{3, 2},   Size{10, 40}, Size{40, 10}, Size{11, 11},
                            Size{12, 13}, Size{16, 16}, Size{33, 35}, Size{63, 19}, Size{65, 50}};

/// Two frames of a sequence, with motion that leaves the image here and there.
CompareInput make_input(Size size, int spare_lines = 0) {
  const auto motion = [](int x, int y, int c) { return static_cast<float>(6 * noise(x / 3, y / 3, c, 9) - 3); };
  return {make_pair(size, 1, spare_lines), make_pair(size, 2, spare_lines),
          test_image(QUELL_TYPE_MOTION, size, motion, spare_lines)};
}

/// Spoils pixels of the frame and of the one before, in either image and any channel.
void spoil(CompareInput& input) {
  const Size size = input.pair.reference.size();
  const auto put = [&](Image& image, unsigned seed, float value) {
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        if (noise(x, y, 0, seed) < 0.02)
          image.writable_floats().at(x, y, static_cast<int>(image.channels() * noise(x, y, 1, seed))) = value;
  };
  put(input.pair.reference, 11, kNan);
  put(input.pair.image, 12, kInfinity);
  put(input.previous->reference, 13, -kInfinity);
  put(input.previous->image, 14, kNan);
  put(input.motion, 15, kNan);
}

void expect_near(const Score& got, const Score& want, double tolerance, const std::string& what) {
  EXPECT_EQ(got.count, want.count) << what;
  EXPECT_NEAR(got.sum, want.sum, tolerance * std::max<double>(1, static_cast<double>(want.count))) << what;
}

class MetricsOnTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { use_vector_unit(GetParam()); }
  void TearDown() override { use_best_vector_unit(); }
};

// Of display values nothing is rounded to float, so that only double's own roundings are left; relative errors reach 1e4 here.
TEST_P(MetricsOnTarget, EqualTheirDefinitions) {
  for (const Size size : kSizes)
    for (const bool spoilt : {false, true}) {
      CompareInput input = make_input(size, spoilt ? 2 : 0);
      if (spoilt) spoil(input);
      const std::vector<Score> got = scores(input, plain_metrics());
      for (std::size_t i = 0; i < got.size(); ++i) {
        const Metric metric = plain_metrics()[i];
        expect_near(got[i], naive_score(input, metric, DisplayTransform::none), 1e-12,
                    std::string(info(metric).name) + " of " + std::to_string(size.width) + " x " + std::to_string(size.height));
      }
    }
}

// A display value errs by 5e-7 at most (see display_rows.cpp). Squares of differences: 2 x 2 x 5e-7. SSIM: where both variances
// are C2, half an error of 2 sigma 5e-7 is divided by C2: 2e-5.
TEST_P(MetricsOnTarget, EqualTheirDefinitionsForEveryDisplayTransform) {
  CompareInput input = make_input({65, 50});
  spoil(input);
  for (const DisplayInfo& display : display_transforms())
    for (const Metric metric : {Metric::mse, Metric::ssim, Metric::tpsnr, Metric::warped})
      expect_near(score(input, metric, display.transform), naive_score(input, metric, display.transform),
                  metric == Metric::ssim ? 2e-5 : 4e-6, std::string(info(metric).name) + " of " + std::string(display.name));
}

// One window each: what the last bit is off by would be lost in a sum of many.
TEST_P(MetricsOnTarget, FindTheReferenceExactlySimilarToItself) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Image image = make_pair({11, 11}, seed).image;
    EXPECT_EQ(figure({{image, image}, {}, {}}, Metric::ssim), 1) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(All, MetricsOnTarget, ::testing::ValuesIn(vector_units()),
                         [](const auto& unit) { return name_of_vector_unit(unit.param); });

void run_backward(int count, const std::function<void(int)>& body) {
  for (int i = count - 1; i >= 0; --i) body(i);
}
void run_on_threads(int count, const std::function<void(int)>& body) {
  std::atomic<int> next = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&] {
      for (int i; (i = next++) < count;) body(i);
    });
  for (std::thread& thread : threads) thread.join();
}

TEST(Compare, GivesTheSameBitsForAnyThreads) {
  CompareInput input = make_input({150, 101});
  spoil(input);
  const std::vector<Score> serial = scores(input, plain_metrics(), DisplayTransform::reinhard);
  EXPECT_EQ(scores(input, plain_metrics(), DisplayTransform::reinhard, run_backward), serial);
  EXPECT_EQ(scores(input, plain_metrics(), DisplayTransform::reinhard, run_on_threads), serial);
}

TEST(Compare, GivesAMetricTheSameFigureAloneAndAmongOthers) {
  const CompareInput input = make_input({33, 35});
  const std::vector<Score> all = scores(input, plain_metrics(), DisplayTransform::aces);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(score(input, plain_metrics()[i], DisplayTransform::aces), all[i]);
}

TEST(Compare, FindsNoErrorInTheReferenceItself) {
  const Image image = make_pair({40, 30}).image;
  const CompareInput same{{image, image}, ImagePair{image, image}, {}};
  EXPECT_EQ(figure(same, Metric::psnr), std::numeric_limits<double>::infinity());
  EXPECT_EQ(figure(same, Metric::tpsnr), std::numeric_limits<double>::infinity());
  for (const Metric metric : {Metric::mse, Metric::relmse, Metric::smape, Metric::warped}) EXPECT_EQ(figure(same, metric), 0);
}

// 8 and 0.5 to 1 are exact in float: 3/4 of one channel in three, 49/64.01 and 7/9.01.
TEST(Compare, GivesWhatCanBeReckonedByHand) {
  const CompareInput input{{flat({20, 14}, 1, 8, 1), flat({20, 14}, 0.5, 1, 1)}, {}, {}};
  EXPECT_NEAR(figure(input, Metric::mse), 0.25 / 3, 1e-15);
  EXPECT_NEAR(figure(input, Metric::psnr), -10 * std::log10(0.25 / 3), 1e-12);
  EXPECT_NEAR(figure(input, Metric::relmse), (0.25 / 1.01 + 49 / 64.01) / 3, 1e-15);
  EXPECT_NEAR(figure(input, Metric::smape), (0.5 / 1.51 + 7 / 9.01) / 3, 1e-15);
  EXPECT_NEAR(figure(input, Metric::ssim), ((2 * 0.5 + 1e-4) / (1.25 + 1e-4) + 2) / 3, 1e-12);
}

TEST(Compare, UsesReinhardWithGammaUnlessAnotherTransformIsNamed) {
  static BufferPool pool;
  const CompareInput input{{gray({4, 4}, 0), gray({4, 4}, 1)}, {}, {}};
  const FrameScores got = compare(input, {.metrics = {Metric::mse}}, false, pool);
  EXPECT_NEAR(value(Metric::mse, got.scores[0]), std::pow(0.5, 2 / 2.2), 1e-6);
}

TEST(Compare, TellsSsimOnlyWhereAWindowFits) {
  EXPECT_TRUE(std::isnan(figure({make_pair({10, 60}), {}, {}}, Metric::ssim)));
  EXPECT_TRUE(std::isnan(figure({make_pair({60, 10}), {}, {}}, Metric::ssim)));
  EXPECT_EQ(score({make_pair({13, 12}), {}, {}}, Metric::ssim).count, 6U);
}

TEST(Compare, CountsPixelsThatAreNotFinite) {
  static BufferPool pool;
  CompareInput input = make_input({20, 20});
  input.pair.reference.writable_floats().at(3, 4, 2) = kNan;
  input.pair.reference.writable_floats().at(9, 0, 0) = -kInfinity;
  input.pair.image.writable_floats().at(3, 4, 0) = kInfinity;
  input.pair.image.writable_floats().at(19, 19, 1) = kInfinity;
  input.previous->image.writable_floats().at(0, 0, 0) = kNan;  // is told when that frame is compared
  const FrameScores got = compare(input, {.metrics = {Metric::mse, Metric::tpsnr}}, false, pool);
  EXPECT_EQ(got.bad_in_reference, 2U);
  EXPECT_EQ(got.bad_in_image, 2U);
  EXPECT_EQ(got.scores[0].count, 397U);
  EXPECT_EQ(got.scores[1].count, 396U);
}

TEST(Compare, LooksAtNothingBehindTheRows) {
  static BufferPool pool;
  CompareInput input = make_input({20, 20});
  const std::vector<Score> want = scores(input, plain_metrics());
  for (Image* image :
       {&input.pair.reference, &input.pair.image, &input.previous->reference, &input.previous->image, &input.motion})
    for (int c = 0; c < image->channels(); ++c)
      for (int y = 0; y < 20; ++y) std::fill_n(image->writable_floats().row(y, c) + 20, 64 / sizeof(float), kNan);
  const FrameScores got = compare(input, {.metrics = plain_metrics(), .display = DisplayTransform::none}, false, pool);
  EXPECT_EQ(got.scores, want);
  EXPECT_EQ(got.bad_in_reference, 0U);
  EXPECT_EQ(got.bad_in_image, 0U);
}

TEST(Compare, CannotTellAnythingOfImagesWithoutAFinitePixel) {
  const ImagePair bad{make_pair({20, 20}).reference, gray({20, 20}, kNan)};
  for (const Score& got : scores({bad, bad, {}}, plain_metrics())) EXPECT_EQ(got, Score{});
}

TEST(Compare, LeavesTheImagesAsTheyWere) {
  CompareInput input = make_input({20, 20});
  input.pair.image.writable_floats().at(3, 4, 2) = kNan;
  scores(input, plain_metrics());
  EXPECT_TRUE(std::isnan(input.pair.image.floats().at(3, 4, 2)));
  EXPECT_EQ(input.pair.reference.floats().at(3, 4, 2), make_pair({20, 20}).reference.floats().at(3, 4, 2));
}

// Their squares are far beyond float.
TEST(Compare, TakesTheLargestFloats) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  const CompareInput input{{gray({16, 16}, kLargest), gray({16, 16}, -kLargest)}, {}, {}};
  EXPECT_NEAR(figure(input, Metric::relmse), 4, 1e-12);
  EXPECT_NEAR(figure(input, Metric::smape), 1, 1e-12);
  EXPECT_NEAR(figure(input, Metric::mse, DisplayTransform::reinhard), 1, 1e-6);
}

}  // namespace
}  // namespace quell
