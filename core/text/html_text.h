// Text that stands in HTML as it is.
#pragma once

#include <string>
#include <string_view>

namespace quell {

/// The text between tags, or in an attribute's double quotes. As printable() has it: what is not UTF-8 becomes '?'.
std::string escape_html(std::string_view text);

}  // namespace quell
