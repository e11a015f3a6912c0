// Figures as people read them.
#include "figure_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace quell::app {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

int decimals(Metric metric, const std::vector<double>& figures) { return decimals_for(metric, figures); }

TEST(FigureText, HasDigitsWithWhichAColumnCompares) {
  EXPECT_EQ(decimals(Metric::psnr, {31.2, 0.001}), 2);
  EXPECT_EQ(decimals(Metric::flip, {0.5, 0.07}), 4);
  EXPECT_EQ(decimals(Metric::relmse, {12, 0.00123}), 5) << "three that matter of the smallest";
  EXPECT_EQ(decimals(Metric::relmse, {1e-30, 12}), 7);
  EXPECT_EQ(decimals(Metric::relmse, {0, kInfinity, kNan}), 4);
  EXPECT_EQ(decimals(Metric::relmse, {}), 4);
}

TEST(FigureText, SaysWhatNumbersCannot) {
  EXPECT_EQ(figure_text(31.239, 2), "31.24");
  EXPECT_EQ(figure_text(-0.00222, 5), "-0.00222");
  EXPECT_EQ(figure_text(0, 4), "0.0000");
  EXPECT_EQ(figure_text(kInfinity, 2), "inf");
  EXPECT_EQ(figure_text(kNan, 2), "-");
  EXPECT_EQ(figure_text(1e-9, 4), "1.0e-09") << "not 0.0000, which it is not";
  EXPECT_EQ(figure_text(1234567, 4), "1.2e+06");
  EXPECT_EQ(figure_text(65504, 2), "65504.00");
}

TEST(FigureText, NamesMetricsAndUnits) {
  EXPECT_EQ(list_figures({Metric::psnr, Metric::flip}, {{0.1, 100}, {7.1, 100}}), "psnr 30.00 dB  flip 0.0710");
  EXPECT_EQ(list_figures({Metric::psnr}, {{0, 100}}), "psnr inf");
  EXPECT_EQ(list_figures({Metric::tpsnr}, {{}}), "tpsnr -");
  EXPECT_EQ(better_text(Metric::ssim), "higher");
  EXPECT_EQ(better_text(Metric::flip), "lower");
  EXPECT_EQ(better_text(Metric::warped), "near 0");
}

}  // namespace
}  // namespace quell::app
