// What renderers disagree about, a row each: who writes it so, where that is known from, and a file made like theirs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/core/sequence/test_files.h"

namespace quell::test {

struct ConventionRow {
  std::string input;       ///< "motion"
  std::string convention;  ///< as --in takes it: "unit=uv:sign=current-previous"; "" when the file's format says it all
  std::string writer, source;
  std::string extension;                                    ///< of the file, "exr"
  std::function<void(const std::filesystem::path&)> write;  ///< makes the file
  std::vector<double> expected;                             ///< the planes' values of the pixel (0, 0)
  std::string wrong = {};                                   ///< the same convention's other side, which must give other values
};

/// Images of 8 x 4 pixels, beside which the camera of convention_camera() is found.
const std::vector<ConventionRow>& convention_rows();

/// The sidecar of the scene: the camera stands in (10, 20, 30), looks along +y of the world, its x is the world's x and its y the
/// world's z; camera space has y up and looks along -z.
std::string convention_camera();

/// The rows as a table for the README.
std::string convention_table();

}  // namespace quell::test
