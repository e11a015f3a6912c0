// A graph in short, for tests.
#pragma once

#include <string>
#include <vector>

#include "quell/graph/graph.h"

namespace quell::test {

/// Names of the nodes, in their order.
inline std::vector<std::string> names(const Graph& graph) {
  std::vector<std::string> result;
  for (const Node& node : graph.nodes) result.push_back(node.name);
  return result;
}

inline const Node& node(const Graph& graph, std::string_view name) {
  for (const Node& candidate : graph.nodes)
    if (candidate.name == name) return candidate;
  throw std::logic_error("the test asks for a node '" + std::string(name) + "' that is not there");
}

/// "color", "color@2 none", "color@1 [0, 0.5]" or "color@1 first.image".
inline std::string describe(const Graph& graph, const Edge& edge) {
  std::string text = graph.describe(edge.from);
  if (edge.delay == 0) return text;
  text += "@" + std::to_string(edge.delay) + " ";
  if (edge.initial.kind == Initial::Kind::none) return text + "none";
  if (edge.initial.kind == Initial::Kind::endpoint) return text + graph.describe(edge.initial.endpoint);
  std::string list;
  for (const double value : edge.initial.constant) {
    std::string number = std::to_string(value);
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.') number.pop_back();
    list += (list.empty() ? "" : ", ") + number;
  }
  return text + "[" + list + "]";
}

/// What feeds an input of a node, one entry a source.
inline std::vector<std::string> sources(const Graph& graph, std::string_view name, std::string_view input) {
  const Node& of = node(graph, name);
  std::vector<std::string> result;
  for (std::uint32_t i = 0; i < of.pass->input_count; ++i)
    if (QUELL_AT(quell_port_desc, of.pass->inputs, i)->name == input)
      for (const Edge& edge : of.inputs[i]) result.push_back(describe(graph, edge));
  return result;
}

/// A parameter as JSON.
inline std::string param(const Graph& graph, std::string_view name, std::string_view of_name) {
  const Node& of = node(graph, name);
  for (std::uint32_t i = 0; i < of.pass->param_count; ++i) {
    const quell_param_desc& desc = *QUELL_AT(quell_param_desc, of.pass->params, i);
    if (desc.name == of_name) return to_json(desc, of.instance->values()[i]);
  }
  throw std::logic_error("the test asks for a parameter '" + std::string(of_name) + "' that is not there");
}

}  // namespace quell::test
