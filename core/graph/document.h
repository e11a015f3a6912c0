// A graph file as it was written: every value with its place, names not yet looked up. Private to this box.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quell/graph/graph.h"
#include "quell/text/json.h"

namespace quell::detail {

inline constexpr int kLongestDelay = 10'000;                       // frames; every one of them is kept in memory
inline constexpr std::size_t kLargestFile = std::size_t{8} << 20;  // bytes, as text; read, it takes a hundred times that

/// A string of the file.
struct Text {
  std::string text;
  Position where;
};

/// What stands on a delayed edge when there is no other frame.
struct WrittenInitial {
  Initial::Kind kind = Initial::Kind::none;
  std::vector<double> constant;
  Text from;  ///< for Kind::endpoint
  Position where;
};

/// A source: `"node.port"`, or an object with a delay.
struct WrittenEdge {
  Text from;
  int delay = 0;
  Position delay_where;
  std::optional<WrittenInitial> initial;  ///< there when delay is not 0
  Position where;
};

/// One member of a node's "in".
struct WrittenPort {
  Text name;
  bool is_list = false;
  bool is_broken = false;  ///< a source in it was not well formed, which was told
  std::vector<WrittenEdge> edges;
  Position value_where;
};

/// One member of a node's "params".
struct WrittenValue {
  Text name;
  Json value;
};

struct WrittenNode {
  Text name;
  std::optional<Text> pass;  ///< of `pass` and `graph` one is there, unless that was told
  std::optional<Text> graph;
  std::optional<std::uint32_t> version;
  Position version_where;
  std::vector<WrittenPort> in;
  std::vector<WrittenValue> params;
  Position params_where;  ///< of "params", or the node's name when it has none
  std::string doc;
};

/// A graph-level parameter.
struct WrittenParam {
  Text name;
  std::optional<Json> value;  ///< "default"
  std::vector<Text> sets;     ///< "node.param"
};

struct WrittenOutput {
  Text name;
  Text from;
};

struct Document {
  SourceTextPtr source;
  std::string name;
  std::string doc;
  std::vector<GraphInput> inputs;
  std::vector<bool> broken_inputs;  ///< for each input: its type is not known, which was told
  std::vector<WrittenParam> params;
  std::vector<WrittenNode> nodes;
  std::vector<WrittenOutput> outputs;
  std::optional<Text> reset;

  /// The folder that relative paths in the file are taken from.
  std::filesystem::path folder() const { return std::filesystem::path(source->name).parent_path(); }
};

/// Reads a text into a document; what is wrong with it goes to `errors`, and the rest is kept so that it can be checked, too.
/// Nothing when it is no JSON object or was written for a newer quell.
std::optional<Document> read_document(const SourceTextPtr& source, Diagnostics& errors);

/// The part of read_document that reads "nodes".
std::vector<WrittenNode> read_nodes(const Json& nodes, Diagnostics& errors);

}  // namespace quell::detail
