// One node of a drawing: a box with its name, its pass and its ports. Private to this box.
#pragma once

#include <string>
#include <vector>

namespace quell::planning {

/// One side of a row: a port, or an item of one that is a list.
struct Pin {
  std::string id;  ///< where edges begin and end; unique within the node
  std::string name;
  std::string type;  ///< in small print behind the name; may be ""
  std::string color;
  bool filled = true;
  bool connected = true;  ///< its name is gray otherwise
};

struct DrawnNode {
  std::string name, pass;
  std::vector<Pin> left, right;
  bool gone = false;  ///< all gray
};

/// The node as an HTML-like label.
std::string html_node(const DrawnNode& node);

}  // namespace quell::planning
