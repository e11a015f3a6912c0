// Small graphs around each pass of a registry, right and wrong, made from what the pass says of itself.
#pragma once

#include <string>
#include <vector>

#include "quell/plugin/registry.h"

namespace quell::test {

struct Variant {
  std::string name;  ///< "joint_bilateral: radius above its range"
  std::string text;
  bool is_right = false;
};

/// For every pass: all inputs connected and every parameter at its bounds; each required input missing, unknown inputs,
/// parameters and keys, values of the wrong type, out of range or of the wrong length, versions that are not there.
std::vector<Variant> make_variants(const Registry& passes);

}  // namespace quell::test
