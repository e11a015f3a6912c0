#include <gmock/gmock.h>

#include <fstream>
#include <set>

#include "tests/core/plugin/test_plugins.h"

namespace quell::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;

/// The lines of the README's one block of plain text.
std::vector<std::string> shown_messages() {
  std::ifstream readme(fs::path(QUELL_SOURCE_DIR) / "passes/README.md");
  std::vector<std::string> lines;
  bool within = false;
  for (std::string line; std::getline(readme, line);) {
    if (within && line == "```") break;
    if (within) lines.push_back(line);
    within = within || line == "```text";
  }
  return lines;
}

/// Everything that loading the test's plugins, and files that are none, is answered with. Paths become FILE.
std::set<std::string> real_messages(const TempFolder& folder) {
  const fs::path whole = test_plugin("raw");
  std::ofstream(folder / "text.so") << "no shared object";
  fs::copy_file(whole, folder / "cut.so");
  fs::resize_file(folder / "cut.so", fs::file_size(whole) / 2);
  fs::copy_file(whole, folder / "machine.so");
  std::fstream(folder / "machine.so", std::ios::binary | std::ios::in | std::ios::out).seekp(18).put('\1');  // e_machine
  Registry registry;
  registry.load_file(folder / "absent.so");
  registry.load_folder(folder.path());
  registry.load_folder(QUELL_TEST_PLUGINS);
  std::set<std::string> messages;
  for (const PluginReport& report : registry.reports()) {
    std::string text = report.error;
    for (const PluginReport& other : registry.reports())
      if (const std::size_t at = text.find(other.file.string()); at != std::string::npos)
        text.replace(at, other.file.string().size(), "FILE");
    messages.insert(text);
    for (std::size_t at = 0, next; at < text.size(); at = next + 2) {  // several passes of one plugin
      next = std::min(text.find("; pass '", at), text.size());
      messages.insert(text.substr(at, next - at));
    }
  }
  return messages;
}

TEST(PassesReadme, ShowsMessagesThatAreReallyGiven) {
  const TempFolder folder;
  const std::set<std::string> real = real_messages(folder);
  const std::vector<std::string> shown = shown_messages();
  EXPECT_GE(shown.size(), 8u);
  for (const std::string& message : shown) EXPECT_THAT(real, Contains(message));
}

}  // namespace
}  // namespace quell::test
