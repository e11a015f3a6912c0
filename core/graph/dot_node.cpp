#include "quell/graph/dot_node.h"

#include <algorithm>

#include "quell/graph/dot_text.h"

namespace quell::planning {
namespace {

std::string words(const Pin& pin, bool gone) {
  const std::string_view ink = gone ? kGone : pin.connected ? kInk : kQuiet;
  std::string text = html_font(html_label(pin.name), ink, 10);
  if (!pin.type.empty()) text += html_font(" " + html_label(pin.type), gone ? kGone : kQuiet, 8);
  return text;
}

std::string left_cells(const DrawnNode& node, std::size_t row) {
  if (row >= node.left.size()) return "<TD></TD><TD></TD>";
  const Pin& pin = node.left[row];
  return "<TD>" + html_square(pin.color, pin.filled, pin.id) + "</TD><TD ALIGN=\"LEFT\">" + words(pin, node.gone) + "</TD>";
}

std::string right_cells(const DrawnNode& node, std::size_t row) {
  if (row >= node.right.size()) return "<TD></TD><TD></TD>";
  const Pin& pin = node.right[row];
  return "<TD ALIGN=\"RIGHT\">" + words(pin, node.gone) + "</TD><TD>" + html_square(pin.color, pin.filled, pin.id) + "</TD>";
}

}  // namespace

std::string html_node(const DrawnNode& node) {
  const std::string frame(node.gone ? kGone : kQuiet), ink(node.gone ? kGone : kInk);
  std::string table =
      "<TABLE BORDER=\"1\" CELLBORDER=\"0\" CELLSPACING=\"0\" CELLPADDING=\"2\" STYLE=\"ROUNDED\" BGCOLOR=\"white\" COLOR=\"" +
      frame + "\">";
  table += "<TR><TD COLSPAN=\"5\" CELLPADDING=\"4\">" + html_font("<B>" + html_label(node.name) + "</B>", ink, 12) + "<BR/>" +
           html_font(html_label(node.pass), frame, 10) + "</TD></TR>";
  for (std::size_t row = 0; row < std::max(node.left.size(), node.right.size()); ++row)
    table += "<TR>" + left_cells(node, row) + "<TD WIDTH=\"14\"></TD>" + right_cells(node, row) + "</TR>";
  return table + "<TR><TD COLSPAN=\"5\" HEIGHT=\"3\"></TD></TR></TABLE>";  // room for the round corners
}

}  // namespace quell::planning
