// The files that `quell compare` writes, and what stands in their way.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "comparison_run.h"

namespace quell::app {

struct ComparisonOutputs {
  std::optional<std::filesystem::path> maps, picture;
  std::optional<std::string> json, csv;  ///< kToOutput: the standard output
};

inline constexpr const char* kToOutput = "-";

/// Before anything is measured, which may take long. Makes the folder of the maps. Throws Error(usage) naming the option when a
/// file would replace one of an image, be its frame compared or not, one that another option writes, or what quell did not write;
/// when it cannot be made where it is to be; or when there is nothing to draw.
void prepare_outputs(const ComparisonOutputs& outputs, const ComparisonJob& job);

}  // namespace quell::app
