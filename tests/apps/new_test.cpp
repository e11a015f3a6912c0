// quell new: what it writes, and what it refuses. That what it writes builds and passes is seen by tests/install.
#include "new_files.h"

#include <gmock/gmock.h>

#include "quell/text/error.h"
#include "tests/apps/sample.h"

namespace quell::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class New : public RunnerTest {
 protected:
  New() : before_(fs::current_path()) { fs::current_path(path("")); }
  ~New() override { fs::current_path(before_); }

  std::string read(const std::string& name) const { return read_file(path(name)); }
  /// As much of quell's source tree as `quell new` looks at.
  void make_tree(const std::string& folder = "") const {
    write_file(folder + "CMakeLists.txt", "cmake_minimum_required(VERSION 3.25)\nproject(quell VERSION 0.1.0)\n");
    write_file(folder + "passes/CMakeLists.txt", kPasses);
    write_file(folder + "tests/core/CMakeLists.txt", "quell_add_test(image_test SOURCES image_test.cpp)\n");
    write_file(folder + "tests/graphs/CMakeLists.txt", "quell_add_test(graphs_test SOURCES a_test.cpp LINK quell::testing)\n");
  }
  static constexpr const char* kPasses =
      "# quell_add_plugin(spatial)\n"
      "quell_add_plugin(spatial)\n"
      "quell_add_pass(spatial blur SOURCES blur_kernel.cpp\n"
      "               LINK hwy::hwy)\n"
      "\n"
      "quell_add_plugin(spatial_too)\n"
      "quell_add_pass(spatial_too blot)";

 private:
  fs::path before_;
};

TEST_F(New, PassIsAPluginInAFolderOfItsOwn) {
  const Outcome outcome = quell({"new", "pass", "soften_edges"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, StartsWith("written\n  soften_edges/CMakeLists.txt\n  soften_edges/soften_edges.cpp\n"
                                      "  soften_edges/soften_edges_test.cpp\n\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  cmake -S soften_edges -B soften_edges/build -DCMAKE_PREFIX_PATH="));
  EXPECT_THAT(list("soften_edges"), ElementsAre("CMakeLists.txt", "soften_edges.cpp", "soften_edges_test.cpp"));
  EXPECT_THAT(read("soften_edges/CMakeLists.txt"), HasSubstr("\nquell_add_pass(soften_edges soften_edges)"));
  EXPECT_THAT(read("soften_edges/soften_edges.cpp"), HasSubstr("\nclass SoftenEdgesPass final : public Pass {"));
  EXPECT_THAT(read("soften_edges/soften_edges_test.cpp"), HasSubstr("\nTEST(SoftenEdges, "));
}

TEST_F(New, NothingOfTheTemplatesNamesIsLeft) {
  make_tree("tree/");
  EXPECT_EQ(quell({"new", "pass", "soften", "--plugin", "studio"}).code, 0);
  EXPECT_EQ(quell({"new", "graph", "calm"}).code, 0);
  EXPECT_EQ(quell({"new", "pass", "soften", "--folder", "tree"}).code, 0);
  EXPECT_EQ(quell({"new", "graph", "calm", "--folder", "tree"}).code, 0);
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(path(""))) {
    if (!entry.is_regular_file()) continue;
    const std::string text = read_file(entry.path());
    for (const char* name : {"my_pass", "MyPass", "MyClass", "my_plugin", "my_graph", "MyGraph", "@"})
      EXPECT_THAT(text, Not(HasSubstr(name))) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 14);
}

TEST_F(New, NameMayHoldTheTemplatesOwnWords) {
  EXPECT_EQ(quell({"new", "pass", "my_plugin_pass"}).code, 0);
  EXPECT_THAT(read("my_plugin_pass/CMakeLists.txt"), HasSubstr("\nquell_add_pass(my_plugin_pass my_plugin_pass)"));
  EXPECT_THAT(read("my_plugin_pass/my_plugin_pass.cpp"), HasSubstr("\nclass MyPluginPass final"));
  // A class called as one of the SDK's would hide it.
  EXPECT_EQ(quell({"new", "pass", "frame"}).code, 0);
  EXPECT_THAT(read("frame/frame.cpp"), HasSubstr("\nclass FramePass final"));
  EXPECT_EQ(quell({"new", "pass", "pass"}).code, 0);
  EXPECT_THAT(read("pass/pass.cpp"), HasSubstr("\nclass PassPass final"));
}

