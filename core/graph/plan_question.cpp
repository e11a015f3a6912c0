#include "quell/graph/plan_question.h"

#include <algorithm>

#include "quell/graph/plan_ports.h"

namespace quell::planning {
namespace {

// Shapes in the arrays of the C interface.
class RawShapes {
 public:
  explicit RawShapes(const PortShapes& ports) {
    items_.reserve(ports.size());  // the ports point into it
    for (const std::vector<Shape>& port : ports) {
      std::vector<quell_shape>& items = items_.emplace_back();
      for (const Shape& shape : port)
        items.push_back({sizeof(quell_shape), static_cast<std::uint32_t>(shape.type), shape.size.width, shape.size.height,
                         shape.value_count, shape.present ? 1u : 0u});
      ports_.push_back({sizeof(quell_port_shape), static_cast<std::uint32_t>(items.size()), items.data()});
    }
  }
  quell_port_shape* data() { return ports_.data(); }
  std::uint32_t count() const { return static_cast<std::uint32_t>(ports_.size()); }
  PortShapes shapes() const {
    PortShapes result;
    for (const std::vector<quell_shape>& items : items_) {
      std::vector<Shape>& port = result.emplace_back();
      for (const quell_shape& item : items)
        port.push_back({static_cast<PortType>(item.type), {item.width, item.height}, item.value_count, item.present != 0});
    }
    return result;
  }

 private:
  std::vector<std::vector<quell_shape>> items_;
  std::vector<quell_port_shape> ports_;
};

// What is wrong with writing an output over an input, or nothing. Whether each exists and has radius 0 was checked before.
std::string fault_in_place(const Node& node, std::size_t output, const PortShapes& inputs, const PlannedNode& answer) {
  const auto input = static_cast<std::size_t>(answer.in_place_of[output]);
  if (is_array(input_port(node, input)) != is_array(output_port(node, output)))
    return "one of them is an array and the other is not";
  if (std::count(answer.in_place_of.begin(), answer.in_place_of.end(), answer.in_place_of[output]) > 1)
    return "another output takes the same place";
  const std::vector<Shape>& from = inputs[input];
  const std::vector<Shape>& to = answer.outputs[output];
  if (from.empty()) return {};  // an optional input that is not connected
  if (from.size() != to.size()) return "they have different numbers of items";
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (!is_image(from[i].type) || !is_image(to[i].type)) return "only images have a place to take";
    if (from[i].present && to[i].present &&
        Image::bytes_needed(from[i].type, from[i].size) != Image::bytes_needed(to[i].type, to[i].size))
      return "they differ in size";
  }
  return {};
}

// What PassInstance::infer cannot know, or leaves to the plan.
void check_answer(const Node& node, const PortShapes& inputs, const PortShapes& outputs, const PlannedNode& answer) {
  const auto refuse = [&](const std::string& what) {
    throw Error(Fault::plugin, "pass '" + std::string(node.pass->id) + "'", "infer breaks the plugin interface: " + what);
  };
  for (std::size_t port = 0; port < answer.outputs.size(); ++port) {
    const quell_port_desc& desc = output_port(node, port);
    for (std::size_t i = 0; i < answer.outputs[port].size(); ++i) {
      const Shape& shape = answer.outputs[port][i];
      const std::string name = "output '" + item_name(desc, i) + "'";
      if (shape.type != outputs[port][i].type) refuse(name + " changes its type");
      if (shape.present != outputs[port][i].present) refuse(name + " changes whether it is there");
      if (is_image(shape.type) && Image::bytes_needed(shape.type, shape.size) > Image::kMaxBytes)
        refuse(name + " is larger than 1 TiB");
    }
    if (answer.in_place_of[port] < 0) continue;
    const std::string fault = fault_in_place(node, port, inputs, answer);
    const auto input = static_cast<std::size_t>(answer.in_place_of[port]);
    if (!fault.empty())
      refuse("output '" + std::string(desc.name) + "' takes the place of input '" + input_port(node, input).name + "', but " +
             fault);
  }
  if (answer.by_rows) {
    if (answer.scratch_bytes > 0) refuse("it works row by row, but asks for scratch memory for the whole frame");
    for (const std::vector<Shape>& port : answer.outputs)
      for (const Shape& shape : port)
        if (shape.present && !is_image(shape.type)) refuse("it works row by row, but yields what is not an image");
  }
  if (!(answer.kept >= 0 && answer.kept <= 1) || answer.settles < 0)
    refuse("it keeps " + std::to_string(answer.kept) + " of its history, and settles after " + std::to_string(answer.settles) +
           " frames; possible are 0 to 1, and 0 or more");
  if (answer.scratch_bytes > Image::kMaxBytes || answer.slot_scratch_bytes > Image::kMaxBytes)
    refuse("it asks for more than 1 TiB of scratch memory");
}

}  // namespace

PlannedNode ask_pass(const Graph& graph, int index, const PortShapes& inputs, const PortShapes& outputs) {
  const Node& node = graph.nodes[static_cast<std::size_t>(index)];
  RawShapes raw_inputs(inputs), raw_outputs(outputs);
  PlannedNode answer;
  answer.node = index;
  answer.radius.assign(inputs.size(), 0);
  answer.in_place_of.assign(outputs.size(), -1);
  quell_inference inference{sizeof(quell_inference),
                            raw_inputs.count(),
                            raw_outputs.count(),
                            raw_inputs.data(),
                            raw_outputs.data(),
                            answer.radius.data(),
                            answer.in_place_of.data(),
                            0,
                            0,
                            0,
                            answer.kept,
                            answer.settles};
  node.instance->infer(inference);
  answer.outputs = raw_outputs.shapes();
  answer.scratch_bytes = inference.scratch_bytes;
  answer.slot_scratch_bytes = inference.slot_scratch_bytes;
  answer.by_rows = inference.by_rows != 0;
  answer.kept = inference.kept;
  answer.settles = inference.settles;
  check_answer(node, inputs, outputs, answer);
  return answer;
}

}  // namespace quell::planning
