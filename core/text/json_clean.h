// What comes before the JSON parser: comments and trailing commas are blanked, so that every byte keeps its place, and mistakes
// of structure (brackets, quotes, encoding) are told here, where their other end is known.
#pragma once

#include <optional>
#include <string>

#include "quell/text/diagnostic.h"

namespace quell::detail {

inline constexpr std::size_t kDeepestJson = 200;

/// The text with comments, trailing commas and a byte order mark replaced by spaces; nothing, and an error, when its brackets,
/// strings or characters are not well formed.
std::optional<std::string> clean_json(const SourceTextPtr& source, Diagnostics& errors);

/// Offset of the first byte that is not part of valid UTF-8; the text's size when all of it is.
std::size_t first_invalid_utf8(std::string_view text);

}  // namespace quell::detail
