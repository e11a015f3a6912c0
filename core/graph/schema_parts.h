// The parts of the JSON Schema of graph files. Private to this box.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "quell/image/port_type.h"
#include "quell/sdk/abi.h"
#include "quell/text/json_write.h"

namespace quell::detail {

// Regular expressions, of the form that JavaScript and Python understand alike.
inline constexpr std::string_view kNamePattern = "^[a-z][a-z0-9_]*$";
/// The name of a graph input, "node.port" or "node.port[1]"; no node is called input.
inline constexpr std::string_view kSourcePattern = "^(?!input\\.)[a-z][a-z0-9_]*(\\.[a-z][a-z0-9_]*(\\[[0-9]+\\])?)?$";
inline constexpr std::string_view kNoZeroPattern = "^[^\\u0000]*$";

inline constexpr const char* kVersionDoc =
    "The version of the pass that the graph was written for. The graph keeps its meaning when the pass changes.";
inline constexpr Types kAllTypes = QUELL_TYPE_BIT(QUELL_TYPE_COUNT) - 1;

/// {"$ref": "#/definitions/NAME"}
Json refer_to(std::string_view definition);
/// A string with a pattern and a description.
Json text_schema(std::string_view pattern, std::string_view description);
/// An object that has no keys but those.
Json closed_object(Json properties);
/// The text as Markdown that shows it as it is.
std::string to_markdown(std::string_view text);

/// Definitions of sources, "node.port" or an object with a delay: one for each set of types and each of optional and required
/// ports that asks for it.
class EdgeSchemas {
 public:
  /// A reference to the definition.
  Json refer(Types types, bool optional);
  /// The definitions that were referred to, by name.
  const std::map<std::string, Json>& definitions() const { return definitions_; }

 private:
  std::map<std::string, Json> definitions_;
};

/// What a node must fulfil that runs the pass: its version, inputs and parameters. Documentation included.
Json pass_schema(const quell_pass_desc& pass, EdgeSchemas& edges);
/// A node as an editor would begin it: the pass, and its required inputs to be filled in.
Json pass_snippet(const quell_pass_desc& pass);

}  // namespace quell::detail
