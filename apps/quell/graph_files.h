// Finding the graph that a person names, and the passes that it may use.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "arguments.h"
#include "quell/plugin/registry.h"

namespace quell::app {

/// The folder of the graphs that ship: share/quell/graphs beside the program's bin/, in the build tree as after installation.
std::filesystem::path shipped_graphs_folder();
/// The names that find_graph knows, sorted.
std::vector<std::string> shipped_graphs();
/// A path as it is when there is such a file, else a graph that ships, by bare name. Throws Error(usage) with suggestions.
std::filesystem::path find_graph(const std::string& name);

/// The plugins of a run that did not load.
struct PluginTroubles {
  std::vector<std::string> asked_for;  ///< named by --plugin-path
  std::vector<std::string> others;
};
PluginTroubles find_troubles(const Registry& registry, const PluginArguments& arguments);

/// Loads the plugins. Warns of those that do not load; throws Error(plugin) when one of them was asked for.
Registry load_passes(const PluginArguments& arguments);

}  // namespace quell::app
