#include "quell/graph/plan.h"

#include <algorithm>
#include <set>

#include "quell/graph/plan_buffers.h"
#include "quell/graph/plan_fusion.h"
#include "quell/graph/plan_loops.h"
#include "quell/graph/plan_presence.h"
#include "quell/graph/plan_shapes.h"

namespace quell {
namespace {

using planning::Presence;

std::string offered(const InputShapes& inputs) {
  std::vector<std::string> names;
  for (const auto& [name, shape] : inputs)
    if (shape) names.push_back(name);
  return names.empty() ? "it has nothing" : "it has " + list_names(names, "and");
}

bool is_size(Size size) {
  const auto is_side = [](int side) { return side >= 1 && side <= Image::kMaxSize; };
  return is_side(size.width) && is_side(size.height);
}

// Shapes of all graph inputs. An input that is missing counts as there once that has been told, so that nothing else is.
std::vector<Shape> take_inputs(const Graph& graph, const InputShapes& inputs, Diagnostics& errors) {
  std::vector<Shape> shapes;
  for (const GraphInput& input : graph.inputs) {
    Shape& shape = shapes.emplace_back(Shape{.type = input.type, .present = false});
    const std::string type(name(input.type));
    const auto found = inputs.find(input.name);
    if (found == inputs.end() || !found->second) {
      shape.present = !input.optional;
      if (!input.optional)
        errors.error(input.where, "the graph needs the input '" + input.name + "' of type " + type + " (" +
                                      std::string(info(input.type).doc) + "), which the source does not have; " +
                                      offered(inputs));
      continue;
    }
    const Shape& given = *found->second;
    if (given.type != input.type)
      errors.error(input.where, "the input '" + input.name + "' is of type " + type + ", but the source gives " +
                                    std::string(name(given.type)));
    else if (is_image(given.type) && !is_size(given.size))
      errors.error(input.where, "the source gives '" + input.name + "' the size " + std::to_string(given.size.width) + " x " +
                                    std::to_string(given.size.height) + "; sides from 1 to " + std::to_string(Image::kMaxSize) +
                                    " are possible");
    shape = given;
    shape.type = input.type;
    shape.present = true;
  }
  return shapes;
}

std::vector<Endpoint> find_dumps(const Graph& graph, const std::vector<std::string>& names, const Presence& presence,
                                 Diagnostics& errors) {
  std::set<Endpoint> dumps;
  for (const std::string& name : names) try {
      const Endpoint endpoint = graph.find(name);
      if (presence.has(endpoint))
        dumps.insert(endpoint);
      else
        errors.error({}, "'" + name + "' cannot be dumped: " + presence.why_absent(endpoint));
    } catch (const Error& error) { errors.error({}, error.what()); }
  return {dumps.begin(), dumps.end()};
}

void find_outputs(Plan& plan, const Presence& presence, Diagnostics& errors) {
  const Graph& graph = *plan.graph;
  for (std::size_t i = 0; i < graph.outputs.size(); ++i) {
    const GraphOutput& output = graph.outputs[i];
    if (presence.has(output.from))
      plan.outputs.push_back(static_cast<int>(i));
    else
      errors.error(output.where, "the output '" + output.name + "' cannot be computed: " + presence.why_absent(output.from));
  }
}

void choose_nodes(Plan& plan, const Presence& presence) {
  std::vector<Endpoint> roots = plan.dumps;
  for (const int output : plan.outputs) roots.push_back(plan.graph->outputs[static_cast<std::size_t>(output)].from);
  const std::vector<bool> needed = planning::find_needed(*plan.graph, presence, roots);
  plan.input_used.assign(plan.graph->inputs.size(), false);
  const auto use = [&](const Endpoint& endpoint) {
    if (endpoint.node < 0) plan.input_used[static_cast<std::size_t>(endpoint.port)] = true;
  };
  for (const Endpoint& root : roots) use(root);
  for (std::size_t i = 0; i < needed.size(); ++i) {
    if (!needed[i]) {
      plan.pruned.push_back(static_cast<int>(i));
      continue;
    }
    plan.nodes.emplace_back().node = static_cast<int>(i);
    for (const planning::Read& read : reads(plan.graph->nodes[i], presence)) use(read.from);
  }
}

}  // namespace

Shape Plan::shape(const Endpoint& endpoint) const {
  if (endpoint.node < 0) return inputs[static_cast<std::size_t>(endpoint.port)];
  const auto before = [](const PlannedNode& planned, int node) { return planned.node < node; };
  const auto found = std::lower_bound(nodes.begin(), nodes.end(), endpoint.node, before);
  if (found == nodes.end() || found->node != endpoint.node) return {.type = graph->type(endpoint), .present = false};
  return found->outputs[static_cast<std::size_t>(endpoint.port)][static_cast<std::size_t>(endpoint.item)];
}

std::size_t Plan::bytes(const Endpoint& endpoint) const { return planning::bytes_of(shape(endpoint)); }

bool Plan::is_inner(const Endpoint& endpoint) const { return std::ranges::binary_search(inner, endpoint); }

std::vector<PlannedResult> Plan::results() const {
  std::vector<PlannedResult> all;
  for (const int index : outputs) {
    const GraphOutput& output = graph->outputs[static_cast<std::size_t>(index)];
    all.push_back({output.name, output.from});
  }
  // A graph input may have the name of an output, as `color` often does.
  for (const Endpoint& dump : dumps) all.push_back({(dump.node < 0 ? "input." : "") + graph->describe(dump), dump});
  return all;
}

Plan make_plan(std::shared_ptr<const Graph> graph, const InputShapes& inputs, const std::vector<std::string>& dumps, bool fuse) {
  Plan plan;
  plan.graph = std::move(graph);
  Diagnostics errors;
  plan.inputs = take_inputs(*plan.graph, inputs, errors);
  const Presence presence(*plan.graph, plan.inputs);
  plan.dumps = find_dumps(*plan.graph, dumps, presence, errors);
  find_outputs(plan, presence, errors);
  errors.throw_if_any();
  choose_nodes(plan, presence);
  planning::infer_shapes(plan, presence);
  planning::plan_histories(plan, presence);
  planning::plan_turns(plan, presence, fuse);
  planning::plan_buffers(plan, presence);
  plan.loops = planning::find_loops(plan, presence);
  return plan;
}

}  // namespace quell
