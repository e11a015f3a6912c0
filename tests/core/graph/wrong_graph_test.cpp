// Every graph in wrong/ is refused with exactly the message that stands in the .txt file beside it. A file .options beside it
// holds settings from outside, one a line: "--set node.param=value" or "--params file".
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "quell/graph/graph.h"
#include "tests/core/graph/test_passes.h"

namespace quell {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(QUELL_SOURCE_DIR) / "tests/core/graph/wrong";

std::vector<std::string> wrong_graphs() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(kFolder))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string read(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

GraphOptions read_options(const fs::path& file) {
  GraphOptions options;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("--set ")) options.set.push_back(line.substr(6));
    if (line.starts_with("--params ")) options.params.emplace_back(line.substr(9));
  }
  return options;
}

class WrongGraph : public testing::TestWithParam<std::string> {
 protected:
  // Messages name files as they were given, so they are given relative to this folder.
  void SetUp() override { fs::current_path(kFolder); }
};

TEST_P(WrongGraph, IsRefusedWithItsMessage) {
  const std::string expected = read(GetParam() + ".txt");
  ASSERT_FALSE(expected.empty()) << GetParam() << ".txt is missing";
  try {
    load_graph(GetParam() + ".json", test::passes(), read_options(GetParam() + ".options"));
    FAIL() << "the graph was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::usage);
    EXPECT_EQ(std::string(error.what()) + "\n", expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, WrongGraph, testing::ValuesIn(wrong_graphs()), [](const auto& test) { return test.param; });

TEST(WrongGraphs, AreMany) { EXPECT_GE(wrong_graphs().size(), 45u); }

}  // namespace
}  // namespace quell
