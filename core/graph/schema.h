// What a graph file may hold, as a JSON Schema (draft-07), from which editors complete, check and explain.
#pragma once

#include <string>
#include <string_view>

#include "quell/plugin/registry.h"

namespace quell {

/// The name under which graphs find the schema: "$schema": "quell-graph.schema.json", from their folder.
inline constexpr std::string_view kSchemaFileName = "quell-graph.schema.json";
/// What the schema's text begins with, whatever the passes.
inline constexpr std::string_view kSchemaBeginning =
    "{\n  \"$schema\": \"http://json-schema.org/draft-07/schema#\",\n  \"$id\": \"quell-graph";

/// The schema of graphs that use these passes. It accepts every graph that load_graph accepts, and refuses what can be known
/// to be wrong from the form alone: keys, names, types, ranges, required inputs; not what depends on other places in the file
/// (that a source exists, that types agree, cycles) or on other files. The same passes always give the same text.
std::string graph_schema(const Registry& passes);

}  // namespace quell
