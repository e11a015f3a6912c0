// What `quell inspect` prints.
#pragma once

#include <functional>
#include <string>

#include "inspection.h"
#include "quell/sequence/image_file.h"

namespace quell::app {

/// The verdicts, a paragraph each, and a last line that sums them up.
std::string describe(const Inspection& inspection);
/// One JSON object with the same.
std::string to_json(const Inspection& inspection, const Sequence& sequence);

/// What is in an image file, what its channels hold, and what quell takes it for. Reads all of it; `progress` is told the share
/// that is done. Throws Error(input).
std::string describe_file(ImageFile& file, const std::function<void(double)>& progress);

}  // namespace quell::app
