// A comparison as files for other programs. The fields are described in README.md.
#pragma once

#include <string>
#include <vector>

#include "comparison_run.h"

namespace quell::app {

/// How all of them begin.
inline constexpr const char* kComparisonJson = "{\n  \"quell_compare\":";
inline constexpr const char* kComparisonCsv = "frame,image,";

/// One object with all figures, in full.
std::string comparison_json(const ComparisonJob& job, const std::vector<ComparedFrame>& frames);
/// A line for each image of each frame that was compared, and of all.
std::string comparison_csv(const ComparisonJob& job, const std::vector<ComparedFrame>& frames);

/// The frames of the job that were not reached.
std::vector<std::int64_t> frames_not_reached(const ComparisonJob& job, const std::vector<ComparedFrame>& frames);

}  // namespace quell::app
