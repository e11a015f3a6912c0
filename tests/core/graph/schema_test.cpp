// The JSON Schema of graph files, asked through a validator that is not quell's own: it accepts all that the loader accepts, and
// refuses what a schema can refuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "quell/graph/graph.h"
#include "quell/graph/schema.h"
#include "tests/core/graph/schema_validator.h"
#include "tests/core/graph/schema_variants.h"
#include "tests/core/graph/test_passes.h"

namespace quell::test {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(QUELL_SOURCE_DIR) / "tests/core/graph";

std::map<std::string, std::string> read_graphs(const fs::path& folder) {
  std::map<std::string, std::string> graphs;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".json") graphs[entry.path().stem().string()] = read_cleaned(entry.path());
  return graphs;
}

// What no schema can know, with the reason. A new wrong graph is refused by the schema, or has its place here.
const std::map<std::string, std::string> kBeyondASchema = {
    {"cycle_is_the_shortest", "cycles"},
    {"cycle_of_one", "cycles"},
    {"delay_ahead_of_node", "whether a source is an input of the graph is said elsewhere"},
    {"duplicate_keys", "parsers keep one of two members"},
    {"graph_param_sets_twice", "what is set twice is said in two places"},
    {"initial_closes_a_cycle", "cycles"},
    {"initial_constant_of_two", "the port takes types of two planes, too; which one the source has is said elsewhere"},
    {"initial_from_unknown", "whether a source exists"},
    {"initial_of_another_type", "types of sources"},
    {"node_named_as_input", "names in two places"},
    {"param_refused_by_pass", "what a pass thinks of its parameters together"},
    {"params_file", "another file"},
    {"reset_depends_on_history", "what depends on what"},
    {"reset_of_another_type", "types of sources"},
    {"reset_reads_history", "what depends on what"},
    {"reset_unknown", "whether a source exists"},
    {"set_from_outside", "the command line"},
    {"sources_unknown", "whether a source exists"},
    {"subgraph_absent_input", "another file"},
    {"subgraph_delays_too_long", "another file"},
    {"subgraph_delays_twice", "another file"},
    {"subgraph_includes_itself", "another file"},
    {"subgraph_missing", "another file"},
    {"subgraph_none_where_required", "another file"},
    {"subgraph_output_is_delayed", "another file"},
    {"subgraph_reset_is_delayed", "another file"},
    {"subgraph_set", "the command line"},
    {"subgraph_through_itself", "another file"},
    {"subgraph_types", "another file"},
    {"subgraph_with_errors", "another file"},
    {"type_follows_history", "types of sources"},
    {"type_in_list", "types of sources"},
    {"types_do_not_fit", "types of sources"},
};

TEST(Schema, OfTheSamePassesIsTheSameText) {
  EXPECT_EQ(graph_schema(passes()), graph_schema(passes()));
  EXPECT_THAT(graph_schema(passes()), testing::StartsWith(std::string(kSchemaBeginning)));
  EXPECT_THAT(graph_schema(Registry()), testing::StartsWith(std::string(kSchemaBeginning)));
}

TEST(Schema, AcceptsGraphsThatAreRight) {
  std::map<std::string, std::string> graphs = read_graphs(kFolder / "good");
  graphs.merge(read_graphs(kFolder / "good/parts"));
  ASSERT_GE(graphs.size(), 8u);
  for (const auto& [name, verdict] : validate(graph_schema(passes()), graphs))
    EXPECT_TRUE(verdict.accepted()) << name << ": " << testing::PrintToString(verdict.errors);
}

TEST(Schema, RefusesGraphsThatAreWrongAsFarAsOneCanTellFromTheirForm) {
  const auto verdicts = validate(graph_schema(passes()), read_graphs(kFolder / "wrong"));
  for (const auto& [name, verdict] : verdicts) {
    EXPECT_TRUE(verdict.is_json || name.starts_with("syntax_")) << name;
    if (kBeyondASchema.contains(name))
      EXPECT_TRUE(verdict.errors.empty()) << name << " is refused, so it needs no reason here: "
                                          << testing::PrintToString(verdict.errors);
    else
      EXPECT_FALSE(verdict.accepted()) << name << " is accepted: can a schema know? Then it should; else give the reason here";
  }
  for (const auto& [name, reason] : kBeyondASchema) EXPECT_TRUE(verdicts.contains(name)) << "there is no wrong graph " << name;
}

