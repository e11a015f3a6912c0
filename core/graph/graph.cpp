#include "quell/graph/graph.h"

#include <algorithm>

#include "quell/graph/absent.h"
#include "quell/graph/build.h"
#include "quell/graph/fields.h"
#include "quell/graph/outside.h"
#include "quell/graph/types.h"

namespace quell {
namespace {

// Every name that Graph::find understands; what is written before a '.' or '[' may be looked for in them.
std::vector<std::string> endpoint_names(const Graph& graph) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < graph.inputs.size(); ++i) names.push_back(graph.describe({-1, static_cast<int>(i), 0}));
  for (std::size_t node = 0; node < graph.nodes.size(); ++node)
    for (std::size_t port = 0; port < graph.nodes[node].output_types.size(); ++port)
      for (std::size_t item = 0; item < graph.nodes[node].output_types[port].size(); ++item)
        names.push_back(graph.describe({static_cast<int>(node), static_cast<int>(port), static_cast<int>(item)}));
  for (const GraphOutput& output : graph.subgraph_outputs) names.push_back(output.name);
  return names;
}

const Node& node_of(const Graph& graph, const Endpoint& endpoint) {
  return graph.nodes.at(static_cast<std::size_t>(endpoint.node));
}

}  // namespace

std::string Graph::describe(const Endpoint& endpoint) const {
  if (endpoint.node < 0) return inputs.at(static_cast<std::size_t>(endpoint.port)).name;
  const Node& node = node_of(*this, endpoint);
  const quell_port_desc& output = *QUELL_AT(quell_port_desc, node.pass->outputs, endpoint.port);
  const std::string item = output.flags & QUELL_PORT_ARRAY ? "[" + std::to_string(endpoint.item) + "]" : "";
  return node.name + "." + output.name + item;
}

PortType Graph::type(const Endpoint& endpoint) const {
  const auto port = static_cast<std::size_t>(endpoint.port);
  if (endpoint.node < 0) return inputs.at(port).type;
  return node_of(*this, endpoint).output_types.at(port).at(static_cast<std::size_t>(endpoint.item));
}

Endpoint Graph::find(std::string_view wanted) const {
  for (std::size_t i = 0; i < inputs.size(); ++i)
    if (inputs[i].name == wanted) return {-1, static_cast<int>(i), 0};
  for (std::size_t node = 0; node < nodes.size(); ++node)
    for (std::size_t port = 0; port < nodes[node].output_types.size(); ++port)
      for (std::size_t item = 0; item < nodes[node].output_types[port].size(); ++item) {
        const Endpoint endpoint{static_cast<int>(node), static_cast<int>(port), static_cast<int>(item)};
        if (describe(endpoint) == wanted) return endpoint;
      }
  for (const GraphOutput& output : subgraph_outputs)
    if (output.name == wanted) return output.from;
  const std::vector<std::string> names = endpoint_names(*this);
  const std::string close = did_you_mean(wanted, names);
  throw Error(Fault::usage, "'" + std::string(wanted) + "'",
              "the graph '" + name + "' has nothing of that name" +
                  (close.empty() ? "; expected 'node.port' or an input of the graph" : close));
}

std::shared_ptr<const Graph> parse_graph(const SourceTextPtr& source, const Registry& passes, const GraphOptions& options) {
  Diagnostics errors;
  const std::unique_ptr<detail::Unfolded> unfolded = detail::unfold(source, passes, errors);
  if (!unfolded) errors.throw_if_any();
  detail::Settings settings(*unfolded, errors);
  settings.apply_files();
  for (const detail::Setting& setting : detail::read_outside(options, errors)) settings.apply(setting);
  const detail::Connections connections = detail::connect(*unfolded, errors);
  detail::resolve_types(*unfolded, !errors.empty());
  detail::check_types(*unfolded, connections, errors);
  const std::vector<bool> left_out = detail::leave_out_absent(*unfolded, connections, errors);
  std::shared_ptr<const Graph> graph = detail::build(*unfolded, connections, left_out, errors);
  errors.throw_if_any();
  return graph;
}

std::shared_ptr<const Graph> load_graph(const std::filesystem::path& file, const Registry& passes, const GraphOptions& options) {
  return parse_graph(read_text(file, Fault::usage), passes, options);
}

}  // namespace quell
