// describe(Plan): what `quell graph` prints.
#include <algorithm>
#include <map>
#include <sstream>

#include "quell/graph/plan.h"
#include "quell/graph/plan_buffers.h"
#include "quell/graph/plan_ports.h"
#include "quell/graph/plan_presence.h"
#include "quell/graph/plan_text.h"

namespace quell {
namespace {

using namespace planning;  // NOLINT: this file is the box's own

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

// Numbers of a column end below each other.
std::string right_aligned(std::size_t bytes) {
  constexpr std::size_t kWidth = 9;
  const std::string text = format_bytes(bytes);
  return text.size() < kWidth ? std::string(kWidth - text.size(), ' ') + text : text;
}

class Printer {
 public:
  explicit Printer(const Plan& plan) : plan_(plan), graph_(*plan.graph), presence_(graph_, plan.inputs) {}

  std::string print() const {
    return title() + section("inputs", inputs()) + section("nodes, in the order in which they run", nodes()) +
           section("outputs", outputs()) + section("left out", left_out()) + section("history", histories()) +
           section("loops", loops()) + section("memory", memory());
  }

 private:
  static std::string section(const std::string& heading, const std::string& body) {
    return body.empty() ? "" : "\n" + heading + "\n" + body;
  }

  std::string title() const {
    const std::string file = graph_.file.string();
    std::string text = graph_.name.empty() ? file : printable(graph_.name) + (file.empty() ? "" : "  (" + file + ")");
    if (!text.empty()) text += "\n";
    return text + wrap(printable(graph_.doc), 0);
  }

  std::string inputs() const {
    Table table(2);
    for (std::size_t i = 0; i < graph_.inputs.size(); ++i) {
      const Shape& shape = plan_.inputs[i];
      const std::string type(name(graph_.inputs[i].type));
      if (!shape.present)
        table.add_row({graph_.inputs[i].name, type, "absent"});
      else
        table.add_row({graph_.inputs[i].name, type, format_size(shape), bytes(shape), plan_.input_used[i] ? "" : "not used"});
    }
    return table.render();
  }

  std::string nodes() const {
    const std::vector<std::size_t>& alive = plan_.alive_bytes;
    std::vector<std::string> headings(plan_.nodes.size());
    std::size_t width = 0, count = 0;
    for (const PlannedTurn& turn : plan_.turns)
      for (const int position : turn.nodes) {
        const Node& node = node_of(plan_.nodes[static_cast<std::size_t>(position)].node);
        std::string& heading = headings[static_cast<std::size_t>(position)];
        heading = std::to_string(++count) + "  " + node.name + ": " + node.pass->id;
        if (count < 10) heading.insert(0, " ");
        width = std::max(width, heading.size());
      }
    Table table(6);
    for (const PlannedTurn& turn : plan_.turns) {
      if (turn.is_fused()) table.add_heading(" fused: " + describe(turn));
      for (const int position : turn.nodes) {
        const PlannedNode& planned = plan_.nodes[static_cast<std::size_t>(position)];
        std::string& heading = headings[static_cast<std::size_t>(position)];
        heading.resize(width, ' ');
        table.add_heading(" " + heading + "   " + format_bytes(alive[static_cast<std::size_t>(position)]) + " alive" +
                          scratch(planned));
        add_reads(table, planned);
        add_writes(table, planned);
      }
    }
    return table.render();
  }

  // "light, blend; 5 rows at a time, 700 KiB a thread"
  std::string describe(const PlannedTurn& turn) const {
    std::string names;
    for (const int position : turn.nodes)
      names += (names.empty() ? "" : ", ") + node_of(plan_.nodes[static_cast<std::size_t>(position)].node).name;
    return names + "; " + format_count(turn.rows, "row") + " at a time, " + format_bytes(turn.window_bytes) + " a thread";
  }

  static std::string scratch(const PlannedNode& planned) {
    std::string text;
    if (planned.scratch_bytes > 0) text += ", " + format_bytes(planned.scratch_bytes) + " scratch";
    if (planned.slot_scratch_bytes > 0) text += ", " + format_bytes(planned.slot_scratch_bytes) + " scratch a thread";
    return text;
  }

  void add_reads(Table& table, const PlannedNode& planned) const {
    const Node& node = node_of(planned.node);
    for (std::size_t port = 0; port < node.inputs.size(); ++port) {
      if (node.inputs[port].empty()) table.add_row({input_port(node, port).name, "<-", "(not connected)"});
      for (std::size_t item = 0; item < node.inputs[port].size(); ++item) {
        const Edge& edge = node.inputs[port][item];
        const std::string name = item_name(input_port(node, port), item);
        const std::string from = graph_.describe(edge.from);
        if (!presence_.has(edge))
          table.add_row({name, "<-", from, "absent"});
        else if (!presence_.has(edge.from))
          table.add_row({name, "<-", from, "absent", "always " + initial(edge.initial)});
        else
          table.add_row({name, "<-", from, format_size(plan_.shape(edge.from)), reading(edge, planned.radius[port])});
      }
    }
  }

