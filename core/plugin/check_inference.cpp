#include "quell/plugin/check_inference.h"

#include "quell/image/image.h"
#include "quell/image/port_type.h"

namespace quell {
namespace {

constexpr std::uint32_t kMostValues = 1u << 24;
constexpr int kLargestRadius = 1 << 16;

const quell_port_shape& shapes(const quell_port_shape* ports, std::uint32_t port) {
  return *QUELL_AT(quell_port_shape, ports, port);
}
const quell_shape& shape(const quell_port_shape& port, std::uint32_t item) { return *QUELL_AT(quell_shape, port.items, item); }

std::string output_name(const quell_pass_desc& desc, std::uint32_t port) {
  return "infer breaks the plugin interface: output '" + std::string(QUELL_AT(quell_port_desc, desc.outputs, port)->name) + "' ";
}

/// What is wrong with an item of a port that may carry `types`, or nothing.
std::string fault_in_shape(const quell_shape& item, Types types) {
  if (item.type >= QUELL_TYPE_COUNT || !accepts(types, static_cast<PortType>(item.type)))
    return "is given a type other than " + describe(types);
  if (item.type == QUELL_TYPE_VALUE && item.value_count > kMostValues)
    return "is given " + std::to_string(item.value_count) + " values";
  if (is_image(static_cast<PortType>(item.type)) &&
      (item.width < 1 || item.height < 1 || item.width > Image::kMaxSize || item.height > Image::kMaxSize))
    return "is given the size " + std::to_string(item.width) + " x " + std::to_string(item.height);
  return {};
}

}  // namespace

InferenceCheck::InferenceCheck(const quell_pass_desc& desc, const quell_inference& question) : desc_(desc) {
  for (std::uint32_t i = 0; i < question.output_count; ++i) outputs_.push_back(shapes(question.outputs, i));
}

std::string InferenceCheck::find_fault(const quell_inference& answer) const {
  for (std::uint32_t i = 0; i < desc_.input_count; ++i)
    if (answer.radius[i] < QUELL_RADIUS_UNBOUNDED || answer.radius[i] > kLargestRadius)
      return "infer breaks the plugin interface: it gives the input '" +
             std::string(QUELL_AT(quell_port_desc, desc_.inputs, i)->name) + "' the radius " + std::to_string(answer.radius[i]);
  for (std::uint32_t i = 0; i < desc_.output_count; ++i) {
    std::string fault = fault_in_output(answer, i);
    if (fault.empty()) fault = fault_in_place(answer, i);
    if (!fault.empty()) return output_name(desc_, i) + fault;
  }
  return {};
}

std::string InferenceCheck::fault_in_output(const quell_inference& answer, std::uint32_t port) const {
  const quell_port_shape& output = shapes(answer.outputs, port);
  if (output.count != outputs_[port].count || output.items != outputs_[port].items)
    return "has another number of items than asked about";
  const quell_port_desc& desc = *QUELL_AT(quell_port_desc, desc_.outputs, port);
  for (std::uint32_t i = 0; i < output.count; ++i) {
    Types types = desc.types;
    if (desc.same_as >= 0) {
      const quell_port_shape& input = shapes(answer.inputs, static_cast<std::uint32_t>(desc.same_as));
      if (i >= input.count) continue;  // an unconnected optional input: the type is the host's choice
      types = QUELL_TYPE_BIT(shape(input, i).type);
    }
    if (std::string fault = fault_in_shape(shape(output, i), types); !fault.empty()) return fault;
  }
  return {};
}

std::string InferenceCheck::fault_in_place(const quell_inference& answer, std::uint32_t port) const {
  const int input = answer.in_place_of[port];
  if (input == -1) return {};
  if (input < 0 || static_cast<std::uint32_t>(input) >= desc_.input_count)
    return "takes the place of an input that does not exist";
  if (answer.radius[input] != 0) return "takes the place of an input whose radius is not 0";
  return {};
}

}  // namespace quell
