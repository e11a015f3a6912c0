// JSON with comments and trailing commas, read into values that know where they stand in the text.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quell/text/diagnostic.h"

namespace quell {

struct JsonMember;

struct Json {
  enum class Kind { null, boolean, integer, number, string, array, object };
  Kind kind = Kind::null;
  Position where;  ///< of the value's first character
  bool boolean = false;
  std::int64_t integer = 0;  ///< valid for integer
  double number = 0;         ///< valid for integer and number
  std::string string;
  std::vector<Json> elements;
  std::vector<JsonMember> members;  ///< in the text's order; keys are unique

  bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
  /// Null when the object has no such key, or this is no object.
  const Json* find(std::string_view key) const;
};

struct JsonMember {
  std::string key;
  Position where;  ///< of the key's opening quote
  Json value;
};

/// "an object", "a string", ... for messages.
std::string_view describe(Json::Kind kind);
/// The value as a person would write it in a message, shortened: `"big"`, `12`, `[...]`.
std::string excerpt(const Json& value);

/// A text as a JSON string, in its double quotes. Bytes that are not UTF-8 become U+FFFD.
std::string quote_json(std::string_view text);

/// Parses a text. Syntax errors, duplicate keys and numbers out of range are added to `errors`; a syntax error yields nothing.
std::optional<Json> parse_json(const SourceTextPtr& text, Diagnostics& errors);
/// Reads a whole text file. Throws Error(fault) when it is missing, unreadable or larger than `max_bytes`.
SourceTextPtr read_text(const std::filesystem::path& file, Fault fault, std::size_t max_bytes = std::size_t{64} << 20);

}  // namespace quell
