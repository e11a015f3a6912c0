#include "source_tree.h"

#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

#include "quell/text/error.h"

namespace quell::app {
namespace fs = std::filesystem;

namespace {

/// Empty when it cannot be read.
std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Where the last line that starts with `words` starts; npos when none does. A comment starts with something else.
std::size_t find_line(std::string_view text, std::string_view words) {
  for (std::size_t at = text.rfind(words); at != std::string_view::npos; at = text.rfind(words, at - 1)) {
    if (at == 0 || text[at - 1] == '\n') return at;
  }
  return std::string_view::npos;
}

/// The end, line feed included, of the line with the parenthesis that closes the call at `at`.
std::size_t end_of_call(std::string_view text, std::size_t at) {
  const std::size_t line = text.find('\n', text.find(')', at));
  return line == std::string_view::npos ? text.size() : line + 1;
}

std::string call_of(const char* function, const std::string& plugin) { return function + ("(" + plugin); }

/// A line quell_add_pass(PLUGIN ...), whatever follows.
std::size_t find_pass_of(std::string_view text, const std::string& plugin) {
  return find_line(text, call_of("quell_add_pass", plugin) + " ");
}

}  // namespace

bool SourceTree::is_at(const fs::path& folder) {
  return find_line(read(folder / "CMakeLists.txt"), "project(quell ") != std::string::npos &&
         fs::is_regular_file(folder / "passes/CMakeLists.txt");
}

SourceTree::SourceTree(fs::path root) : root_(std::move(root)), passes_(read(passes_cmake())) {}

std::string SourceTree::plugin_of(const std::string& pass) const {
  std::istringstream lines(passes_);
  for (std::string line; std::getline(lines, line);) {
    constexpr std::string_view kCall = "quell_add_pass(";
    if (!line.starts_with(kCall)) continue;
    std::istringstream words(line.substr(kCall.size()));
    std::string plugin, id;
    words >> plugin >> id;
    if (id.substr(0, id.find(')')) == pass) return plugin;
  }
  return "";
}

bool SourceTree::has_plugin(const std::string& plugin) const {
  return find_line(passes_, call_of("quell_add_plugin", plugin) + ")") != std::string::npos;
}

std::string SourceTree::passes_with(const std::string& plugin, const std::string& pass) const {
  std::string text = passes_;
  if (!text.empty() && !text.ends_with('\n')) text += '\n';
  const std::string plugin_line = call_of("quell_add_plugin", plugin) + ")",
                    pass_line = call_of("quell_add_pass", plugin) + " " + pass + ")\n";
  if (!has_plugin(plugin)) return text + "\n" + plugin_line + "\n" + pass_line;
  const std::size_t last_pass = find_pass_of(text, plugin);
  const std::size_t at = last_pass == std::string::npos ? find_line(text, plugin_line) : last_pass;
  return text.insert(end_of_call(text, at), pass_line);
}

std::string SourceTree::graph_tests_with(const std::string& source) const {
  std::string text = read(graph_tests_cmake());
  constexpr std::string_view kCall = "quell_add_test(graphs_test SOURCES";
  const std::size_t at = find_line(text, kCall);
  if (at == std::string::npos)
    throw Error(Fault::usage, graph_tests_cmake().string(),
                "the test of a graph joins the program graphs_test, but no line starts with '" + std::string(kCall) + "'");
  return text.insert(at + kCall.size(), " " + source);
}

fs::path SourceTree::place_of_test(const std::string& program) const {
  std::error_code error;
  for (auto it = fs::recursive_directory_iterator(root_ / "tests", error); !error && it != fs::recursive_directory_iterator();
       it.increment(error)) {
    if (it->path().filename() != "CMakeLists.txt") continue;
    const std::string text = read(it->path());
    for (const char* end : {" ", "\n"})
      if (find_line(text, "quell_add_test(" + program + end) != std::string::npos) return it->path();
  }
  return {};
}

}  // namespace quell::app
