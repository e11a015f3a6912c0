// Refusals that no file alone can show: what depends on the machine, and texts that are broken at random.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "quell/graph/graph.h"
#include "quell/sdk/pass.h"
#include "tests/core/graph/test_passes.h"

namespace quell {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kFolder = fs::path(QUELL_SOURCE_DIR) / "tests/core/graph";

std::string refusal(const std::string& text, const Registry& passes) {
  try {
    parse_graph(std::make_shared<SourceText>(SourceText{"graph.json", text}), passes);
  } catch (const Error& error) { return error.what(); }
  return "accepted";
}

TEST(Refusal, OfAFileThatIsMissingNamesIt) {
  try {
    load_graph("nowhere/graph.json", test::passes());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::usage);
    EXPECT_STREQ(error.what(), "nowhere/graph.json: cannot be opened: No such file or directory");
  }
}

TEST(Refusal, OfAnUnknownPassTellsOnceWhereItWasLookedForAndWhatDidNotLoad) {
  const fs::path folder = fs::path(testing::TempDir()) / "quell_refusal_test";
  fs::create_directories(folder);
  std::ofstream(folder / "broken.so") << "this is no plugin";
  Registry registry;
  registry.load_folder(folder);
  const std::string text = refusal(R"({ "quell": 1, "nodes": { "a": { "pass": "filter" }, "b": { "pass": "other" } },
    "outputs": { "color": "a.color" } })",
                                   registry);
  const std::string note = "note: plugins were looked for in '" + folder.string() + "'\nnote: the plugin " +
                           (folder / "broken.so").string() + " was not loaded: ";
  EXPECT_THAT(text, HasSubstr("error: unknown pass 'filter'; 'quell passes' lists those that are there"));
  EXPECT_THAT(text, HasSubstr(note));
  EXPECT_EQ(text.find(note), text.rfind(note));
}

TEST(Refusal, OfFilesThatIncludeEachOtherWithoutEndComesSoon) {
  const fs::path folder = fs::path(testing::TempDir()) / "quell_refusal_test";
  fs::create_directories(folder);
  // Each file includes the next ten times: 10^9 nodes.
  for (int i = 0; i < 10; ++i) {
    std::ofstream file(folder / ("level" + std::to_string(i) + ".json"));
    file << R"({ "quell": 1, "inputs": { "image": "color" }, "nodes": {)";
    for (int k = 0; k < 10; ++k) {
      const std::string what = i == 9 ? R"("pass": "copy")" : "\"graph\": \"level" + std::to_string(i + 1) + ".json\"";
      file << (k ? "," : "") << "\"n" << k << "\": { " << what << R"(, "in": { "image": "image" } })";
    }
    file << R"(}, "outputs": { "image": "n0.image" } })";
  }
  try {
    load_graph(folder / "level0.json", test::passes());
    FAIL();
  } catch (const Error& error) { EXPECT_THAT(error.what(), HasSubstr("the graph has more than 10000 nodes")); }
}

// A folder of its own with files that are graphs of one or several nodes; `nodes` and `outputs` are their JSON members.
class GraphFolder {
 public:
  explicit GraphFolder(const std::string& name) : folder_(fs::path(testing::TempDir()) / name) {
    fs::create_directories(folder_);
  }
  void add(const std::string& name, const std::string& nodes, const std::string& outputs, const std::string& params = "") const {
    std::ofstream(folder_ / name) << R"({ "quell": 1, "inputs": { "image": "color" }, "params": {)" << params
                                  << R"(}, "nodes": {)" << nodes << R"(}, "outputs": {)" << outputs << "} }";
  }
  std::string load(const std::string& name) const {
    try {
      load_graph(folder_ / name, test::passes());
    } catch (const Error& error) { return error.what(); }
    return "accepted";
  }

 private:
  fs::path folder_;
};

std::string level(int i) { return "level" + std::to_string(i) + ".json"; }

TEST(Refusal, OfGraphsNestedTooDeeplyComesBeforeTheStackEnds) {
  const GraphFolder folder("quell_nested");
  for (int i = 0; i < 60; ++i)
    folder.add(level(i), R"("n": { "graph": ")" + level(i + 1) + R"(", "in": { "image": "image" } })", R"("o": "n.o")");
  folder.add(level(60), R"("n": { "pass": "copy", "in": { "image": "image" } })", R"("o": "n.image")");
  EXPECT_THAT(folder.load(level(0)), HasSubstr("graphs are nested more than 50 deep"));
  EXPECT_EQ(folder.load(level(10)), "accepted");  // 50 below it
}

