// The schema of the graphs that ship, made from the passes that ship.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "quell/graph/graph.h"
#include "quell/graph/schema.h"
#include "tests/core/graph/schema_validator.h"
#include "tests/core/graph/schema_variants.h"

namespace quell::test {
namespace {

const Registry& built_in_passes() {
  static const Registry registry = load_plugins();
  return registry;
}

TEST(ShippedSchema, AcceptsEveryShippedGraphAndEachNamesIt) {
  std::map<std::string, std::string> graphs;
  for (const auto& entry : std::filesystem::directory_iterator(QUELL_SOURCE_DIR "/graphs"))
    if (entry.path().extension() == ".json" && entry.path().filename() != kSchemaFileName)
      graphs[entry.path().stem().string()] = read_cleaned(entry.path());
  ASSERT_FALSE(graphs.empty());
  for (const auto& [name, verdict] : validate(graph_schema(built_in_passes()), graphs)) {
    EXPECT_TRUE(verdict.accepted()) << name << ": " << testing::PrintToString(verdict.errors);
    EXPECT_THAT(graphs.at(name), testing::HasSubstr("\"$schema\": \"quell-graph.schema.json\"")) << name;
  }
}

// Values at their bounds may be more than a pass can do (the largest float as a radius); that is for the pass to tell, not for
// the schema.
TEST(ShippedSchema, KnowsEveryPassPortAndParameter) {
  const std::vector<Variant> variants = make_variants(built_in_passes());
  ASSERT_GE(variants.size(), 100u);
  std::map<std::string, std::string> graphs;
  for (const Variant& variant : variants) graphs[variant.name] = variant.text;
  const auto verdicts = validate(graph_schema(built_in_passes()), graphs);
  for (const Variant& variant : variants) {
    const Verdict& verdict = verdicts.at(variant.name);
    EXPECT_EQ(verdict.accepted(), variant.is_right) << variant.name << "\n"
                                                    << variant.text << "\n"
                                                    << testing::PrintToString(verdict.errors);
  }
}

}  // namespace
}  // namespace quell::test
