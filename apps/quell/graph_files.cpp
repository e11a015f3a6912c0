#include "graph_files.h"

#include <algorithm>

#include "quell/graph/schema.h"
#include "quell/text/diagnostic.h"

namespace quell::app {
namespace fs = std::filesystem;

fs::path shipped_graphs_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  return (program.parent_path() / QUELL_GRAPHS_FROM_BIN).lexically_normal();
}

std::vector<std::string> shipped_graphs() {
  std::vector<std::string> names;
  std::error_code error;
  for (auto it = fs::directory_iterator(shipped_graphs_folder(), error); !error && it != fs::directory_iterator();
       it.increment(error))
    if (it->path().extension() == ".json" && it->path().filename() != kSchemaFileName && it->is_regular_file())
      names.push_back(it->path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

fs::path find_graph(const std::string& name) {
  std::error_code error;
  if (fs::exists(name, error) && !fs::is_directory(name, error)) return name;
  const std::vector<std::string> names = shipped_graphs();
  const bool is_bare = name.find('/') == std::string::npos;
  if (is_bare && std::find(names.begin(), names.end(), name) != names.end()) return shipped_graphs_folder() / (name + ".json");
  std::string what = fs::is_directory(name, error) ? "this is a folder, not a graph file" : "there is no such graph file";
  if (fs::exists(name + ".json", error))
    what += "; did you mean '" + name + ".json'?";
  else if (is_bare)
    what += did_you_mean(name, names);
  what += names.empty() ? "" : "; quell ships with " + list_names(names, "and");
  throw Error(Fault::usage, name, what);
}

namespace {

bool is_asked_for(const fs::path& file, const std::vector<fs::path>& asked) {
  const auto names = [&](const fs::path& path) {
    std::error_code error;
    return path == file || fs::equivalent(path, file, error) || fs::equivalent(path, file.parent_path(), error);
  };
  return std::any_of(asked.begin(), asked.end(), names);
}

}  // namespace

PluginTroubles find_troubles(const Registry& registry, const PluginArguments& arguments) {
  PluginTroubles troubles;
  for (const PluginReport& report : registry.reports()) {
    if (report.error.empty()) continue;
    auto& list = is_asked_for(report.file, arguments.plugin_path) ? troubles.asked_for : troubles.others;
    list.push_back(report.file.string() + ": " + report.error);
  }
  return troubles;
}

Registry load_passes(const PluginArguments& arguments) {
  Registry registry = load_plugins(arguments.plugin_path);
  const PluginTroubles troubles = find_troubles(registry, arguments);
  for (const std::string& trouble : troubles.others) spdlog::warn("plugin {}", trouble);
  std::string text;
  for (const std::string& trouble : troubles.asked_for) text += (text.empty() ? "plugin " : "\nplugin ") + trouble;
  if (!text.empty()) throw Error(Fault::plugin, "", text);
  return registry;
}

}  // namespace quell::app
