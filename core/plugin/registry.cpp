#include "quell/plugin/registry.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "quell/plugin/loader.h"
#include "quell/text/error.h"

namespace quell {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kMostPasses = 1000;  // of one plugin; more come from a broken array

std::string place(const fs::path& file) { return file.empty() ? "the program itself" : file.string(); }

/// Files and folders alike, as the options and the environment name them.
void load(Registry& registry, const fs::path& path) {
  if (path.empty()) return;
  std::error_code ignored;
  if (fs::is_directory(path, ignored) || !path.has_extension())
    registry.load_folder(path);
  else
    registry.load_file(path);
}

}  // namespace

void Registry::load_folder(const fs::path& folder) {
  folders_.push_back(folder);
  std::error_code error;
  std::vector<fs::path> files;
  for (auto it = fs::directory_iterator(folder, error); !error && it != fs::directory_iterator(); it.increment(error))
    if (it->path().extension() == ".so") files.push_back(it->path());
  if (error) {
    reports_.push_back({folder, {}, "the folder cannot be read: " + error.message()});
    return;
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) load_file(file);
}

void Registry::load_file(const fs::path& file) {
  // One file may be named twice, by two folders of a search path or through a link.
  std::error_code error;
  const auto same_file = [&](const PluginReport& report) { return fs::equivalent(report.file, file, error); };
  if (std::any_of(reports_.begin(), reports_.end(), same_file)) return;
  try {
    const PassList list = open_plugin(file);
    reports_.push_back({file, {}, {}});
    take(list.passes, list.count, reports_.back());
  } catch (const Error& failure) {
    // The report names the file already.
    const std::string text = failure.what();
    const std::string prefix = file.string() + ": ";
    reports_.push_back({file, {}, text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : text});
  }
}

void Registry::add(const quell_pass_desc* const* passes, std::uint32_t count, const fs::path& file) {
  PluginReport report{file, {}, {}};
  take(passes, count, report);
  if (!report.error.empty()) throw Error(Fault::plugin, place(file), report.error);
}

void Registry::take(const quell_pass_desc* const* passes, std::uint32_t count, PluginReport& report) {
  const auto refuse = [&](const std::string& why) { report.error += (report.error.empty() ? "" : "; ") + why; };
  if (count > kMostPasses) return refuse("the plugin claims to have " + std::to_string(count) + " passes");
  if (count == 0) return refuse("the plugin has no passes");
  if (!passes) return refuse("the plugin's array of passes is null");
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string wrong = passes[i] ? check(*passes[i]) : "pass " + std::to_string(i) + " of the plugin is null";
    if (!wrong.empty()) {
      refuse(wrong);
      continue;
    }
    const auto [it, is_new] = passes_.try_emplace(passes[i]->id, RegisteredPass{passes[i], report.file});
    if (is_new)
      report.passes.push_back(passes[i]->id);
    else if (it->second.file == report.file)
      refuse("pass '" + it->first + "' is there twice");
    else
      refuse("pass '" + it->first + "' is already provided by " + place(it->second.file) +
             "; remove one of the two files, or rename the pass");
  }
}

const RegisteredPass* Registry::find(std::string_view id) const {
  const auto it = passes_.find(id);
  return it == passes_.end() ? nullptr : &it->second;
}

Registry load_plugins(const std::vector<fs::path>& extra) {
  Registry registry;
  for (const fs::path& path : extra) load(registry, path);
  if (const char* variable = std::getenv("QUELL_PLUGIN_PATH")) {
    std::istringstream paths(variable);
    for (std::string path; std::getline(paths, path, ':');) load(registry, path);
  }
  registry.load_folder(built_in_passes());
  return registry;
}

}  // namespace quell
