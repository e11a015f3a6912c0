// The skeleton of a graph: in a folder of its own, or among the graphs of quell's source tree.
#include <algorithm>

#include "graph_files.h"
#include "installation.h"
#include "new_names.h"
#include "new_skeleton.h"
#include "quell/text/error.h"
#include "quell/text/shell_word.h"
#include "source_tree.h"
#include "templates.h"

namespace quell::app {
namespace fs = std::filesystem;

namespace {

std::string fill(std::string_view text, const std::string& name, const std::string& graph_folder) {
  return fill_template(text, {{"my_graph", name}, {"MyClass", class_name(name, "Graph")}, {"GRAPH_FOLDER", graph_folder}});
}

void add(Skeleton& skeleton, const fs::path& file, std::string text) {
  skeleton.written.push_back(file.string());
  skeleton.files.add(file, std::move(text));
}

Skeleton::Step try_step(const fs::path& graph, const fs::path& out) {
  const std::string word = shell_word(graph.string());
  const fs::path sample = shipped_sample();
  const std::string sequence = sample.empty() ? "SEQUENCE" : shell_word(sample.string());
  return {"check it, and try it on the sequence that ships",
          {"quell check " + word + " " + sequence,
           "quell run " + word + " " + sequence + " -o " + shell_word(out.string()) + " --frames 1-4 --format exr --format png"}};
}

Skeleton make_alone(const NewGraph& graph) {
  const fs::path folder = graph.folder.empty() ? fs::path(graph.name) : graph.folder;
  Skeleton skeleton;
  add(skeleton, folder / (graph.name + ".json"), fill(kGraphTemplate, graph.name, ""));
  add(skeleton, folder / (graph.name + "_test.cpp"), fill(kGraphTestTemplate, graph.name, "GRAPH_FOLDER"));
  add(skeleton, folder / "CMakeLists.txt", fill(kGraphCMakeTemplate, graph.name, "GRAPH_FOLDER"));
  skeleton.next.push_back(try_step(folder / (graph.name + ".json"), folder / "out"));
  const std::string source = shell_word(folder.string()), build = shell_word((folder / "build").string());
  const CMakePrefix prefix = cmake_prefix();
  if (!prefix.before.empty()) skeleton.next.push_back({"install quell, once, so that CMake finds it", prefix.before});
  skeleton.next.push_back({"test it",
                           {"cmake -S " + source + " -B " + build + " -DCMAKE_PREFIX_PATH=" + prefix.word,
                            "cmake --build " + build + " && ctest --test-dir " + build + " --output-on-failure"}});
  return skeleton;
}

Skeleton make_in_tree(const NewGraph& graph, const fs::path& root) {
  const SourceTree tree(root);
  const std::string test = graph.name + "_test.cpp";
  Skeleton skeleton;
  add(skeleton, root / "graphs" / (graph.name + ".json"), fill(kGraphTemplate, graph.name, ""));
  add(skeleton, root / "tests/graphs" / test, fill(kGraphTestTemplate, graph.name, "QUELL_SOURCE_DIR \"/graphs\""));
  skeleton.files.replace(tree.graph_tests_cmake(), tree.graph_tests_with(test));
  skeleton.written.push_back(tree.graph_tests_cmake().string() + ": one source more");
  skeleton.next.push_back(try_step(root / "graphs" / (graph.name + ".json"), root / "build" / graph.name));
  Skeleton::Step step{"test it", {}};
  if (!graph.folder.empty()) step.commands.push_back("cd " + shell_word(root.string()));
  step.commands.push_back("cmake --preset release -DQUELL_BUILD_TESTS=ON");
  step.commands.push_back("cmake --build --preset release --target graphs_test");
  step.commands.push_back("build/release/bin/graphs_test --gtest_filter='" + class_name(graph.name, "Graph") + ".*:*/" +
                          graph.name + "'");
  skeleton.next.push_back(step);
  return skeleton;
}

}  // namespace

Skeleton make_graph_skeleton(const NewGraph& graph) {
  check_new_name(graph.name, "a graph");
  const std::vector<std::string> shipped = shipped_graphs();
  if (std::find(shipped.begin(), shipped.end(), graph.name) != shipped.end())
    throw Error(Fault::usage, "", "'" + graph.name + "' is a graph that ships with quell; choose another name");
  const fs::path root = graph.folder.empty() ? fs::path(".") : graph.folder;
  if (!SourceTree::is_at(root)) return make_alone(graph);
  return make_in_tree(graph, graph.folder.empty() ? fs::path() : root);
}

}  // namespace quell::app
