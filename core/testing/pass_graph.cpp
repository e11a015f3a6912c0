#include "quell/testing/pass_graph.h"

#include <charconv>

#include "quell/text/diagnostic.h"
#include "quell/text/error.h"
#include "quell/text/json.h"

namespace quell::harness {
namespace {

std::string join(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

std::uint32_t find_port(const quell_port_desc* ports, std::uint32_t count, std::string_view name, const char* pass) {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < count; ++i) {
    names.emplace_back(QUELL_AT(quell_port_desc, ports, i)->name);
    if (names.back() == name) return i;
  }
  throw Error(
      Fault::usage, pass,
      "the pass has no port '" + std::string(name) + "'" + did_you_mean(name, names) + "; it has " + list_names(names, "and"));
}

}  // namespace

std::string json_number(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
  return {text, end};
}

std::string item_name(std::string_view port, std::size_t item) { return std::string(port) + "_" + std::to_string(item); }

std::uint32_t PassGraph::input_index(std::string_view name) const {
  return find_port(desc.inputs, desc.input_count, name, desc.id);
}
std::uint32_t PassGraph::output_index(std::string_view name) const {
  return find_port(desc.outputs, desc.output_count, name, desc.id);
}
bool PassGraph::is_array(std::string_view input) const {
  return (QUELL_AT(quell_port_desc, desc.inputs, input_index(input))->flags & QUELL_PORT_ARRAY) != 0;
}

// How many items an output has: an array has as many as the input it follows.
std::size_t PassGraph::item_count(const quell_port_desc& output) const {
  if (!(output.flags & QUELL_PORT_ARRAY)) return 1;
  const auto followed = inputs.find(QUELL_AT(quell_port_desc, desc.inputs, output.same_as)->name);
  return followed == inputs.end() ? 0 : followed->second.size();
}

std::string PassGraph::input_list() const {
  std::vector<std::string> lines;
  for (const auto& [port, items] : inputs)
    for (std::size_t i = 0; i < items.size(); ++i)
      lines.push_back(quote_json(item_name(port, i)) + ": " + quote_json(name(items[i].type())));
  return join(lines);
}

std::string PassGraph::connection_list() const {
  std::vector<std::string> lines;
  for (const auto& [port, items] : inputs) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < items.size(); ++i) names.push_back(quote_json(item_name(port, i)));
    const std::string list = join(names);
    const bool array = is_array(port);
    if (!items.empty()) lines.push_back(quote_json(port) + ": " + (array ? "[" + list + "]" : list));
  }
  for (const auto& [to, from] : feedback)
    lines.push_back(quote_json(to) + R"(: {"from": "pass.)" + from + R"(", "delay": 1, "initial": "none"})");
  return join(lines);
}

std::string PassGraph::output_list() const {
  std::vector<std::string> lines;
  for (std::uint32_t o = 0; o < desc.output_count; ++o) {
    const quell_port_desc& port = *QUELL_AT(quell_port_desc, desc.outputs, o);
    const bool array = (port.flags & QUELL_PORT_ARRAY) != 0;
    for (std::size_t i = 0; i < item_count(port); ++i)
      lines.push_back(quote_json(item_name(port.name, i)) + R"(: "pass.)" + port.name +
                      (array ? "[" + std::to_string(i) + "]" : "") + '"');
  }
  return join(lines);
}

std::string PassGraph::text() const {
  std::vector<std::string> settings;
  for (const auto& [param, value] : params) settings.push_back(quote_json(param) + ": " + value);
  return R"({"quell": 1, "inputs": {)" + input_list() + R"(}, "nodes": {"pass": {"pass": )" + quote_json(desc.id) +
         R"(, "in": {)" + connection_list() + R"(}, "params": {)" + join(settings) + R"(}}}, "outputs": {)" + output_list() +
         "}}";
}

}  // namespace quell::harness
