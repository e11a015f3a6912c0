// Graphviz' program `dot`, which draws graphs.
#pragma once

#include <string>

namespace quell::app {

/// Has `dot`, from PATH, draw a graph as SVG. Throws Error(usage) naming --svg when there is no such program, or with its own
/// words when it fails.
std::string draw_svg(const std::string& dot);

}  // namespace quell::app
