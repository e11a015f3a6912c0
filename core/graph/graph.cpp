#include "quell/graph/graph.h"

#include <algorithm>

#include "quell/graph/absent.h"
#include "quell/graph/build.h"
#include "quell/graph/edits.h"
#include "quell/graph/follow_type.h"
#include "quell/graph/outside.h"
#include "quell/graph/settings.h"
#include "quell/graph/types.h"

namespace quell {
namespace {

const Node& node_at(const Graph& graph, int node) { return graph.nodes.at(static_cast<std::size_t>(node)); }

class NodeView final : public detail::FollowedGraph {
 public:
  explicit NodeView(const Graph& graph) : graph_(graph) {}
  PortType input_type(int input) const override {
    if (input < 0) return static_cast<PortType>(-1 - input);  // Endpoint::nothing
    return graph_.inputs.at(static_cast<std::size_t>(input)).type;
  }
  const quell_pass_desc* pass(int node) const override { return node_at(graph_, node).pass; }
  detail::FollowedSource source(int node, int input, int item) const override {
    const std::vector<Edge>& edges = node_at(graph_, node).inputs.at(static_cast<std::size_t>(input));
    return {static_cast<std::size_t>(item) < edges.size() ? &edges[static_cast<std::size_t>(item)] : nullptr, {}, false};
  }

 private:
  const Graph& graph_;
};

// Everything that an edge may come from.
std::vector<Endpoint> endpoints(const Graph& graph) {
  std::vector<Endpoint> result;
  for (int input = 0; input < static_cast<int>(graph.inputs.size()); ++input) result.push_back({-1, input, 0});
  for (int index = 0; index < static_cast<int>(graph.nodes.size()); ++index) {
    const Node& node = node_at(graph, index);
    for (int port = 0; port < static_cast<int>(node.pass->output_count); ++port) {
      const quell_port_desc& output = *QUELL_AT(quell_port_desc, node.pass->outputs, port);
      const bool is_array = output.flags & QUELL_PORT_ARRAY;
      const int items = is_array ? static_cast<int>(node.inputs.at(static_cast<std::size_t>(output.same_as)).size()) : 1;
      for (int item = 0; item < items; ++item) result.push_back({index, port, item});
    }
  }
  return result;
}

GraphParam describe_param(const std::string& name, const std::vector<detail::Settings::Slot>& slots, const Graph& graph) {
  GraphParam param{name, {}};
  for (const detail::Settings::Slot& slot : slots) {
    const auto node = std::ranges::find(graph.nodes, slot.leaf->name, &Node::name);
    if (node != graph.nodes.end()) param.sets.push_back({static_cast<int>(node - graph.nodes.begin()), slot.param});
  }
  return param;
}

}  // namespace

std::string Graph::describe(const Endpoint& endpoint) const {
  if (endpoint.is_nothing()) return "nothing";
  if (endpoint.node < 0) return inputs.at(static_cast<std::size_t>(endpoint.port)).name;
  const Node& node = node_at(*this, endpoint.node);
  const quell_port_desc& output = *QUELL_AT(quell_port_desc, node.pass->outputs, endpoint.port);
  const std::string item = output.flags & QUELL_PORT_ARRAY ? "[" + std::to_string(endpoint.item) + "]" : "";
  return node.name + "." + output.name + item;
}

PortType Graph::type(const Endpoint& endpoint) const {
  return detail::follow_type(NodeView(*this), endpoint).value();  // nothing is broken in a graph that was checked
}

Endpoint Graph::find(std::string_view wanted) const {
  std::vector<std::string> names;
  std::vector<Endpoint> items;  // of the list that is called like that
  for (const Endpoint& endpoint : endpoints(*this)) {
    names.push_back(describe(endpoint));
    if (names.back() == wanted) return endpoint;
    if (std::string_view(names.back()).substr(0, names.back().find('[')) == wanted) items.push_back(endpoint);
  }
  if (items.size() == 1) return items[0];
  for (const GraphOutput& output : subgraph_outputs) {
    names.push_back(output.name);
    if (names.back() == wanted) return output.from;
  }
  const std::string close = did_you_mean(wanted, names);
  throw Error(Fault::usage, "'" + std::string(wanted) + "'",
              "the graph '" + name + "' has nothing of that name" +
                  (close.empty() ? "; expected 'node.port' or an input of the graph" : close));
}

std::shared_ptr<const Graph> parse_graph(const SourceTextPtr& source, const Registry& passes, const GraphOptions& options) {
  Diagnostics errors;
  const std::unique_ptr<detail::Unfolded> unfolded = detail::unfold(source, passes, errors);
  if (!unfolded) errors.throw_if_any();
  detail::Edits edits(*unfolded, passes, errors);
  edits.apply(options);
  detail::Settings settings(*unfolded, errors);
  settings.apply_files();
  for (const detail::Setting& setting : detail::read_outside(options, errors)) settings.apply(setting);
  const detail::Connections connections = detail::connect(*unfolded, errors);
  detail::check_types(*unfolded, connections, errors);
  const std::vector<bool> left_out = detail::leave_out_absent(*unfolded, connections, errors);
  const std::shared_ptr<Graph> graph = detail::build(*unfolded, connections, left_out, errors);
  edits.throw_if_any();
  for (const detail::WrittenParam& param : unfolded->root.document->params)
    graph->params.push_back(describe_param(param.name.text, settings.set_by(param), *graph));
  graph->edits = edits.describe();
  for (const auto& [file, document] : unfolded->documents)
    if (document) graph->files.push_back(document->source->name);
  std::ranges::stable_partition(graph->files, [&](const std::filesystem::path& file) { return file == graph->file; });
  return graph;
}

std::shared_ptr<const Graph> load_graph(const std::filesystem::path& file, const Registry& passes, const GraphOptions& options) {
  return parse_graph(read_text(file, Fault::usage, detail::kLargestFile), passes, options);
}

}  // namespace quell