  std::string reading(const Edge& edge, int radius) const {
    std::string text;
    if (radius == QUELL_RADIUS_UNBOUNDED) text = "pixels anywhere";
    if (radius > 0) text = std::to_string(radius) + " px around";
    if (edge.delay == 0) return text;
    if (!text.empty()) text += ", ";
    text += edge.delay > 0 ? format_count(edge.delay, "frame") + " back" : format_count(-edge.delay, "frame") + " ahead";
    return text + ", else " + initial(edge.initial);
  }

  std::string initial(const Initial& value) const {
    if (value.kind == Initial::Kind::none) return "none";
    if (value.kind == Initial::Kind::endpoint) return graph_.describe(value.endpoint);
    std::string text;
    for (const double element : value.constant) text += (text.empty() ? "" : " ") + number(element);
    return text;
  }

  void add_writes(Table& table, const PlannedNode& planned) const {
    const Node& node = node_of(planned.node);
    for (std::size_t port = 0; port < planned.outputs.size(); ++port)
      for (std::size_t item = 0; item < planned.outputs[port].size(); ++item) {
        const Shape& shape = planned.outputs[port][item];
        if (!shape.present) continue;
        const Endpoint endpoint{planned.node, static_cast<int>(port), static_cast<int>(item)};
        const int place = planned.in_place_of[port];
        std::string where = bytes(shape);
        if (place >= 0) where = "in place of " + item_name(input_port(node, static_cast<std::size_t>(place)), item);
        if (plan_.is_inner(endpoint)) where = "row by row";
        table.add_row({item_name(output_port(node, port), item), "->", std::string(name(shape.type)), format_size(shape), where});
      }
  }

  std::string outputs() const {
    Table table(2);
    for (const int output : plan_.outputs) {
      const GraphOutput& wanted = graph_.outputs[static_cast<std::size_t>(output)];
      add_output(table, wanted.name, wanted.from, "");
    }
    for (const Endpoint& dump : plan_.dumps) add_output(table, graph_.describe(dump), dump, "dumped");
    return table.render();
  }

  void add_output(Table& table, const std::string& label, const Endpoint& from, const std::string& note) const {
    const Shape shape = plan_.shape(from);
    table.add_row({label, "<-", graph_.describe(from), std::string(name(shape.type)), format_size(shape), note});
  }

  std::string left_out() const {
    std::string text;
    for (const int node : plan_.pruned)
      text += wrap(
          node_of(node).name + ": " + (presence_.has_node(node) ? "nothing that runs needs it" : presence_.why_node_absent(node)),
          2);
    return text;
  }

  std::string histories() const {
    Table table(2);
    for (const PlannedHistory& history : plan_.histories) {
      std::string span = history.frames > 0 ? format_count(history.frames, "frame") + " back" : "";
      if (history.frames_ahead > 0) span += (span.empty() ? "" : ", ") + format_count(history.frames_ahead, "frame") + " ahead";
      const std::size_t kept = bytes_of(history);
      table.add_row({graph_.describe(history.from), span, kept > 0 ? right_aligned(kept) : ""});
    }
    return table.render() + resets();
  }

  // Which nodes each of them holds for.
  std::string resets() const {
    std::map<Endpoint, std::string> readers;
    for (const PlannedNode& planned : plan_.nodes)
      for (const Read& read : reads(node_of(planned.node), presence_))
        if (read.delay > 0) {
          for (const Endpoint& reset : node_of(planned.node).resets)
            if (presence_.has(reset)) readers[reset] += (readers[reset].empty() ? "" : ", ") + node_of(planned.node).name;
          break;
        }
    std::string text;
    for (const auto& [reset, names] : readers)
      text += wrap("reset where " + graph_.describe(reset) + " is not 0, for " + names, 2);
    return text;
  }

  std::string loops() const {
    std::string text;
    for (const PlannedLoop& loop : plan_.loops) {
      std::string nodes;
      for (const int node : loop.nodes) nodes += (nodes.empty() ? "" : ", ") + node_of(node).name;
      const std::string delay = format_count(loop.delay, "frame");
      text += wrap(nodes + ": " + delay + " around, so that at most " + delay + " can be inside at a time", 2);
    }
    return text;
  }

  std::string memory() const {
    const std::vector<std::size_t>& alive = plan_.alive_bytes;
    std::string most = format_bytes(plan_.unshared_bytes) + " if no buffer were used twice";
    if (const auto largest = std::max_element(alive.begin(), alive.end()); largest != alive.end()) {
      const PlannedNode& planned = plan_.nodes[static_cast<std::size_t>(largest - alive.begin())];
      most = "while '" + node_of(planned.node).name + "' runs; " + most;
    }
    Table table(2);
    table.add_row({"one frame", right_aligned(plan_.frame_bytes), most});
    table.add_row({"history", right_aligned(plan_.history_bytes)});
    return table.render();
  }

  static std::string bytes(const Shape& shape) { return bytes_of(shape) > 0 ? right_aligned(bytes_of(shape)) : ""; }
  const Node& node_of(int node) const { return graph_.nodes[static_cast<std::size_t>(node)]; }

  const Plan& plan_;
  const Graph& graph_;
  Presence presence_;
};

}  // namespace

std::string describe(const Plan& plan) { return Printer(plan).print(); }

}  // namespace quell
