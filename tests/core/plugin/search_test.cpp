#include <gmock/gmock.h>

#include <cstdlib>

#include "quell/plugin/loader.h"
#include "tests/core/plugin/test_plugins.h"

namespace quell::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;

/// QUELL_PLUGIN_PATH for the length of a test.
class PluginPath {
 public:
  explicit PluginPath(const std::string& value) { setenv("QUELL_PLUGIN_PATH", value.c_str(), 1); }
  ~PluginPath() { unsetenv("QUELL_PLUGIN_PATH"); }
  PluginPath(const PluginPath&) = delete;
  PluginPath& operator=(const PluginPath&) = delete;
};

TEST(LoadFolder, LoadsAllThatLoadAndReportsAllElse) {
  Registry registry;
  registry.load_folder(QUELL_TEST_PLUGINS);
  EXPECT_THAT(registry.folders(), ElementsAre(fs::path(QUELL_TEST_PLUGINS)));
  for (const char* id : {"raw", "own", "good", "twin", "thrower", "create_with_words", "raw_process"})
    EXPECT_NE(registry.find(id), nullptr) << id;
  std::size_t well = 0;
  for (const PluginReport& report : registry.reports()) {
    EXPECT_TRUE(!report.error.empty() || !report.passes.empty()) << report.file;
    well += report.error.empty();
  }
  EXPECT_EQ(well, 6u);  // raw and the two copies; fails, throws_raw and throws_sdk: bad when they run, not when they load
}

TEST(LoadFolder, GoesByNameAndTakesNothingButSharedObjects) {
  const TempFolder folder;
  fs::copy_file(test_plugin("repeats_id"), folder / "b.so");
  fs::copy_file(test_plugin("raw"), folder / "a.so");
  fs::copy_file(test_plugin("raw"), folder / "c.so.bak");
  Registry registry;
  registry.load_folder(folder.path());
  ASSERT_EQ(registry.reports().size(), 2u);
  EXPECT_EQ(registry.reports()[0].file, folder / "a.so");
  EXPECT_EQ(registry.find("raw")->file, folder / "a.so");
}

TEST(LoadFolder, ReportsAMissingFolder) {
  Registry registry;
  registry.load_folder("/no/such/folder");
  ASSERT_EQ(registry.reports().size(), 1u);
  EXPECT_EQ(registry.reports()[0].file, "/no/such/folder");
  EXPECT_EQ(registry.reports()[0].error, "the folder cannot be read: No such file or directory");
}

TEST(LoadPlugins, LooksInTheOptionThenTheVariableThenBesideTheLibrary) {
  const TempFolder option, variable;
  fs::create_directory(variable / "two");
  fs::copy_file(test_plugin("raw"), option / "first.so");
  fs::copy_file(test_plugin("repeats_id"), variable / "two/second.so");
  const PluginPath path(variable.path().string() + "::" + (variable / "two").string());
  const Registry registry = load_plugins({option.path()});
  EXPECT_THAT(registry.folders(), ElementsAre(option.path(), variable.path(), variable / "two", built_in_passes()));
  EXPECT_EQ(registry.find("raw")->file, option / "first.so");
  EXPECT_EQ(registry.find("own")->file, variable / "two/second.so");
}

TEST(LoadPlugins, TakesSingleFiles) {
  const PluginPath path(test_plugin("raw").string());
  const Registry registry = load_plugins({test_plugin("some_bad")});
  EXPECT_NE(registry.find("raw"), nullptr);
  EXPECT_NE(registry.find("good"), nullptr);
}

TEST(BuiltInPasses, LieBesideTheCoreLibrary) {
  EXPECT_EQ(built_in_passes().lexically_relative(fs::canonical(QUELL_BINARY_DIR)).filename(), "passes");
  EXPECT_TRUE(fs::exists(built_in_passes().parent_path().parent_path() / "libquell_core.so"));
}

}  // namespace
}  // namespace quell::test
