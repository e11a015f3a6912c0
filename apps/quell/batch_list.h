// The list of shots that `quell batch` runs. How it is written is told in README.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "quell/text/diagnostic.h"
#include "quell/text/json.h"

namespace quell::app {

/// What the list says about one option of `quell run`.
struct ShotOption {
  std::string name;  ///< without dashes; "graph" and "sequence" for the arguments that have none
  std::vector<std::string> values;
  Position where;  ///< of the value
};

struct Shot {
  std::string name;  ///< may be that of a file
  std::vector<ShotOption> options;
  Position where;

  /// Null when the list says nothing about it.
  const ShotOption* find(std::string_view option) const;
};

/// Reads a list and checks it, graphs and all, as `quell run` would; relative names are taken from the current folder. Throws
/// Error(usage) that tells every mistake with its place.
std::vector<Shot> read_batch(const SourceTextPtr& list);

/// The command line of such a shot, from "run" on.
std::vector<std::string> command_of(const std::vector<ShotOption>& options);

}  // namespace quell::app
