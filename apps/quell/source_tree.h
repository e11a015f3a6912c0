// quell's own source tree, as `quell new` adds to it.
#pragma once

#include <filesystem>
#include <string>

namespace quell::app {

class SourceTree {
 public:
  /// Whether the folder is the root of quell's source tree.
  static bool is_at(const std::filesystem::path& folder);
  explicit SourceTree(std::filesystem::path root);

  /// PLUGIN of the line quell_add_pass(PLUGIN pass ...) in passes/CMakeLists.txt; "" when there is none.
  std::string plugin_of(const std::string& pass) const;
  bool has_plugin(const std::string& plugin) const;
  /// passes/CMakeLists.txt with a line for a pass: below the plugin's last one, or, for a new plugin, at the end.
  std::string passes_with(const std::string& plugin, const std::string& pass) const;
  /// tests/graphs/CMakeLists.txt with one more source in graphs_test. Throws Error(usage) when graphs_test is not found there.
  std::string graph_tests_with(const std::string& source) const;
  /// The CMakeLists.txt that makes a test program of that name; empty when none does.
  std::filesystem::path place_of_test(const std::string& program) const;

  std::filesystem::path passes_cmake() const { return root_ / "passes/CMakeLists.txt"; }
  std::filesystem::path graph_tests_cmake() const { return root_ / "tests/graphs/CMakeLists.txt"; }

 private:
  std::filesystem::path root_;
  std::string passes_;
};

}  // namespace quell::app
