// Says in plain words what is wrong where the JSON parser stopped.
#pragma once

#include <string>
#include <string_view>

namespace quell::detail {

/// What the parser had understood when it stopped.
struct JsonSyntaxError {
  std::string_view text;        ///< from clean_json
  std::size_t token_begin = 0;  ///< of the token that it did not accept
  std::size_t stopped_at = 0;   ///< how far the parser read
  bool in_object = false;       ///< the innermost open bracket is '{'
  bool in_array = false;        ///< it is '['
  bool after_key = false;       ///< the last thing understood was a key
};

std::string explain(const JsonSyntaxError& error);

}  // namespace quell::detail
