// Text for a terminal of 100 columns.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace quell::app {

inline constexpr std::size_t kColumns = 100;

/// Columns that a text takes: its characters, not its bytes.
std::size_t columns_of(std::string_view text);
/// Breaks text at spaces so that no line is longer than kColumns, as far as its words allow. Every line starts with `indent`
/// spaces; line feeds of the text stay. Ends with a line feed unless the text is empty.
std::string wrap(std::string_view text, std::size_t indent = 0);
/// One entry of a list: `left` at column `indent`, `right` wrapped at column `column`; below `left` where that is too long.
std::string entry(std::string_view left, std::string_view right, std::size_t indent, std::size_t column);

}  // namespace quell::app