TEST(Refusal, OfLongChainsOfSubgraphsThatOnlyHandOnComesBeforeTheStackEnds) {
  const GraphFolder folder("quell_chain");
  folder.add("pass_on.json", R"("unused": { "pass": "copy", "in": { "image": "image" } })", R"("o": "image")");
  // The last one first: it leads through all others before any of them is known.
  const auto chain = [&](int length) {
    std::string nodes;
    for (int i = length - 1; i > 0; --i)
      nodes += "\"n" + std::to_string(i) + R"(": { "graph": "pass_on.json", "in": { "image": "n)" + std::to_string(i - 1) +
               ".o\" } },\n";
    nodes += R"("n0": { "graph": "pass_on.json", "in": { "image": "image" } })";
    folder.add("chain.json", nodes, "\"o\": \"n" + std::to_string(length - 1) + ".o\"");
    return folder.load("chain.json");
  };
  EXPECT_EQ(chain(150), "accepted");
  EXPECT_THAT(chain(4000), HasSubstr("leads through more than 200 outputs of subgraphs"));
}

// Each subgraph asks for what the one before hands on twice, as the source and as its initial value: 2^40 ways.
TEST(Refusal, OfInitialValuesThatForkAtEverySubgraphComesSoon) {
  const GraphFolder folder("quell_forks");
  folder.add("pass_on.json", R"("unused": { "pass": "copy", "in": { "image": "image" } })", R"("o": "image")");
  std::string nodes = R"("n0": { "graph": "pass_on.json", "in": { "image": "image" } })";
  for (int i = 1; i < 40; ++i) {
    const std::string before = "\"n" + std::to_string(i - 1) + ".o\"";
    nodes += ",\n\"n" + std::to_string(i) + R"(": { "graph": "pass_on.json", "in": { "image": { "from": )" + before +
             R"(, "delay": 1, "initial": { "from": )" + before + " } } } }";
  }
  folder.add("forks.json", nodes, R"("o": "n39.o")");
  EXPECT_THAT(folder.load("forks.json"), HasSubstr("an initial value must be of the same frame; 'n1.o' is delayed"));
}

// Each graph's two parameters set both of the next: 2^40 ways to the one at the end, which is set once.
TEST(Refusal, OfParametersThatForkAtEverySubgraphIsNotNeeded) {
  const GraphFolder folder("quell_params");
  for (int i = 0; i < 40; ++i)
    folder.add(level(i), R"("n": { "graph": ")" + level(i + 1) + R"(", "in": { "image": "image" } })", R"("o": "n.o")",
               R"("a": { "sets": ["n.a", "n.b"] }, "b": { "sets": ["n.a", "n.b"] })");
  folder.add(level(40), R"("n": { "pass": "blend", "in": { "color": "image" } })", R"("o": "n.color")",
             R"("a": { "sets": ["n.alpha"] }, "b": { "sets": ["n.alpha"] })");
  EXPECT_EQ(folder.load(level(0)), "accepted");
}

// Every text is either a graph or refused with an Error, whatever was typed.
TEST(Refusal, OfTextsBrokenAtRandomIsOrderly) {
  fs::current_path(kFolder / "good");
  std::mt19937 random(3);
  const std::string characters = "{}[]\",:.0129-eE x\n\t/*\\_\x80\xC3";
  int refused = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(".")) {
    if (entry.path().extension() != ".json") continue;
    std::ostringstream stream;
    stream << std::ifstream(entry.path()).rdbuf();
    const std::string good = stream.str();
    for (int round = 0; round < 300; ++round) {
      std::string text = good;
      for (int change = 0; change <= round % 3; ++change) {
        const std::size_t at = random() % text.size();
        const char c = characters[random() % characters.size()];
        switch (random() % 4) {
          case 0:
            text[at] = c;
            break;
          case 1:
            text.insert(at, 1, c);
            break;
          case 2:
            text.erase(at, 1 + random() % 8);
            break;
          default:
            text.insert(at, text.substr(random() % text.size(), random() % 40));
        }
      }
      const std::string message = refusal(text, test::passes());
      if (message != "accepted") ++refused;
      EXPECT_FALSE(message.empty());
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace quell
