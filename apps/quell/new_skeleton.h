// What `quell new` writes, and what it says about it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "new_files.h"

namespace quell::app {

struct NewPass {
  std::string name;
  std::string plugin;            ///< empty: the pass's own name, in quell's source tree kDefaultPlugin
  std::filesystem::path folder;  ///< empty: one called as the pass, or the current one when that is quell's source tree
};

struct NewGraph {
  std::string name;
  std::filesystem::path folder;  ///< as for a pass
};

/// The plugin that new passes of quell's own tree join: the skeleton is a spatial filter.
inline constexpr const char* kDefaultPlugin = "spatial";

/// Files, and what to do with them.
struct Skeleton {
  NewFiles files;
  std::vector<std::string> written;  ///< one line a file
  struct Step {
    std::string title;
    std::vector<std::string> commands;
  };
  std::vector<Step> next;
};

/// Throw Error(usage) when the name or a file is taken. Nothing is written before Skeleton::files.commit().
Skeleton make_pass_skeleton(const NewPass& pass);
Skeleton make_graph_skeleton(const NewGraph& graph);

}  // namespace quell::app