// Where one file has several mistakes, each is found.
TEST(Schema, FindsEachOfSeveralMistakes) {
  const auto verdicts = validate(graph_schema(passes()), read_graphs(kFolder / "wrong"));
  EXPECT_EQ(verdicts.at("param_of_wrong_type").errors.size(), 7u);
  EXPECT_EQ(verdicts.at("param_out_of_range").errors.size(), 5u);
  EXPECT_EQ(verdicts.at("keys_of_wrong_kind").errors.size(), 6u);
  EXPECT_EQ(verdicts.at("required_inputs_missing").errors.size(), 2u);
}

// Whether a pass accepts its parameters together is the pass's own matter, which no schema knows.
std::string load(const std::string& text) {
  try {
    parse_graph(std::make_shared<SourceText>(SourceText{"graph.json", text}), passes());
    return {};
  } catch (const Error& error) { return error.what(); }
}

TEST(Schema, AgreesWithTheLoaderOnEveryPassPortAndParameter) {
  const std::vector<Variant> variants = make_variants(passes());
  ASSERT_GE(variants.size(), 300u);
  std::map<std::string, std::string> graphs;
  for (const Variant& variant : variants) graphs[variant.name] = variant.text;
  ASSERT_EQ(graphs.size(), variants.size()) << "two variants have one name";
  const auto verdicts = validate(graph_schema(passes()), graphs);
  for (const Variant& variant : variants) {
    const Verdict& verdict = verdicts.at(variant.name);
    EXPECT_EQ(verdict.accepted(), variant.is_right) << variant.name << "\n"
                                                    << variant.text << "\n"
                                                    << testing::PrintToString(verdict.errors);
    EXPECT_EQ(load(variant.text).empty(), variant.is_right) << variant.name << "\n" << variant.text << "\n" << load(variant.text);
  }
}

TEST(Schema, KnowsWhichVersionsHadAFormerName) {
  const auto with = [](const std::string& node) {
    return R"({ "quell": 1, "inputs": { "color": "color", "normal": "normal" }, "nodes": { "a": { "pass": "filter", "in": {
      "color": "color", "normal": "normal" }, )" +
           node + R"( } }, "outputs": { "color": "a.color" } })";
  };
  const auto verdicts = validate(graph_schema(passes()), {
                                                             {"former", with(R"("version": 2, "params": { "strength": 1 })")},
                                                             {"today", with(R"("version": 2, "params": { "sigma": 1 })")},
                                                             {"later", with(R"("version": 3, "params": { "strength": 1 })")},
                                                             {"none", with(R"("params": { "strength": 1 })")},
                                                             {"range", with(R"("version": 2, "params": { "strength": 101 })")},
                                                         });
  EXPECT_TRUE(verdicts.at("former").accepted());
  EXPECT_TRUE(verdicts.at("today").accepted());
  for (const char* wrong : {"later", "none", "range"}) EXPECT_FALSE(verdicts.at(wrong).accepted()) << wrong;
}

// A delay of 0 is no delay: its initial value is not used, whatever the port.
TEST(Schema, LetsAnEdgeWithoutADelayHaveAnyInitialValueThatIsWellFormed) {
  const auto with = [](const std::string& initial) {
    return R"({ "quell": 1, "inputs": { "color": "color" }, "nodes": { "a": { "pass": "copy", "in": {
      "image": { "from": "color", "delay": 0, "initial": )" +
           initial + R"( } } } }, "outputs": { "color": "a.image" } })";
  };
  const std::map<std::string, std::string> graphs{
      {"none", with("\"none\"")}, {"zero", with("\"zero\"")}, {"empty", with(R"({ "constant": [] })")}};
  const auto verdicts = validate(graph_schema(passes()), graphs);
  for (const auto& [name, text] : graphs) EXPECT_EQ(verdicts.at(name).accepted(), load(text).empty()) << name << load(text);
  EXPECT_TRUE(verdicts.at("none").accepted());
}

}  // namespace
}  // namespace quell::test
