// From operands and options to what is to be compared.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparison_run.h"
#include "metric_options.h"
#include "thresholds.h"

namespace quell::app {

struct ComparisonArguments {
  std::string reference;
  std::vector<std::string> images;
  std::optional<std::string> frames, motion;
  MetricArguments metrics;
};

/// Opens everything, chooses the frames (those that all have, but for --frames), and tells what is left out. Metrics of the bars
/// are measured, too. Throws Error(input) or Error(usage): something is missing, frames have nothing in common, sizes differ.
ComparisonJob prepare_comparison(const ComparisonArguments& arguments, const std::vector<Threshold>& thresholds);

/// What files of a display hold is compared as it stands there, unless --display says otherwise, which is told. Reads the first
/// file of the reference. Throws Error(input).
void choose_display(CompareOptions& options, const ImageSeries& reference, const std::optional<std::string>& stated);

}  // namespace quell::app
