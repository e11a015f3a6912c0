// Bars that figures must not pass, for other people's tests: --fail-above and --fail-below.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "comparison_run.h"

namespace quell::app {

struct Threshold {
  bool is_above = true;          ///< fails above the bar; else below it
  std::optional<Metric> metric;  ///< nothing: the number of pixels that are not finite
  double bar = 0;
  std::string option;  ///< as it was given: "--fail-above flip=0.1"
};

/// Of "NAME=VALUE", NAME a metric or `nonfinite`. Throws Error(usage) naming the option.
Threshold parse_threshold(const std::string& text, bool is_above);
/// A bar that more of the better passes, which is possible, but seldom meant; "" when all is well.
std::string doubt(const Threshold& threshold);

/// What fails: "out: flip is 0.1312, above 0.1 (--fail-above flip=0.1)". Figures that could not be told fail, except, with
/// `each_frame`, those of temporal metrics in frames that have no frame before. `each_frame` looks at the figures of each frame
/// as well as at those of all.
std::vector<std::string> find_failures(const std::vector<Threshold>& thresholds, const ComparisonJob& job,
                                       const std::vector<ComparedFrame>& frames, bool each_frame);

}  // namespace quell::app
