// Writes the graph that PassTest runs: one node, fed by inputs and by its own outputs of the frame before. Private to this box.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "quell/image/item.h"
#include "quell/sdk/abi.h"

namespace quell::harness {

/// The shortest text that reads back as the same double.
std::string json_number(double value);

struct PassGraph {
  const quell_pass_desc& desc;
  std::map<std::string, std::string, std::less<>> params = {};        // as JSON
  std::map<std::string, std::vector<Item>, std::less<>> inputs = {};  // by port
  std::map<std::string, std::string, std::less<>> feedback = {};      // input port -> output port

  /// Throws Error(usage) when the pass has no such port.
  std::uint32_t input_index(std::string_view name) const;
  std::uint32_t output_index(std::string_view name) const;
  bool is_array(std::string_view input) const;
  /// The graph file. The graph's inputs and outputs are named by item_name.
  std::string text() const;

 private:
  std::size_t item_count(const quell_port_desc& output) const;
  std::string input_list() const;
  std::string connection_list() const;
  std::string output_list() const;
};

/// An item of a port, as the graph names it: "color_0".
std::string item_name(std::string_view port, std::size_t item);

}  // namespace quell::harness
