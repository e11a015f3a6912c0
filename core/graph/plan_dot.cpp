#include "quell/graph/plan_dot.h"

#include <algorithm>
#include <array>
#include <bit>
#include <set>
#include <sstream>

#include "quell/graph/dot_node.h"
#include "quell/graph/dot_text.h"
#include "quell/graph/plan_ports.h"
#include "quell/graph/plan_presence.h"
#include "quell/graph/plan_text.h"
#include "quell/text/diagnostic.h"

namespace quell {
namespace {

using namespace planning;  // NOLINT: this file is the box's own

constexpr std::size_t kLongestInitial = 24;  // in a label; longer ones are told by the tooltip alone

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

class Drawing {
 public:
  explicit Drawing(const Plan& plan) : plan_(plan), graph_(*plan.graph), presence_(graph_, plan.inputs) {
    for (const int node : plan.pruned) gone_.insert(node);
  }

  std::string draw() {
    out_ = "digraph " + quote_dot(title()) + " {\n";
    out_ += "  rankdir=LR; nodesep=0.3; ranksep=0.7; bgcolor=white;\n";
    out_ += "  fontname=\"Helvetica,Arial,sans-serif\"; fontsize=11; tooltip=" + quote_dot(graph_.doc) + ";\n";
    out_ += "  node [fontname=\"Helvetica,Arial,sans-serif\", fontsize=11, shape=plain];\n";
    out_ += "  edge [fontname=\"Helvetica,Arial,sans-serif\", fontsize=9, penwidth=1.8, arrowsize=0.7];\n";
    draw_inputs();
    std::vector<int> nodes;
    for (int node = 0; node < static_cast<int>(graph_.nodes.size()); ++node) nodes.push_back(node);
    draw_scope("", nodes, 1);
    draw_outputs();
    draw_edges();
    out_ += "  labelloc=b; labeljust=l; label=<" + caption() + ">;\n";
    return out_ + "}\n";
  }

 private:
  const Node& node_of(int node) const { return graph_.nodes[static_cast<std::size_t>(node)]; }
  std::string title() const { return graph_.name.empty() ? "graph" : graph_.name; }
  bool is_gone(const Endpoint& from) const {
    return from.node >= 0 ? gone_.contains(from.node) || !presence_.has(from)
                          : !plan_.inputs[static_cast<std::size_t>(from.port)].present;
  }

  std::string_view color(PortType type, bool gone) {
    if (!gone) types_.insert(type);
    return gone ? kGone : color_of(type);
  }

  // An end of the graph: an input, or an output with its double line.
  void draw_end(const std::string& id, const std::string& name, PortType type, bool gone, const std::string& more,
                const std::string& tooltip) {
    const std::string line(color(type, gone)), ink(gone ? kGone : kInk);
    std::string label = html_font("<B>" + html_label(name) + "</B>", ink, 11);
    if (name != quell::name(type)) label += "<BR/>" + html_font(quell::name(type), gone ? kGone : kQuiet, 9);
    out_ += "  " + quote_dot(id) + " [shape=ellipse, margin=\"0.08,0.04\", penwidth=2, color=\"" + line + "\", " + more +
            "label=<" + label + ">, tooltip=" + quote_dot(tooltip) + "];\n";
  }

  void draw_inputs() {
    for (std::size_t i = 0; i < graph_.inputs.size(); ++i) {
      const GraphInput& input = graph_.inputs[i];
      const bool gone = !plan_.inputs[i].present;
      const std::string fill = input.optional || gone ? "white" : std::string(color_of(input.type)) + "30";
      std::string tooltip = "input " + input.name + ", " + std::string(name(input.type)) + (input.optional ? ", optional" : "");
      if (gone) tooltip += ", absent";
      if (!input.doc.empty()) tooltip += "\n" + input.doc;
      draw_end("input " + input.name, input.name, input.type, gone, "style=filled, fillcolor=\"" + fill + "\", ", tooltip);
    }
  }

  void draw_outputs() {
    for (std::size_t i = 0; i < graph_.outputs.size(); ++i) {
      const GraphOutput& output = graph_.outputs[i];
      const PortType type = graph_.type(output.from);
      const bool gone = std::find(plan_.outputs.begin(), plan_.outputs.end(), static_cast<int>(i)) == plan_.outputs.end();
      draw_end("output " + output.name, output.name, type, gone, "peripheries=2, ",
               "output " + output.name + ", " + std::string(name(type)) + (gone ? ", not computed" : ""));
    }
  }

