// Test graphs as graph files.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "tests/core/runtime/memory_stream.h"
#include "tests/core/runtime/schedule_graph.h"

namespace quell::test {
namespace {

std::string quoted(const std::string& text) { return '"' + text + '"'; }

std::string joined(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& item : list) text += (text.empty() ? "" : ", ") + item;
  return text;
}

const char* pass_name(Kind kind) {
  static const char* const names[] = {"stir",  "soften", "reduce", "shelter", "parts",
                                      "tally", "apply",  "falter", "shrink",  "pulse"};
  return names[static_cast<int>(kind)];
}

// "n3.color", as it is called among the nodes of its own scope.
std::string local_name(const TestGraph& graph, const Place& place) {
  const std::string full = graph.name(place);
  return place.node >= 0 && graph.node(place).group >= 0 ? full.substr(full.find('.') + 1) : full;
}

// Numbers the places that cross the border of a subgraph, in one direction.
class Crossings {
 public:
  explicit Crossings(std::string prefix) : prefix_(std::move(prefix)) {}
  std::string name(const Place& place) {
    return prefix_ + std::to_string(numbers_.emplace(place, numbers_.size()).first->second);
  }
  const std::map<Place, std::size_t>& all() const { return numbers_; }

 private:
  std::string prefix_;
  std::map<Place, std::size_t> numbers_;
};

class Writer {
 public:
  explicit Writer(const TestGraph& graph)
      : graph_(graph),
        ins_(static_cast<std::size_t>(graph.groups), Crossings("in")),
        outs_(static_cast<std::size_t>(graph.groups), Crossings("o")) {}

  // What crosses a border is found while the nodes are written.
  std::string write(const std::string& folder) {
    std::vector<std::string> inputs, nodes = nodes_of(-1), outputs, inner;
    for (const TestInput& input : graph_.inputs)
      inputs.push_back(quoted(input.name) + ": " + input_text(input.type, input.optional));
    for (std::size_t i = 0; i < graph_.outputs.size(); ++i)
      outputs.push_back(quoted("out" + std::to_string(i)) + ": " + quoted(source(graph_.outputs[i], -1)));
    for (int group = 0; group < graph_.groups; ++group) inner.push_back(joined(nodes_of(group)));
    std::vector<std::string> resets;  // first, because they cross borders, too
    for (int group = -1; group < graph_.groups; ++group) resets.push_back(reset_of(group));
    for (int group = 0; group < graph_.groups; ++group) nodes.push_back(subgraph_node(group));
    for (int group = 0; group < graph_.groups; ++group)
      std::ofstream(folder + "/g" + std::to_string(group) + ".json")
          << subgraph(group, inner[static_cast<std::size_t>(group)], resets[static_cast<std::size_t>(group + 1)]);
    return file(joined(inputs), joined(nodes), joined(outputs), resets[0]);
  }

 private:
  static std::string file(const std::string& inputs, const std::string& nodes, const std::string& outputs,
                          const std::string& reset) {
    return "{\"quell\": 1, \"inputs\": {" + inputs + "},\n\"nodes\": {" + nodes + "},\n\"outputs\": {" + outputs + "}" + reset +
           "}\n";
  }
  static std::string input_text(PortType type, bool optional) {
    const std::string text = quoted(std::string(name(type)));
    return optional ? "{\"type\": " + text + ", \"optional\": true}" : text;
  }

  std::string reset_of(int group) {
    const auto reset = graph_.resets.find(group);
    return reset == graph_.resets.end() ? "" : ",\n\"reset\": " + quoted(source(reset->second, group));
  }

  int group_of(const Place& place) const { return place.node < 0 ? -1 : graph_.node(place).group; }

  // What a place is called by a node in `group` (-1: outside of all).
  std::string source(const Place& place, int group) {
    const int home = group_of(place);
    if (home == group) return local_name(graph_, place);
    if (group >= 0) return ins_[static_cast<std::size_t>(group)].name(place);
    return "g" + std::to_string(home) + "." + outs_[static_cast<std::size_t>(home)].name(place);
  }

