#include "installation.h"

#include "graph_files.h"
#include "quell/text/shell_word.h"

namespace quell::app {
namespace fs = std::filesystem;

CMakePrefix cmake_prefix() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  fs::path prefix = (program.parent_path() / QUELL_PREFIX_FROM_BIN).lexically_normal();
  if (!prefix.has_filename()) prefix = prefix.parent_path();  // "/opt/quell/"
  if (fs::exists(prefix / QUELL_PACKAGE_FILE, error)) return {{}, shell_word(prefix.string())};
  const std::string home = "\"$HOME/quell\"";
  const std::string build = fs::exists(prefix / "CMakeCache.txt", error) ? shell_word(prefix.string()) : "BUILD_FOLDER_OF_QUELL";
  return {{"cmake --build " + build + " --target quell quell_testing", "cmake --install " + build + " --prefix " + home}, home};
}

fs::path shipped_sample() {
  const fs::path sample = shipped_graphs_folder() / "sample";
  std::error_code error;
  return fs::is_directory(sample, error) ? sample : fs::path();
}

}  // namespace quell::app
