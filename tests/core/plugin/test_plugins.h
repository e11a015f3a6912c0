// The plugins of bad/, by name, and a folder that goes away with the test.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "quell/plugin/registry.h"

namespace quell::test {

inline std::filesystem::path test_plugin(const std::string& name) {
  return std::filesystem::path(QUELL_TEST_PLUGINS) / (name + ".so");
}

/// The one report of a registry that looked at one file.
inline PluginReport load_report(const std::filesystem::path& file) {
  Registry registry;
  registry.load_file(file);
  EXPECT_EQ(registry.reports().size(), 1u);
  return registry.reports().at(0);
}

class TempFolder {
 public:
  TempFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("quell_" + std::string(test->name()).substr(0, 40) + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(path_);
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace quell::test
