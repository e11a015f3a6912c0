#include "quell/graph/dot_text.h"

#include <array>

#include "quell/text/diagnostic.h"
#include "quell/text/html_text.h"

namespace quell::planning {
namespace {

// In the order of quell_type.
constexpr std::array<std::string_view, QUELL_TYPE_COUNT> kColors{
    "#d55e00",  // color: vermillion
    "#e69f00",  // albedo: orange
    "#0072b2",  // normal: blue
    "#56b4e9",  // position: sky blue
    "#332288",  // depth: indigo (Tol)
    "#000000",  // id: black
    "#009e73",  // motion: bluish green
    "#aa4499",  // moments: purple (Tol)
    "#cc79a7",  // variance: reddish purple
    "#999933",  // scalar: olive (Tol)
    "#882255",  // mask: wine (Tol)
    "#44aa99",  // alpha: teal (Tol)
    "#117733",  // camera: green (Tol)
    "#cc6677",  // value: rose (Tol)
};

}  // namespace

std::string_view color_of(PortType type) { return kColors.at(static_cast<std::size_t>(type)); }

std::string quote_dot(std::string_view text) {
  std::string out = "\"";
  for (const char c : printable(text)) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n')
      out += "\\n";
    else
      out += c == '&' ? "&amp;" : std::string(1, c);  // it reads entities even in quotes
  }
  return out + "\"";
}

std::string html_label(std::string_view text) {
  std::string out;
  for (const char c : escape_html(text)) out += c == '\n' ? "<BR/>" : std::string(1, c);
  return out;
}

std::string html_font(std::string_view html, std::string_view color, int size) {
  return "<FONT COLOR=\"" + std::string(color) + "\" POINT-SIZE=\"" + std::to_string(size) + "\">" + std::string(html) +
         "</FONT>";
}

// A cell grows with its row; only a table of its own keeps its size.
std::string html_square(std::string_view color, bool filled, const std::string& port) {
  const std::string name(color);
  return "<TABLE" + (port.empty() ? "" : " PORT=\"" + port + "\"") + " BORDER=\"2\" CELLBORDER=\"0\" CELLPADDING=\"0\" COLOR=\"" +
         name + "\" BGCOLOR=\"" + (filled ? name : "white") +
         "\" FIXEDSIZE=\"TRUE\" WIDTH=\"9\" HEIGHT=\"9\"><TR><TD></TD></TR></TABLE>";
}

}  // namespace quell::planning
