// Small readers of pass descriptors. Private to this box.
#pragma once

#include <cstddef>

#include "quell/graph/graph.h"

namespace quell::planning {

inline const quell_port_desc& input_port(const Node& node, std::size_t port) {
  return *QUELL_AT(quell_port_desc, node.pass->inputs, port);
}
inline const quell_port_desc& output_port(const Node& node, std::size_t port) {
  return *QUELL_AT(quell_port_desc, node.pass->outputs, port);
}
inline bool is_optional(const quell_port_desc& port) { return (port.flags & QUELL_PORT_OPTIONAL) != 0; }
inline bool is_array(const quell_port_desc& port) { return (port.flags & QUELL_PORT_ARRAY) != 0; }
inline bool is_any_size(const quell_port_desc& port) { return (port.flags & QUELL_PORT_ANY_SIZE) != 0; }

/// How many items an output has: those of its `same_as` input for an array, else one.
inline std::size_t item_count(const Node& node, std::size_t output) {
  const quell_port_desc& port = output_port(node, output);
  return is_array(port) ? node.inputs[static_cast<std::size_t>(port.same_as)].size() : 1;
}

/// "in", or "in[2]" for an item of an array.
inline std::string item_name(const quell_port_desc& port, std::size_t item) {
  return is_array(port) ? std::string(port.name) + "[" + std::to_string(item) + "]" : port.name;
}

}  // namespace quell::planning
