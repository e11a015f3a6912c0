// What is told of frames that lack files.
#pragma once

#include <string>
#include <vector>

#include "quell/sequence/sequence.h"

namespace quell::app {

/// A line each, "\n  frame 3, color: shot/color.0003.exr", of the first ones, and how many more there are.
std::string list_missing(const std::vector<MissingFile>& missing);
/// Warns that their frames are left out; says nothing when there are none.
void warn_of_missing(const std::vector<MissingFile>& missing);

}  // namespace quell::app
