// The passes that can be used, and what became of every plugin file that was looked at.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "quell/sdk/abi.h"

namespace quell {

/// What became of one file.
struct PluginReport {
  std::filesystem::path file;
  std::vector<std::string> passes;  ///< ids that it brought
  std::string error;                ///< why nothing, or not everything, of it was taken; empty when all is well
};

/// One pass that can be used. The descriptor was checked and stays valid for the rest of the process.
struct RegisteredPass {
  const quell_pass_desc* desc = nullptr;
  std::filesystem::path file;  ///< empty for a pass that is linked in
};

/// Passes by id. A plugin that does not load is reported and harms no other.
class Registry {
 public:
  /// Loads every `*.so` of a folder, in the order of names. A missing folder is reported as an error.
  void load_folder(const std::filesystem::path& folder);
  /// Loads one file; what goes wrong is found in reports().
  void load_file(const std::filesystem::path& file);
  /// Takes passes that are linked into the program (in tests). Throws Error as load_file would report.
  void add(const quell_pass_desc* const* passes, std::uint32_t count, const std::filesystem::path& file = {});

  /// Null when there is none.
  const RegisteredPass* find(std::string_view id) const;
  const std::map<std::string, RegisteredPass, std::less<>>& passes() const { return passes_; }
  const std::vector<PluginReport>& reports() const { return reports_; }
  /// Folders that were looked at, for "unknown pass" messages.
  const std::vector<std::filesystem::path>& folders() const { return folders_; }

 private:
  void take(const quell_pass_desc* const* passes, std::uint32_t count, PluginReport& report);
  std::map<std::string, RegisteredPass, std::less<>> passes_;
  std::vector<PluginReport> reports_;
  std::vector<std::filesystem::path> folders_;
};

/// The registry of a program: first `extra` (files or folders, from --plugin-path), then those of QUELL_PLUGIN_PATH (separated by
/// ':'), then the passes beside quell itself (`quell/passes` beside the core library).
Registry load_plugins(const std::vector<std::filesystem::path>& extra = {});

/// What is wrong with a descriptor (a null pointer, two ports of one name, a default outside its range, ...); empty when nothing
/// is. Reads no more of it than its struct_size covers.
std::string check(const quell_pass_desc& desc);

}  // namespace quell
