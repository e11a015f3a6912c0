// A graph that was checked: every name resolved, subgraphs unfolded, parameters complete, passes created. What it cannot know
// yet are the images' sizes; those come with the plan.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "quell/image/port_type.h"
#include "quell/plugin/pass_instance.h"
#include "quell/plugin/registry.h"
#include "quell/text/diagnostic.h"

namespace quell {

/// Something that yields an item: output `port` of a node, or a graph input.
struct Endpoint {
  int node = -1;  ///< index into Graph::nodes; -1 for a graph input
  int port = 0;   ///< index of the node's output, or of the graph's input; below 0 for nothing()
  int item = 0;   ///< element of an output that is an array
  /// Feeds an element of a list whose source, an optional input of a subgraph, is not connected. Such an edge has a delay and no
  /// initial value, so that whoever fetches it finds nothing.
  static Endpoint nothing(PortType type) { return {-1, -1 - static_cast<int>(type), 0}; }
  bool is_nothing() const { return port < 0; }
  bool operator==(const Endpoint&) const = default;
  auto operator<=>(const Endpoint&) const = default;
};

/// What stands on a delayed edge when there is no earlier frame.
struct Initial {
  enum class Kind { none, constant, endpoint } kind = Kind::none;
  std::vector<double> constant;  ///< one value, or one for each plane
  Endpoint endpoint;             ///< of the same frame
};

struct Edge {
  Endpoint from;
  int delay = 0;  ///< frames back; negative (ahead) only from graph inputs
  Initial initial;
  Position where;
};

struct Node {
  std::string name;  ///< qualified by the subgraphs around it: "svgf.atrous0"
  const quell_pass_desc* pass = nullptr;
  std::shared_ptr<const PassInstance> instance;
  std::vector<std::vector<Edge>> inputs;  ///< for each input port of the pass; empty when unconnected
  /// Of type value. Where the first number of one is not 0, the node's edges from earlier frames carry nothing, and those of
  /// later frames do not reach beyond. Empty when it has no such edges. Of the graph, then of the subgraphs that the node is part
  /// of.
  std::vector<Endpoint> resets;
  Position where;
  std::string doc = {};  ///< what the graph's author says of it
};

struct GraphInput {
  std::string name;
  PortType type = QUELL_TYPE_COLOR;
  bool optional = false;
  std::string doc;
  Position where;
};

struct GraphOutput {
  std::string name;
  Endpoint from;
  Position where;
};

/// A parameter of a node.
struct NodeParam {
  int node = 0;             ///< index into Graph::nodes
  std::uint32_t param = 0;  ///< index into the pass's params
};

/// A parameter of the graph itself, and the parameters of nodes that it sets.
struct GraphParam {
  std::string name;
  std::vector<NodeParam> sets;  ///< of nodes that are in the graph
};

struct Graph {
  std::string name;
  std::string doc;
  std::filesystem::path file;
  std::vector<GraphInput> inputs;
  std::vector<Node> nodes;  ///< same-frame edges lead from earlier to later ones; ties in the order of the file
  std::vector<GraphOutput> outputs;
  std::vector<GraphParam> params;
  std::vector<GraphOutput> subgraph_outputs;  ///< other names for some endpoints: "svgf.color"
  std::vector<std::filesystem::path> files;   ///< that it was read from: its own, then those of its subgraphs
  std::vector<std::string> edits;             ///< what GraphOptions changed, left out or replaced, for people; a line each

  /// "filter.color", or "color" for a graph input; "[1]" is added for elements of arrays.
  std::string describe(const Endpoint& endpoint) const;
  /// The type that the endpoint carries ("same as input X" resolved).
  PortType type(const Endpoint& endpoint) const;
  /// Finds "node.port", "node.port[i]" (of a list of one also without the index), "subgraph.output" or a graph input. Throws
  /// Error(usage) with suggestions.
  Endpoint find(std::string_view wanted) const;
};

/// What is changed from outside the file: first the passes, then what is short-circuited; then values, later ones winning: first
/// the files, then the single settings. Nodes of subgraphs have qualified names ("svgf.atrous0.phi_color"); a parameter of the
/// graph itself stands without a node.
struct GraphOptions {
  /// From --set: `node.param=value`, the value as JSON, or plain text. Relative paths are taken from the current folder.
  std::vector<std::string> set;
  /// From --params: JSON files, {"node.param": value} or {"node": {"param": value}}. Relative paths are taken from their folder.
  std::vector<std::filesystem::path> params;
  /// From --swap: `node=pass`. The node keeps the sources that the other pass has an input for, by name, and the parameters that
  /// both have, of equal type, where the value is possible. What is left out is told in Graph::edits. An error where a required
  /// input has no source, or an output that is read has no counterpart.
  std::vector<std::string> swap = {};
  /// From --bypass: `node`. Who reads an output of the node reads the input that it is the same as instead, or else the one of
  /// equal type, one of equal name first. The node stays in the graph, and is not run when nobody reads it.
  std::vector<std::string> bypass = {};
};

/// Reads and checks a graph file. Throws one Error(usage) that tells every mistake found, with place and suggestion.
std::shared_ptr<const Graph> load_graph(const std::filesystem::path& file, const Registry& passes,
                                        const GraphOptions& options = {});
/// The same for a text in memory; `source->name` stands in messages, and relative paths are taken from its folder.
std::shared_ptr<const Graph> parse_graph(const SourceTextPtr& source, const Registry& passes, const GraphOptions& options = {});

}  // namespace quell
