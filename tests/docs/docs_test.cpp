// Every command that a README shows is run, and must print what the README shows.
//
// A block ```console holds commands after "$ " and what they print; "..." in it stands for any text, and alone on a line for any
// lines. A block whose first line is a comment with a file name ("// average.json") is written to that file first. Commands run
// in a folder of their own, where `graphs` is the repository's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Command {
  std::string line;
  std::vector<std::string> expected;
};

struct Page {
  std::vector<std::pair<std::string, std::string>> files;  // name, text
  std::vector<Command> commands;
};

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string read(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

void take_block(const std::string& language, const std::vector<std::string>& block, Page& page) {
  if (language == "console") {
    for (const std::string& line : block) {
      if (line.starts_with("$ "))
        page.commands.push_back({line.substr(2), {}});
      else if (!page.commands.empty())
        page.commands.back().expected.push_back(line);
    }
    return;
  }
  if (block.empty() || !block[0].starts_with("// ") || !block[0].ends_with(".json")) return;
  std::string text;
  for (const std::string& line : block) text += line + "\n";
  page.files.emplace_back(block[0].substr(3), text);
}

Page parse(const fs::path& file) {
  Page page;
  std::vector<std::string> block;
  std::string language;
  bool inside = false;
  for (const std::string& line : split_lines(read(file))) {
    if (!line.starts_with("```")) {
      if (inside) block.push_back(line);
      continue;
    }
    if (inside)
      take_block(language, block, page);
    else
      language = line.substr(3), block.clear();
    inside = !inside;
  }
  return page;
}

// "..." stands for any text within a line.
bool line_matches(const std::string& pattern, const std::string& line) {
  std::size_t at = 0, from = 0;
  for (std::size_t dots; (dots = pattern.find("...", from)) != std::string::npos; from = dots + 3) {
    const std::string piece = pattern.substr(from, dots - from);
    const std::size_t found = from == 0 ? (line.starts_with(piece) ? 0 : std::string::npos) : line.find(piece, at);
    if (found == std::string::npos) return false;
    at = found + piece.size();
  }
  const std::string rest = pattern.substr(from);
  if (from == 0) return line == rest;
  return line.size() >= at + rest.size() && line.ends_with(rest);
}

bool lines_match(const std::vector<std::string>& want, std::size_t w, const std::vector<std::string>& got, std::size_t g) {
  if (w == want.size()) return g == got.size();
  if (want[w] == "...") {
    for (std::size_t next = g; next <= got.size(); ++next)
      if (lines_match(want, w + 1, got, next)) return true;
    return false;
  }
  return g < got.size() && line_matches(want[w], got[g]) && lines_match(want, w + 1, got, g + 1);
}

std::vector<std::string> run(const std::string& command, const fs::path& folder) {
  const std::string shell = "cd '" + folder.string() + "' && PATH='" QUELL_PROGRAM_DIR "':$PATH && { " + command + " ; } 2>&1";
  FILE* pipe = popen(shell.c_str(), "r");
  std::string text;
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), count);
  pclose(pipe);
  return split_lines(text);
}

class Docs : public ::testing::TestWithParam<const char*> {};

TEST_P(Docs, ShowWhatTheProgramPrints) {
  const Page page = parse(fs::path(QUELL_SOURCE_DIR) / GetParam());
  std::string name = GetParam();
  std::ranges::replace(name, '/', '_');
  const fs::path folder = fs::path(::testing::TempDir()) / ("quell_docs_" + name + std::to_string(getpid()));
  fs::create_directories(folder);
  fs::create_directory_symlink(fs::path(QUELL_SOURCE_DIR) / "graphs", folder / "graphs");
  for (const auto& [file, text] : page.files) std::ofstream(folder / file) << text;
  for (const Command& command : page.commands) {
    const auto got = run(command.line, folder);
    EXPECT_TRUE(lines_match(command.expected, 0, got, 0)) << "$ " << command.line << "\n"
                                                          << GetParam() << " shows\n"
                                                          << ::testing::PrintToString(command.expected) << "\nbut it prints\n"
                                                          << ::testing::PrintToString(got);
  }
  fs::remove_all(folder);
}

TEST(DocsMatching, TakesDotsForAnyText) {
  EXPECT_TRUE(line_matches("a ... b", "a x y b"));
  EXPECT_FALSE(line_matches("a ... b", "a x y c"));
  EXPECT_TRUE(line_matches("...: ok", "file: ok"));
  EXPECT_FALSE(line_matches("ok", "not ok"));
  EXPECT_FALSE(line_matches("ab...ba", "aba"));
  EXPECT_TRUE(lines_match({"a", "...", "d"}, 0, {"a", "b", "c", "d"}, 0));
  EXPECT_FALSE(lines_match({"a", "...", "d"}, 0, {"a", "b", "c"}, 0));
}

TEST(DocsMatching, FindsCommandsInTheReadme) { EXPECT_GE(parse(QUELL_SOURCE_DIR "/README.md").commands.size(), 3U); }

INSTANTIATE_TEST_SUITE_P(Readme, Docs,
                         ::testing::Values("README.md", "graphs/README.md", "passes/README.md", "core/README.md",
                                           "core/sequence/README.md", "apps/quell/README.md"),
                         [](const auto& page) {
                           std::string name = page.param;
                           for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                           return name;
                         });

}  // namespace
