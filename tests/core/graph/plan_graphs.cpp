#include "tests/core/graph/plan_graphs.h"

namespace quell::test {

Endpoint Builder::endpoint(const std::string& name) const {
  const std::size_t dot = name.find('.');
  if (dot == std::string::npos) {
    for (std::size_t i = 0; i < graph_->inputs.size(); ++i)
      if (graph_->inputs[i].name == name) return {-1, static_cast<int>(i), 0};
    throw std::logic_error("the test names no input " + name);
  }
  const std::size_t bracket = name.find('[');
  const std::string port = name.substr(dot + 1, bracket == std::string::npos ? bracket : bracket - dot - 1);
  for (std::size_t n = 0; n < graph_->nodes.size(); ++n) {
    const Node& node = graph_->nodes[n];
    for (std::uint32_t p = 0; node.name == name.substr(0, dot) && p < node.pass->output_count; ++p)
      if (port == QUELL_AT(quell_port_desc, node.pass->outputs, p)->name)
        return {static_cast<int>(n), static_cast<int>(p), bracket == std::string::npos ? 0 : std::stoi(name.substr(bracket + 1))};
  }
  throw std::logic_error("the test names no output " + name);
}

std::shared_ptr<const PassInstance> Builder::make_instance(const quell_pass_desc& pass,
                                                           const std::map<std::string, std::int64_t>& params) {
  std::vector<ParamValue> values;
  for (std::uint32_t i = 0; i < pass.param_count; ++i) {
    const quell_param_desc& param = *QUELL_AT(quell_param_desc, pass.params, i);
    values.push_back(default_value(param));
    const auto given = params.find(param.name);
    if (given == params.end()) continue;
    if (param.type == QUELL_PARAM_BOOL)
      values.back().elements = std::vector<std::uint8_t>{given->second != 0};
    else
      values.back().elements = std::vector<std::int64_t>{given->second};
  }
  return std::make_shared<const PassInstance>(pass, std::move(values));
}

void Builder::connect(Node& node, const Wires& wires) {
  for (std::uint32_t p = 0; p < node.pass->input_count; ++p) {
    const std::string port = QUELL_AT(quell_port_desc, node.pass->inputs, p)->name;
    std::vector<Edge>& edges = node.inputs.emplace_back();
    const auto found = wires.find(port);
    if (found == wires.end()) continue;
    for (const Wire& wire : found->second) edges.push_back(edge(wire, node.name + "." + port + " <- " + wire.from));
  }
}

Edge Builder::edge(const Wire& wire, const std::string& line) {
  Edge edge{endpoint(wire.from), wire.delay, {}, place(line)};
  if (wire.initial.starts_with('='))
    edge.initial = {Initial::Kind::constant, {std::stod(wire.initial.substr(1))}, {}};
  else if (!wire.initial.empty())
    edge.initial = {Initial::Kind::endpoint, {}, endpoint(wire.initial)};
  return edge;
}

std::vector<std::string> running(const Plan& plan) {
  std::vector<std::string> names;
  for (const PlannedNode& node : plan.nodes) names.push_back(plan.graph->nodes[static_cast<std::size_t>(node.node)].name);
  return names;
}

const PlannedNode& planned(const Plan& plan, const std::string& name) {
  for (const PlannedNode& node : plan.nodes)
    if (plan.graph->nodes[static_cast<std::size_t>(node.node)].name == name) return node;
  throw std::logic_error(name + " does not run");
}

std::string error_of(const std::shared_ptr<const Graph>& graph, const InputShapes& inputs, const std::vector<std::string>& dumps,
                     Fault fault) {
  try {
    make_plan(graph, inputs, dumps);
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), fault) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "planning succeeded";
  return "";
}

}  // namespace quell::test