  std::string wire_text(const Wire& wire, int group) {
    const std::string from = quoted(source(wire.from, group));
    if (wire.delay == 0) return from;
    std::string initial = quoted("none");
    if (wire.start == Wire::Start::place) initial = "{\"from\": " + quoted(source(wire.place, group)) + "}";
    if (wire.start == Wire::Start::constant) {
      const std::string number = std::to_string(wire.constant);
      initial = "{\"constant\": [" + number + (graph_.type(wire.from) == QUELL_TYPE_VALUE ? ", 17" : "") + "]}";
    }
    return "{\"from\": " + from + ", \"delay\": " + std::to_string(wire.delay) + ", \"initial\": " + initial + "}";
  }

  std::string node_text(int index) {
    const TestNode& node = graph_.nodes[static_cast<std::size_t>(index)];
    const std::string other = node.kind == Kind::tally ? "previous" : node.kind == Kind::apply ? "by" : "other";
    std::vector<std::string> in{"\"color\": " + wire_text(node.main[0], node.group)}, list;
    for (const Wire& wire : node.other) in.push_back(quoted(other) + ": " + wire_text(wire, node.group));
    for (const Wire& wire : node.list) list.push_back(wire_text(wire, node.group));
    if (!list.empty()) in.push_back(quoted(node.kind == Kind::parts ? "items" : "more") + ": [" + joined(list) + "]");
    std::vector<std::string> params;
    if (node.kind != Kind::pulse) params.push_back("\"salt\": " + std::to_string(node.salt));
    if (node.kind == Kind::soften) params.push_back("\"radius\": " + std::to_string(node.radius));
    if (node.in_place && (node.kind == Kind::stir || node.kind == Kind::parts || node.kind == Kind::falter))
      params.emplace_back("\"in_place\": true");
    if (node.kind == Kind::falter || node.kind == Kind::pulse) {
      std::vector<std::string> frames;
      for (const int frame : node.fails) frames.push_back(std::to_string(frame));
      params.push_back("\"frames\": [" + joined(frames) + "]");
      if (node.kind == Kind::falter) params.push_back("\"how\": " + quoted(node.how));
    }
    return "\n  \"n" + std::to_string(index) + "\": {\"pass\": " + quoted(pass_name(node.kind)) + ", \"in\": {" + joined(in) +
           "}, \"params\": {" + joined(params) + "}}";
  }

  std::vector<std::string> nodes_of(int group) {
    std::vector<std::string> texts;
    for (const int index : graph_.file_order) {
      if (graph_.nodes[static_cast<std::size_t>(index)].group != group) continue;
      texts.push_back(node_text(index));
      if (group >= 0) outs_[static_cast<std::size_t>(group)].name({index});  // a graph must have an output
    }
    return texts;
  }

  std::string subgraph_node(int group) {
    std::vector<std::string> in;
    for (const auto& [place, number] : ins_[static_cast<std::size_t>(group)].all())
      in.push_back("\"in" + std::to_string(number) + "\": " + quoted(source(place, -1)));
    const std::string name = "g" + std::to_string(group);
    return "\n  " + quoted(name) + ": {\"graph\": " + quoted(name + ".json") + ", \"in\": {" + joined(in) + "}}";
  }

  std::string subgraph(int group, const std::string& nodes, const std::string& reset) {
    std::vector<std::string> inputs, outputs;
    for (const auto& [place, number] : ins_[static_cast<std::size_t>(group)].all())
      inputs.push_back("\"in" + std::to_string(number) + "\": " + input_text(graph_.type(place), !graph_.present(place)));
    for (const auto& [place, number] : outs_[static_cast<std::size_t>(group)].all())
      outputs.push_back("\"o" + std::to_string(number) + "\": " + quoted(local_name(graph_, place)));
    return file(joined(inputs), nodes, joined(outputs), reset);
  }

  const TestGraph& graph_;
  std::vector<Crossings> ins_, outs_;  // of each group
};

}  // namespace

std::string to_json(const TestGraph& graph, const std::string& folder) { return Writer(graph).write(folder); }

std::shared_ptr<const Graph> load(const TestGraph& graph) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("quell_schedule_test_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  static const Registry registry = test_passes();
  const std::string text = to_json(graph, folder.string());
  try {
    const auto checked =
        parse_graph(std::make_shared<const SourceText>(SourceText{(folder / "main.json").string(), text}), registry);
    std::filesystem::remove_all(folder);
    return checked;
  } catch (const Error& error) { throw Error(error.fault(), "", std::string(error.what()) + "\n" + text); }
}

}  // namespace quell::test
