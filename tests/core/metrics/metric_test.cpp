#include "quell/metrics/metric.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "quell/text/error.h"

namespace quell {
namespace {

using ::testing::StartsWith;
using ::testing::ThrowsMessage;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Metrics, AreFoundByTheirNames) {
  std::set<std::string_view> names;
  for (const MetricInfo& metric : metrics()) {
    EXPECT_EQ(parse_metric(metric.name, "--metrics"), metric.metric);
    EXPECT_EQ(&info(metric.metric), &metric);
    EXPECT_FALSE(metric.summary.empty()) << metric.name;
    names.insert(metric.name);
  }
  EXPECT_EQ(names.size(), 9U);
}

TEST(Metrics, SayWhatAMisspeltNameMayHaveMeant) {
  EXPECT_THAT(
      [] { parse_metric("sim", "--metrics"); },
      ThrowsMessage<Error>("--metrics: there is no metric 'sim'; did you mean 'ssim'?; metrics are 'psnr', 'ssim', 'mse', "
                           "'relmse', 'smape', 'flip', 'hdrflip', 'tpsnr' and 'warped'"));
  EXPECT_THAT([] { parse_metric("", "--fail-above"); },
              ThrowsMessage<Error>(StartsWith("--fail-above: there is no metric ''; ")));
  try {
    parse_metric("beauty", "--metrics");
    FAIL();
  } catch (const Error& error) { EXPECT_EQ(error.fault(), Fault::usage); }
}

TEST(Score, IsTheMeanOfItsPixels) {
  EXPECT_EQ(value(Metric::mse, {.sum = 3, .count = 12}), 0.25);
  EXPECT_EQ(value(Metric::ssim, {.sum = 3, .count = 4}), 0.75);
  EXPECT_EQ(value(Metric::warped, {.sum = -3, .count = 4}), -0.75);
}

TEST(Score, IsInDecibelsForSignalToNoise) {
  for (const MetricInfo& metric : metrics())
    EXPECT_EQ(metric.unit == "dB", metric.metric == Metric::psnr || metric.metric == Metric::tpsnr) << metric.name;
  for (const Metric metric : {Metric::psnr, Metric::tpsnr}) {
    EXPECT_DOUBLE_EQ(value(metric, {.sum = 1, .count = 1}), 0);
    EXPECT_FALSE(std::signbit(value(metric, {.sum = 1, .count = 1})));  // nobody wants to read -0 dB
    EXPECT_DOUBLE_EQ(value(metric, {.sum = 0.5, .count = 500}), 30);
    EXPECT_EQ(value(metric, {.sum = 0, .count = 5}), kInfinity);
  }
}

TEST(Score, CannotBeToldWithoutPixels) {
  for (const MetricInfo& metric : metrics()) EXPECT_TRUE(std::isnan(value(metric.metric, {}))) << metric.name;
}

// 20 dB and 40 dB are errors of 0.01 and 0.0001: together 0.00505, not 30 dB; and the larger frame weighs more.
TEST(Score, OfASequenceIsThatOfAllItsPixels) {
  Score sequence{.sum = 0.01 * 100, .count = 100};
  sequence += {.sum = 0.0001 * 100, .count = 100};
  EXPECT_NEAR(value(Metric::psnr, sequence), -10 * std::log10(0.00505), 1e-12);
  sequence += {.sum = 0, .count = 600};
  EXPECT_NEAR(value(Metric::mse, sequence), 0.00505 / 4, 1e-15);
  sequence += {};  // a frame that could not be told
  EXPECT_EQ(sequence.count, 800U);
}

TEST(Metrics, KnowWhichFigureIsBetter) {
  for (const Metric more : {Metric::psnr, Metric::ssim, Metric::tpsnr}) {
    EXPECT_TRUE(is_better(more, 0.9, 0.8));
    EXPECT_FALSE(is_better(more, 0.8, 0.9));
  }
  for (const Metric less : {Metric::mse, Metric::relmse, Metric::smape, Metric::flip, Metric::hdr_flip}) {
    EXPECT_TRUE(is_better(less, 0.1, 0.2));
    EXPECT_FALSE(is_better(less, 0.2, 0.1));
  }
  EXPECT_TRUE(is_better(Metric::psnr, kInfinity, 99));
  EXPECT_FALSE(is_better(Metric::psnr, kInfinity, kInfinity));
}

TEST(Metrics, TakeFlickerNearestToTheReferencesForTheBest) {
  EXPECT_TRUE(is_better(Metric::warped, 0.01, -0.02));
  EXPECT_TRUE(is_better(Metric::warped, -0.01, 0.02));
  EXPECT_FALSE(is_better(Metric::warped, -0.02, 0.01));
  EXPECT_FALSE(info(Metric::warped).higher_is_better);  // a limit for it is one from above
}

TEST(Metrics, NeverPreferWhatCannotBeTold) {
  for (const MetricInfo& metric : metrics()) {
    EXPECT_FALSE(is_better(metric.metric, kNan, 1)) << metric.name;
    EXPECT_FALSE(is_better(metric.metric, 1, kNan)) << metric.name;
  }
}

}  // namespace
}  // namespace quell
