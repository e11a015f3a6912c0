// The words of Graphviz' language that a drawing is made of. Private to this box.
#pragma once

#include <string>
#include <string_view>

#include "quell/image/port_type.h"

namespace quell::planning {

inline constexpr std::string_view kGone = "#c4c4c4";   ///< what does not run
inline constexpr std::string_view kQuiet = "#6e6e6e";  ///< what is less important
inline constexpr std::string_view kInk = "#1a1a1a";

/// A color for each type, on white: Okabe and Ito's eight without their yellow, then those of Paul Tol's muted scheme that are
/// farthest from them. Both are made for eyes that tell red from green badly.
std::string_view color_of(PortType type);

/// A string in its double quotes, as the value of an attribute that is shown as it is.
std::string quote_dot(std::string_view text);
/// Text within an HTML-like label, of several lines where it has line feeds.
std::string html_label(std::string_view text);
/// The same in a color, and a size in points.
std::string html_font(std::string_view html, std::string_view color, int size);
/// A small square; hollow, or filled with its color.
std::string html_square(std::string_view color, bool filled, const std::string& port = "");

}  // namespace quell::planning
