// Where this program is installed or was built, for commands that a person is told to type.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace quell::app {

/// How CMake is told where this quell is: commands to give once before, none where it is installed, and what follows
/// -DCMAKE_PREFIX_PATH=.
struct CMakePrefix {
  std::vector<std::string> before;
  std::string word;
};
CMakePrefix cmake_prefix();

/// The sequence that ships; empty when it is not there.
std::filesystem::path shipped_sample();

}  // namespace quell::app
