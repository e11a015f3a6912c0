#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "quell/text/error.h"
#include "tests/core/plugin/test_plugins.h"
#include "tests/core/plugin/valid_pass.h"

namespace quell::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

std::string read_all(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(LoadPlugin, TakesAPluginInPlainC) {
  const PluginReport report = load_report(test_plugin("raw"));
  EXPECT_EQ(report.error, "");
  EXPECT_THAT(report.passes, ElementsAre("raw"));
}

TEST(LoadPlugin, TakesAnOlderMinorInterface) {
  const PluginReport report = load_report(test_plugin("older_minor"));
  EXPECT_EQ(report.error, "");
  EXPECT_THAT(report.passes, ElementsAre("raw"));
}

TEST(LoadPlugin, RefusesANewerMinorInterface) {
  EXPECT_EQ(load_report(test_plugin("newer_minor")).error,
            "built for plugin interface 1.3, this quell supports up to 1.2; rebuild the plugin or update quell");
}

TEST(LoadPlugin, RefusesANewerMajorInterface) {
  EXPECT_EQ(load_report(test_plugin("newer_major")).error,
            "built for plugin interface 2.0, this quell supports up to 1.2; rebuild the plugin or update quell");
}

TEST(LoadPlugin, RefusesAnOlderMajorInterface) {
  EXPECT_EQ(load_report(test_plugin("older_major")).error,
            "built for plugin interface 0.9, this quell supports 1.0 to 1.2; rebuild the plugin");
}

TEST(LoadPlugin, NamesTheSymbolThatIsMissing) {
  EXPECT_EQ(load_report(test_plugin("no_abi_symbol")).error,
            "not a quell plugin: the symbol 'quell_plugin_abi' is missing; QUELL_REGISTER_PASS would define it");
  EXPECT_EQ(load_report(test_plugin("no_passes_symbol")).error,
            "not a quell plugin: the symbol 'quell_plugin_passes' is missing; QUELL_REGISTER_PASS would define it");
}

TEST(LoadPlugin, QuotesTheLinkersReason) {
  const fs::path file = test_plugin("unresolved");
  EXPECT_EQ(load_report(file).error, "cannot be loaded: " + file.string() + ": undefined symbol: missing_helper");
}

TEST(LoadPlugin, RefusesWhatIsNoElfFile) {
  const TempFolder folder;
  std::ofstream(folder / "text.so") << "This is a text of more than sixty-four bytes, and not a shared object at all.";
  EXPECT_EQ(load_report(folder / "text.so").error, "not an ELF shared object: the file has no ELF header");
  std::ofstream(folder / "empty.so").flush();
  EXPECT_EQ(load_report(folder / "empty.so").error, "not an ELF shared object: the file has no ELF header");
  fs::create_directory(folder / "folder.so");
  EXPECT_EQ(load_report(folder / "folder.so").error, "not an ELF shared object: this is not a regular file");
  EXPECT_EQ(load_report(folder / "absent.so").error, "there is no such file");
}

TEST(LoadPlugin, ReportsANameThatTheSystemRefuses) {
  EXPECT_EQ(load_report(std::string(300, 'x') + ".so").error, "cannot be read: File name too long");
}

TEST(LoadPlugin, RefusesAnElfFileOfAnotherMachineOrKind) {
  const TempFolder folder;
  std::string bytes = read_all(test_plugin("raw"));
  bytes[18] = static_cast<char>(bytes[18] + 1);  // e_machine
  std::ofstream(folder / "machine.so") << bytes;
  EXPECT_EQ(load_report(folder / "machine.so").error,
            "not an ELF shared object for this machine; build the plugin for the machine that runs quell");
  bytes = read_all(test_plugin("raw"));
  bytes[16] = 1;  // e_type: ET_REL
  std::ofstream(folder / "object.so") << bytes;
  EXPECT_EQ(load_report(folder / "object.so").error,
            "not an ELF shared object: this is an ELF file of another kind, such as an object file");
}

// dlopen itself dies on some of these with a bus error.
TEST(LoadPlugin, SurvivesATruncatedFileOfAnyLength) {
  const TempFolder folder;
  const std::string bytes = read_all(test_plugin("raw"));
  for (const std::size_t size : {std::size_t{64}, std::size_t{100}, bytes.size() / 4, bytes.size() / 2}) {
    const fs::path file = folder / ("cut" + std::to_string(size) + ".so");
    std::ofstream(file, std::ios::binary) << bytes.substr(0, size);
    EXPECT_EQ(load_report(file).error, "not an ELF shared object: the file is truncated") << size;
  }
  std::ofstream(folder / "cut63.so", std::ios::binary) << bytes.substr(0, 63);
  EXPECT_EQ(load_report(folder / "cut63.so").error, "not an ELF shared object: the file has no ELF header");
}

TEST(LoadPlugin, RefusesAnArrayOfPassesThatCannotBe) {
  EXPECT_EQ(load_report(test_plugin("null_array")).error, "the plugin's array of passes is null");
  EXPECT_EQ(load_report(test_plugin("no_passes")).error, "the plugin has no passes");
  EXPECT_EQ(load_report(test_plugin("endless_array")).error, "the plugin claims to have 4294967295 passes");
}

TEST(LoadPlugin, ContainsWhatThePluginThrows) {
  EXPECT_EQ(load_report(test_plugin("throws_in_probe")).error, "quell_plugin_abi failed: it threw 'no probe today'");
  EXPECT_EQ(load_report(test_plugin("throws_in_list")).error,
            "quell_plugin_passes failed: it threw something that is not a std::exception");
}

TEST(LoadPlugin, KeepsTheGoodPassesBetweenBadOnes) {
  const PluginReport report = load_report(test_plugin("some_bad"));
  EXPECT_THAT(report.passes, ElementsAre("good"));
  EXPECT_EQ(report.error,
            "the descriptor of a pass has the struct_size 136 instead of 144; "
            "the descriptor of a pass has the struct_size 3735928559 instead of 144; "
            "pass 3 of the plugin is null; "
            "pass 'no_process': its function process is null");
}

TEST(LoadPlugin, TurnsMistakesOfSdkDeclarationsIntoReasons) {
  const PluginReport report = load_report(test_plugin("dangling_same_as"));
  EXPECT_THAT(report.passes, IsEmpty());
  EXPECT_EQ(report.error, "pass 0 of the plugin is null; pass 'dangling': output 'color': its same_as names no input");
}

TEST(LoadPlugin, NamesBothFilesWhenAnIdIsRepeated) {
  Registry registry;
  registry.load_file(test_plugin("raw"));
  registry.load_file(test_plugin("repeats_id"));
  ASSERT_EQ(registry.reports().size(), 2u);
  const PluginReport& second = registry.reports()[1];
  EXPECT_EQ(second.file, test_plugin("repeats_id"));
  EXPECT_EQ(second.error, "pass 'raw' is already provided by " + test_plugin("raw").string() +
                              "; remove one of the two files, or rename the pass");
  EXPECT_THAT(second.passes, ElementsAre("own"));
  EXPECT_EQ(registry.find("raw")->file, test_plugin("raw"));
}

TEST(LoadPlugin, TakesTheFirstOfTwoPassesOfOneFileAndId) {
  const PluginReport report = load_report(test_plugin("twins"));
  EXPECT_THAT(report.passes, ElementsAre("twin"));
  EXPECT_EQ(report.error, "pass 'twin' is there twice");
}

// The C++ compiler makes such statics one for the whole process, unless they are hidden.
TEST(LoadPlugin, KeepsClassesOfOneNameApart) {
  Registry registry;
  registry.load_file(test_plugin("first_copy"));
  registry.load_file(test_plugin("second_copy"));
  EXPECT_THAT(registry.reports()[0].passes, ElementsAre("first_copy"));
  EXPECT_THAT(registry.reports()[1].passes, ElementsAre("second_copy"));
}

TEST(LoadPlugin, LooksAtAFileOnce) {
  const TempFolder folder;
  fs::create_symlink(test_plugin("raw"), folder / "link.so");
  Registry registry;
  registry.load_file(test_plugin("raw"));
  registry.load_file(test_plugin("raw"));
  registry.load_file(folder / "link.so");
  ASSERT_EQ(registry.reports().size(), 1u);
  EXPECT_EQ(registry.reports()[0].error, "");
}

TEST(AddPasses, ThrowsWhatLoadFileWouldReport) {
  Registry registry;
  ValidPass pass;
  const quell_pass_desc* const passes[] = {&pass.desc};
  registry.add(passes, 1);
  EXPECT_NE(registry.find("valid"), nullptr);
  EXPECT_EQ(registry.find("invalid"), nullptr);
  try {
    registry.add(passes, 1, "other.so");
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::plugin);
    EXPECT_STREQ(
        error.what(),
        "other.so: pass 'valid' is already provided by the program itself; remove one of the two files, or rename the pass");
  }
}

}  // namespace
}  // namespace quell::test