  // Nodes whose names begin alike stand in a subgraph: a frame of its own, where the first of them stands.
  void draw_scope(const std::string& prefix, const std::vector<int>& nodes, std::size_t depth) {
    std::set<std::string> drawn;
    for (const int node : nodes) {
      const std::string rest = node_of(node).name.substr(prefix.size());
      const std::size_t dot = rest.find('.');
      if (dot == std::string::npos) {
        draw_node(node, rest, depth);
        continue;
      }
      const std::string inner = prefix + rest.substr(0, dot + 1);
      if (!drawn.insert(inner).second) continue;
      std::vector<int> members;
      for (const int other : nodes)
        if (node_of(other).name.starts_with(inner)) members.push_back(other);
      const std::string indent(2 * depth, ' ');
      out_ += indent + "subgraph " + quote_dot("cluster " + inner) + " {\n";
      out_ += indent + "  label=<" + html_font("<B>" + html_label(rest.substr(0, dot)) + "</B>", kQuiet, 11) +
              ">; style=\"rounded,filled\"; color=\"#b0b0b0\"; fillcolor=\"#f6f6f6\"; tooltip=" +
              quote_dot("subgraph " + inner.substr(0, inner.size() - 1)) + ";\n";
      draw_scope(inner, members, depth + 1);
      out_ += indent + "}\n";
    }
  }

  void draw_node(int index, const std::string& name, std::size_t depth) {
    const Node& node = node_of(index);
    const bool gone = gone_.contains(index);
    const std::string table = html_node({name, node.pass->id, input_pins(index), output_pins(index), gone});
    std::string tooltip = node.name + ": " + node.pass->id + "\n" + (node.doc.empty() ? node.pass->summary : node.doc);
    if (gone) tooltip += "\nleft out: " + why_gone(index);
    out_ +=
        std::string(2 * depth, ' ') + quote_dot(node.name) + " [label=<" + table + ">, tooltip=" + quote_dot(tooltip) + "];\n";
  }

  std::string why_gone(int node) const {
    return presence_.has_node(node) ? "nothing that runs needs it" : presence_.why_node_absent(node);
  }

  static std::string pin_id(char side, std::size_t port, std::size_t item) {
    return side + std::to_string(port) + "_" + std::to_string(item);
  }

  // The type is named where the port's own name does not say it.
  Pin make_pin(std::string id, std::string name, PortType type, bool gone) {
    const std::string_view type_name = quell::name(type);
    return {std::move(id), name, name == type_name ? "" : std::string(type_name), std::string(color(type, gone)), true, true};
  }

  std::vector<Pin> input_pins(int index) {
    const Node& node = node_of(index);
    std::vector<Pin> pins;
    for (std::size_t port = 0; port < node.inputs.size(); ++port) {
      const quell_port_desc& desc = input_port(node, port);
      if (node.inputs[port].empty())
        pins.push_back({pin_id('i', port, 0), desc.name, is_array(desc) ? "list" : "", std::string(kQuiet), true, false});
      for (std::size_t item = 0; item < node.inputs[port].size(); ++item) {
        const Edge& edge = node.inputs[port][item];
        const bool gone = gone_.contains(index) || edge.from.is_nothing() || !presence_.has(edge);
        Pin pin{pin_id('i', port, item), item_name(desc, item), "nothing", std::string(kGone), true, true};
        pins.push_back(edge.from.is_nothing() ? pin : make_pin(pin.id, pin.name, graph_.type(edge.from), gone));
      }
      for (Pin& pin : pins)
        if (pin.id.starts_with("i" + std::to_string(port) + "_")) pin.filled = !is_optional(desc);
    }
    return pins;
  }

  std::vector<Pin> output_pins(int index) {
    const Node& node = node_of(index);
    std::vector<Pin> pins;
    for (std::size_t port = 0; port < node.pass->output_count; ++port)
      for (std::size_t item = 0; item < item_count(node, port); ++item) {
        const Endpoint from{index, static_cast<int>(port), static_cast<int>(item)};
        pins.push_back(
            make_pin(pin_id('o', port, item), item_name(output_port(node, port), item), graph_.type(from), is_gone(from)));
      }
    return pins;
  }

  std::string place_of(const Endpoint& from) const {
    if (from.node < 0) return quote_dot("input " + graph_.inputs[static_cast<std::size_t>(from.port)].name);
    const std::string pin = pin_id('o', static_cast<std::size_t>(from.port), static_cast<std::size_t>(from.item));
    return quote_dot(node_of(from.node).name) + ":" + pin + ":e";
  }

  void draw_edges() {
    for (int index = 0; index < static_cast<int>(graph_.nodes.size()); ++index) {
      const Node& node = node_of(index);
      for (std::size_t port = 0; port < node.inputs.size(); ++port)
        for (std::size_t item = 0; item < node.inputs[port].size(); ++item) draw_edge(index, port, item, node.inputs[port][item]);
      for (const Endpoint& reset : node.resets) draw_reset(index, reset);
    }
    for (const GraphOutput& output : graph_.outputs)
      out_ += "  " + place_of(output.from) + " -> " + quote_dot("output " + output.name) + " [color=\"" +
              std::string(color(graph_.type(output.from), is_gone(output.from))) +
              "\", edgetooltip=" + quote_dot(graph_.describe(output.from) + " -> output " + output.name) + "];\n";
  }

