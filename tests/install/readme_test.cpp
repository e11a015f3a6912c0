#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kRoot = QUELL_SOURCE_DIR;

std::string read_all(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(PassesReadme, ShowsTheFilesThatInstallConsumerBuilds) {
  const std::string readme = read_all(kRoot / "passes/README.md");
  for (const auto& [file, language] : {std::pair{"invert.cpp", "cpp"}, {"invert_test.cpp", "cpp"}, {"CMakeLists.txt", "cmake"}}) {
    const std::string text = read_all(kRoot / "tests/install/consumer" / file);
    ASSERT_FALSE(text.empty()) << file;
    EXPECT_THAT(readme, HasSubstr("```" + std::string(language) + "\n" + text + "```\n")) << file;
  }
}

}  // namespace
