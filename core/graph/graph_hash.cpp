#include "quell/graph/graph_hash.h"

#include <xxhash.h>

#include <array>
#include <charconv>
#include <fstream>
#include <map>
#include <memory>
#include <vector>

#include "quell/text/json.h"

namespace quell {
namespace {

namespace fs = std::filesystem;

/// Raised when the text of an unchanged graph changes, so that hashes of former versions of quell are never met by chance.
constexpr const char* kFormat = "quell graph 1\n";

std::string hexadecimal(XXH128_hash_t hash) {
  XXH128_canonical_t bytes;  // big-endian on every machine
  XXH128_canonicalFromHash(&bytes, hash);
  std::string text;
  for (const unsigned char byte : bytes.digest) {
    constexpr const char* kDigits = "0123456789abcdef";
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

/// The shortest text that reads back as the same number.
std::string number(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// The hash of a file's bytes; nothing when it cannot be read.
std::string hash_file(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return "";
  std::ifstream stream(file, std::ios::binary);
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(), XXH3_freeState);
  if (!stream || !state || XXH3_128bits_reset(state.get()) != XXH_OK) return "";
  std::vector<char> block(std::size_t{1} << 16);
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0)
    XXH3_128bits_update(state.get(), block.data(), static_cast<std::size_t>(stream.gcount()));
  return stream.bad() ? "" : hexadecimal(XXH3_128bits_digest(state.get()));
}

/// A parameter's value; of paths, what the files hold.
std::string value_text(const quell_param_desc& desc, const ParamValue& value) {
  if (desc.type != QUELL_PARAM_PATH) return to_json(desc, value);
  std::string text;
  for (const std::string& path : std::get<std::vector<std::string>>(value.elements)) {
    const std::string content = hash_file(path);
    text += (text.empty() ? "" : ", ") + (content.empty() ? "path " + quote_json(path) : "file " + content);
  }
  return "[" + text + "]";
}

using Results = std::map<std::string, Endpoint>;  // by name

class Writer {
 public:
  explicit Writer(const Graph& graph) : graph_(graph) {}

  std::string whole() {
    for (const GraphInput& input : graph_.inputs) add_input(input);
    for (const Node& node : graph_.nodes) nodes_[node.name] = node_text(node);
    Results outputs;
    for (const GraphOutput& output : graph_.outputs) outputs[output.name] = output.from;
    return text(outputs);
  }

  std::string part(const Results& results) {
    for (const auto& [name, from] : results) need(from);
    while (!to_visit_.empty()) {
      const Node& node = *to_visit_.back();
      to_visit_.pop_back();
      for (const std::vector<Edge>& port : node.inputs)
        for (const Edge& edge : port) {
          need(edge.from);
          if (edge.delay != 0 && edge.initial.kind == Initial::Kind::endpoint) need(edge.initial.endpoint);
        }
      for (const Endpoint& reset : node.resets) need(reset);
    }
    return text(results);
  }

 private:
  using Lines = std::map<std::string, std::string>;  // by name

  void add_input(const GraphInput& input) {
    inputs_[input.name] = std::string(name(input.type)) + (input.optional ? " optional" : "") + "\n";
  }

  void need(const Endpoint& endpoint) {
    if (endpoint.is_nothing()) return;
    if (endpoint.node < 0) return add_input(graph_.inputs[static_cast<std::size_t>(endpoint.port)]);
    const Node& node = graph_.nodes[static_cast<std::size_t>(endpoint.node)];
    const auto [place, is_new] = nodes_.try_emplace(node.name);
    if (!is_new) return;
    place->second = node_text(node);
    to_visit_.push_back(&node);
  }

  std::string text(const Results& results) const {
    Lines outputs;
    for (const auto& [name, from] : results) outputs[name] = source(from) + "\n";
    return kFormat + joined("input ", inputs_) + joined("node ", nodes_) + joined("output ", outputs);
  }

  static std::string joined(const std::string& kind, const Lines& lines) {
    std::string text;
    for (const auto& [name, line] : lines) text += kind + quote_json(name) + " " + line;
    return text;
  }

  std::string node_text(const Node& node) const {
    Lines params, ports;
    for (std::uint32_t i = 0; i < node.pass->param_count; ++i) {
      const quell_param_desc& desc = *QUELL_AT(quell_param_desc, node.pass->params, i);
      params[desc.name] = value_text(desc, node.instance->values()[i]) + "\n";
    }
    for (std::uint32_t i = 0; i < node.pass->input_count; ++i) {
      std::string sources;
      for (const Edge& edge : node.inputs[i]) sources += (sources.empty() ? "" : ", ") + edge_text(edge);
      if (!node.inputs[i].empty()) ports[QUELL_AT(quell_port_desc, node.pass->inputs, i)->name] = "[" + sources + "]\n";
    }
    return quote_json(node.pass->id) + " version " + std::to_string(node.pass->version) + "\n" + joined("  param ", params) +
           joined("  in ", ports) + resets_text(node);
  }

  // Graphs without resets keep the text that they have always had.
  std::string resets_text(const Node& node) const {
    std::string sources;
    for (const Endpoint& reset : node.resets) sources += (sources.empty() ? "" : ", ") + source(reset);
    return sources.empty() ? "" : "  reset [" + sources + "]\n";
  }

  std::string edge_text(const Edge& edge) const {
    std::string text = source(edge.from);
    if (edge.delay == 0) return text;
    text += " delay " + std::to_string(edge.delay) + " initial ";
    if (edge.initial.kind == Initial::Kind::none) return text + "none";
    if (edge.initial.kind == Initial::Kind::endpoint) return text + source(edge.initial.endpoint);
    std::string values;
    for (const double value : edge.initial.constant) values += (values.empty() ? "" : ", ") + number(value);
    return text + "[" + values + "]";
  }

  std::string source(const Endpoint& endpoint) const {
    if (endpoint.is_nothing()) return "nothing " + std::string(name(graph_.type(endpoint)));
    return quote_json(graph_.describe(endpoint));
  }

  const Graph& graph_;
  Lines inputs_, nodes_;
  std::vector<const Node*> to_visit_;
};

std::string hash_text(const std::string& text) { return hexadecimal(XXH3_128bits(text.data(), text.size())); }

}  // namespace

std::string canonical_text(const Graph& graph) { return Writer(graph).whole(); }
std::string canonical_text(const Graph& graph, const std::map<std::string, Endpoint>& results) {
  return Writer(graph).part(results);
}

std::string graph_hash(const Graph& graph) { return hash_text(canonical_text(graph)); }
std::string graph_hash(const Graph& graph, const std::map<std::string, Endpoint>& results) {
  return hash_text(canonical_text(graph, results));
}

}  // namespace quell