  void draw_reset(int index, const Endpoint& reset) {
    const bool gone = gone_.contains(index) || is_gone(reset);
    const std::string tooltip = quote_dot(graph_.describe(reset) + " resets the history of " + node_of(index).name);
    out_ += "  " + place_of(reset) + " -> " + quote_dot(node_of(index).name) + " [color=\"" +
            std::string(color(QUELL_TYPE_VALUE, gone)) +
            "\", style=dotted, arrowhead=tee, label=\" reset \", edgetooltip=" + tooltip + ", labeltooltip=" + tooltip + "];\n";
  }

  void draw_edge(int index, std::size_t port, std::size_t item, const Edge& edge) {
    if (edge.from.is_nothing()) return;
    const Node& node = node_of(index);
    const bool gone = gone_.contains(index) || is_gone(edge.from);
    const PortType type = graph_.type(edge.from);
    const std::string ink(color(type, gone));
    std::string tooltip = graph_.describe(edge.from) + " -> " + node.name + "." + item_name(input_port(node, port), item) + ": " +
                          std::string(name(type));
    std::string style = "color=\"" + ink + "\"";
    if (edge.delay != 0) {
      const std::string span = format_count(std::abs(edge.delay), "frame") + (edge.delay > 0 ? " back" : " ahead");
      const std::string initial = "else " + describe(edge.initial);
      tooltip += ", " + span + ", " + initial;
      style += ", style=dashed, fontcolor=\"" + std::string(gone ? kGone : kInk) +
               "\", label=" + quote_dot(" " + span + " " + (initial.size() <= kLongestInitial ? "\n " + initial + " " : ""));
      // What comes from further right must not bend the order of the nodes.
      if (edge.from.node >= index) style += ", constraint=false";
    }
    out_ += "  " + place_of(edge.from) + " -> " + quote_dot(node.name) + ":" + pin_id('i', port, item) + ":w [" + style +
            ", edgetooltip=" + quote_dot(tooltip) + ", labeltooltip=" + quote_dot(tooltip) + "];\n";
  }

  std::string describe(const Initial& initial) const {
    if (initial.kind == Initial::Kind::none) return "nothing";
    if (initial.kind == Initial::Kind::endpoint) return graph_.describe(initial.endpoint);
    std::string text;
    for (const double element : initial.constant) text += (text.empty() ? "" : " ") + number(element);
    return text;
  }

  // The name, what was left out, and the legend: the types that occur, and what else the picture says.
  std::string caption() const {
    const std::string table = "<TABLE BORDER=\"0\" CELLBORDER=\"0\" CELLSPACING=\"0\" CELLPADDING=\"2\">";
    std::string text = table;
    const auto line = [&](const std::string& html) { text += "<TR><TD ALIGN=\"LEFT\">" + html + "</TD></TR>"; };
    const auto sign = [](const std::string& picture, std::string_view meaning) {
      return "<TD>" + picture + "</TD><TD>" + html_font(meaning, kInk, 10) + "</TD><TD WIDTH=\"6\"></TD>";
    };
    line(html_font("<B>" + html_label(title()) + "</B>", kInk, 12));
    if (const std::string gone = names_of_gone(); !gone.empty()) line(html_font("left out: " + html_label(gone), kQuiet, 10));
    std::string signs;
    for (const PortType type : types_) signs += sign(html_square(color_of(type), true), name(type));
    signs += sign(html_square(kQuiet, true), "required") + sign(html_square(kQuiet, false), "optional") +
             sign(html_font("- - -", kQuiet, 10), "of another frame");
    line(table + "<TR>" + signs + "</TR></TABLE>");
    return text + "</TABLE>";
  }

  std::string names_of_gone() const {
    std::string names;
    for (std::size_t i = 0; i < graph_.inputs.size(); ++i)
      if (!plan_.inputs[i].present) names += (names.empty() ? "" : ", ") + ("input " + graph_.inputs[i].name);
    for (const int node : plan_.pruned) names += (names.empty() ? "" : ", ") + node_of(node).name;
    return names;
  }

  const Plan& plan_;
  const Graph& graph_;
  Presence presence_;
  std::set<int> gone_;
  std::set<PortType> types_;  // that occur, for the legend
  std::string out_;
};

}  // namespace

std::string to_dot(const Plan& plan) { return Drawing(plan).draw(); }

}  // namespace quell