TEST_F(New, FolderAndPluginCanBeChosen) {
  const Outcome outcome = quell({"new", "pass", "soften", "--folder", "deep/a folder", "--plugin", "studio"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(read("deep/a folder/CMakeLists.txt"), HasSubstr("\nquell_add_plugin(studio)\nquell_add_pass(studio soften)"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  cmake -S 'deep/a folder' -B 'deep/a folder/build' "));
  EXPECT_THAT(outcome.out, HasSubstr("\n  quell passes soften --plugin-path 'deep/a folder/build/"));
}

TEST_F(New, NothingIsEverOverwritten) {
  write_file("soften/soften_test.cpp", "mine");
  write_file("soften/notes", "mine, too");
  const Outcome outcome = quell({"new", "pass", "soften"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err,
            "error: soften/soften_test.cpp: exists already, and nothing is ever overwritten; choose another name or folder\n");
  EXPECT_THAT(list("soften"), ElementsAre("notes", "soften_test.cpp"));
  EXPECT_EQ(read("soften/soften_test.cpp"), "mine");
  fs::create_symlink("nowhere", path("soften/calm.json"));
  EXPECT_EQ(quell({"new", "graph", "calm", "--folder", "soften"}).code, 2);
  EXPECT_THAT(list("soften"), ElementsAre("calm.json", "notes", "soften_test.cpp"));
  // What is in the way of nothing may be there.
  EXPECT_EQ(quell({"new", "pass", "sharpen", "--folder", "soften"}).code, 0);
  EXPECT_EQ(read("soften/notes"), "mine, too");
}

TEST_F(New, AFailureInTheMiddleLeavesEverythingAsItWas) {
  make_tree();
  write_file("tests/passes", "a file where a folder must be");
  const Outcome outcome = quell({"new", "pass", "soften", "--plugin", "studio"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, StartsWith("error: tests/passes: cannot be written: "));
  EXPECT_THAT(list("passes"), ElementsAre("CMakeLists.txt"));
  EXPECT_EQ(read("passes/CMakeLists.txt"), kPasses);
  EXPECT_EQ(quell({"new", "graph", "calm", "--folder", "CMakeLists.txt/deep"}).code, 1);
  EXPECT_THAT(list(""), ElementsAre("CMakeLists.txt", "passes", "tests"));
}

TEST_F(New, FilesThatHaveTheirNamesAreTakenBackWhenALaterOneFails) {
  fs::create_directory(path("folder"));
  NewFiles files;
  files.add("deep/deeper/first", "1");
  files.add("second", "2");
  files.replace("folder", "a file cannot take a folder's place");
  EXPECT_THROW(files.commit(), Error);
  EXPECT_THAT(list(""), ElementsAre("folder"));
}

TEST_F(New, PassOfTheSourceTreeJoinsAPlugin) {
  make_tree();
  const Outcome outcome = quell({"new", "pass", "soften"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            "written\n"
            "  passes/spatial/soften.cpp\n"
            "  tests/passes/soften_test.cpp\n"
            "  passes/CMakeLists.txt: one line more\n"
            "\n"
            "build it, and test it\n"
            "  cmake --preset release -DQUELL_BUILD_TESTS=ON\n"
            "  cmake --build --preset release --target spatial soften_test\n"
            "  build/release/bin/soften_test\n"
            "\n"
            "let editors know it (a test compares the schema that ships with the passes)\n"
            "  quell schema --plugin-path build/release/lib/quell/passes -o graphs/quell-graph.schema.json\n");
  EXPECT_EQ(read("passes/CMakeLists.txt"),
            "# quell_add_plugin(spatial)\n"
            "quell_add_plugin(spatial)\n"
            "quell_add_pass(spatial blur SOURCES blur_kernel.cpp\n"
            "               LINK hwy::hwy)\n"
            "quell_add_pass(spatial soften)\n"
            "\n"
            "quell_add_plugin(spatial_too)\n"
            "quell_add_pass(spatial_too blot)\n");
}

TEST_F(New, PassOfTheSourceTreeMayMakeAPlugin) {
  make_tree("tree/");
  const Outcome outcome = quell({"new", "pass", "soften", "--folder", "tree", "--plugin", "studio"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("\n  tree/passes/CMakeLists.txt: a new plugin, 'studio'\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  cd tree\n  cmake --preset release "));
  EXPECT_EQ(read("tree/passes/CMakeLists.txt"),
            std::string(kPasses) + "\n\nquell_add_plugin(studio)\nquell_add_pass(studio soften)\n");
  EXPECT_THAT(list("tree/passes/studio"), ElementsAre("soften.cpp"));
  EXPECT_THAT(list("tree/tests/passes"), ElementsAre("soften_test.cpp"));
}

TEST_F(New, PassOfTheSourceTreeNeedsAFreeName) {
  make_tree();
  EXPECT_EQ(quell({"new", "pass", "blot"}).err,
            "error: passes/CMakeLists.txt: there is a pass 'blot' already, in the plugin 'spatial_too'; choose another name\n");
  EXPECT_EQ(quell({"new", "pass", "image"}).err,
            "error: tests/core/CMakeLists.txt: there is a test program 'image_test' already, and the pass's test would be called "
            "so; choose another name\n");
  EXPECT_EQ(read("passes/CMakeLists.txt"), kPasses);
}

TEST_F(New, PassMustNotBeCalledAsAnotherOne) {
  const Outcome outcome = quell({"new", "pass", "joint_bilateral"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, StartsWith("error: there is a pass 'joint_bilateral' already, in "));
  EXPECT_THAT(outcome.err, HasSubstr("spatial.so; choose another name\n"));
  EXPECT_THAT(list(""), IsEmpty());
}

TEST_F(New, GraphRunsAsItIs) {
  const Outcome outcome = quell({"new", "graph", "calm"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(list("calm"), ElementsAre("CMakeLists.txt", "calm.json", "calm_test.cpp"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  quell check calm/calm.json "));
  EXPECT_EQ(quell({"check", "calm/calm.json"}).out, "calm/calm.json: ok: 3 nodes, 4 inputs, 1 output\n");
  const std::string sample = QUELL_SOURCE_DIR "/graphs/sample";
  const Outcome ran = quell({"run", "calm/calm.json", sample, "-o", "out", "--frames", "1-2", "--set", "alpha=0.5", "-q"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(list("out"), ElementsAre("color.0001.exr", "color.0002.exr"));
}

TEST_F(New, GraphOfTheSourceTreeJoinsItsTests) {
  make_tree();
  const Outcome outcome = quell({"new", "graph", "calm"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(list("graphs"), ElementsAre("calm.json"));
  EXPECT_EQ(read("tests/graphs/CMakeLists.txt"),
            "quell_add_test(graphs_test SOURCES calm_test.cpp a_test.cpp LINK quell::testing)\n");
  EXPECT_THAT(read("tests/graphs/calm_test.cpp"), HasSubstr("load_graph(QUELL_SOURCE_DIR \"/graphs\" \"/calm.json\", "));
  EXPECT_THAT(outcome.out, HasSubstr(" -o build/calm "));
  EXPECT_THAT(outcome.out, HasSubstr("\n  build/release/bin/graphs_test --gtest_filter='CalmGraph.*:*/calm'\n"));
}

TEST_F(New, GraphNeedsAFreeNameAndAProgramToJoin) {
  EXPECT_EQ(quell({"new", "graph", "games202"}).err, "error: 'games202' is a graph that ships with quell; choose another name\n");
  make_tree();
  write_file("tests/graphs/CMakeLists.txt", "# quell_add_test(graphs_test SOURCES\n");
  const Outcome outcome = quell({"new", "graph", "calm"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, StartsWith("error: tests/graphs/CMakeLists.txt: the test of a graph joins the program graphs_test, "));
  EXPECT_FALSE(fs::exists(path("graphs")));
}

TEST_F(New, NamesThatCannotBeAreExplained) {
  const std::string rule = ": names have small letters, digits and '_', and start with a letter";
  const std::pair<const char*, std::string> wrong[] = {
      {"Soften-Edges", rule + "; did you mean 'soften_edges'?"},
      {"softenEdges", rule + "; did you mean 'soften_edges'?"},
      {"SVGF", rule + "; did you mean 'svgf'?"},
      {"3x3", rule + "; did you mean 'x3'?"},
      {"../up", rule + "; did you mean 'up'?"},
      {"", rule},
      {"\xc3\xa9", rule},
      {"test", ": quell, CMake or compilers keep this word for themselves; choose another, such as 'my_test'"},
  };
  for (const auto& [name, why] : wrong) {
    const Outcome outcome = quell({"new", "pass", name});
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_THAT(outcome.err, StartsWith("error: '")) << name;
    EXPECT_THAT(outcome.err, HasSubstr("' cannot be the name of a pass" + why + "\n")) << name;
  }
  EXPECT_THAT(quell({"new", "graph", std::string(65, 'a')}).err, HasSubstr("of a graph: it is longer than 64 characters\n"));
  EXPECT_THAT(quell({"new", "pass", "soften", "--plugin", "A"}).err, HasSubstr("'A' cannot be the name of a plugin: "));
  EXPECT_THAT(list(""), IsEmpty());
}

TEST_F(New, WithoutMoreGivesAShortHelp) {
  const Outcome outcome = quell({"new"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("Usage: quell new COMMAND"));
  EXPECT_THAT(outcome.out, HasSubstr("\nCommands:\n  pass "));
}

}  // namespace
}  // namespace quell::app::testing
