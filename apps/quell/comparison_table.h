// What `quell compare` prints.
#pragma once

#include <string>
#include <vector>

#include "comparison_run.h"

namespace quell::app {

/// What was compared with what and how, and a line for each image of each frame, unless `summary_only`, and of all frames. The
/// best figure of each column among the images of one frame has an asterisk. At most 100 columns wide with the default metrics,
/// whatever the labels.
std::string make_table(const ComparisonJob& job, const std::vector<ComparedFrame>& frames, bool summary_only);

/// For every image that is best in a metric: nothing where all are alike, or there is no other. By image, then metric.
std::vector<std::vector<bool>> find_best(const std::vector<Metric>& metrics, const std::vector<ImageFigures>& images);

}  // namespace quell::app
