// Figures of metrics as people read them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "quell/metrics/comparison.h"

namespace quell::app {

/// Digits after the point with which a column of a metric's figures compares well: two of dB, else four, or what the smallest
/// needs for three that matter.
int decimals_for(Metric metric, std::span<const double> figures);
/// "31.24"; "inf"; "-" for NaN, which could not be told. What this many decimals cannot show has an exponent.
std::string figure_text(double figure, int decimals);
/// "psnr 31.24 dB", alone.
std::string named_figure(Metric metric, double figure);
/// "psnr 31.24 dB  ssim 0.9120"
std::string list_figures(const std::vector<Metric>& metrics, const std::vector<Score>& scores);

/// "higher", "lower", or "near 0": which figures are better.
std::string better_text(Metric metric);
/// "12 pixels are NaN or infinite", with a thin verb for one.
std::string describe_bad_pixels(std::uint64_t count);

}  // namespace quell::app
