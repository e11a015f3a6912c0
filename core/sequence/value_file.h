// Numbers of a frame from files.
#pragma once

#include <filesystem>

#include "quell/image/item.h"

namespace quell {

/// A number, a list of numbers, or an object with "values", as the runner writes it: {"frame": 7, "values": [1]}. Other keys are
/// not looked at; null stands for what is no number. Throws Error(input) with every mistake and its place.
Values read_values(const std::filesystem::path& file);

}  // namespace quell
