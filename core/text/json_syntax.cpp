#include "quell/text/json_syntax.h"

#include <cctype>

namespace quell::detail {
namespace {

constexpr std::string_view kBefore = "{[,:";  // what stands before a key or a value
constexpr std::string_view kStraightQuotes = "; text stands in straight double quotes";

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '$'; }
bool is_number_start(char c) { return std::isdigit(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '.'; }
bool starts_value(char c) { return c == '"' || c == '{' || c == '[' || is_word(c) || is_number_start(c); }

// The word, number or single character at the start of `text`, in quotes.
std::string quote_token(std::string_view text) {
  std::size_t end = 0;
  const bool number = is_number_start(text[0]);
  while (end < text.size() && end < 30 && (is_word(text[end]) || (number && is_number_start(text[end])))) ++end;
  if (end == 0)  // a single character, which may take several bytes
    for (end = 1; end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80;) ++end;
  return "'" + std::string(text.substr(0, end)) + "'";
}

bool is_other_quote(std::string_view text) {
  return text[0] == '\'' || text[0] == '`' || text.starts_with("\u201C") || text.starts_with("\u201D") ||
         text.starts_with("\u2018") || text.starts_with("\u2019");
}

// `token` is a string as far as the parser read it.
std::string explain_string(std::string_view token) {
  const std::size_t escape = token.rfind('\\');
  if (escape == std::string_view::npos) return "a control character inside of a string";
  if (token.substr(escape, 2) == "\\u") return "'\\u' takes four hexadecimal digits, and a surrogate its other half";
  return "unknown escape '" + std::string(token.substr(escape)) + "' in this string; a backslash is written '\\\\'";
}

std::string explain_missing_value(std::string_view rest) {
  const char c = rest[0];
  if (c == ',' || c == '}' || c == ']') return std::string("expected a value before this '") + c + "'";
  if (is_other_quote(rest)) return "unexpected " + quote_token(rest) + std::string(kStraightQuotes);
  if (is_number_start(c)) return quote_token(rest) + " is no JSON number; expected one like 8, -0.5 or 1e-3";
  if (is_word(c))
    return "unknown word " + quote_token(rest) + "; expected true, false, null, a number, or text in straight double quotes";
  return "unexpected " + quote_token(rest) + "; expected a value";
}

std::string explain_missing_key(std::string_view rest) {
  if (rest[0] == ',') return "one ',' too many; expected a key in double quotes";
  if (is_other_quote(rest)) return "unexpected " + quote_token(rest) + std::string(kStraightQuotes);
  if (is_word(rest[0])) return "the key " + quote_token(rest) + " needs straight double quotes";
  return "unexpected " + quote_token(rest) + "; expected a key in double quotes";
}

}  // namespace

std::string explain(const JsonSyntaxError& error) {
  const std::string_view text = error.text;
  const std::size_t before = text.substr(0, error.token_begin).find_last_not_of(" \t\r\n");
  const char previous = before == std::string_view::npos ? '\0' : text[before];
  if (error.token_begin >= text.size()) return previous == '\0' ? "the text is empty; expected a JSON object" : "unexpected end";
  const std::string_view rest = text.substr(error.token_begin);
  const bool inside = error.in_object || error.in_array;
  // A string that may stand here can only be at fault itself.
  if (rest[0] == '"' && (previous == '\0' || kBefore.find(previous) != std::string_view::npos))
    return explain_string(text.substr(error.token_begin, error.stopped_at - error.token_begin));
  if (previous == '{' || (previous == ',' && error.in_object)) return explain_missing_key(rest);
  if (previous == '\0' || kBefore.find(previous) != std::string_view::npos) return explain_missing_value(rest);
  if (error.after_key) return "expected ':' between the key and its value, got " + quote_token(rest);
  if (!inside) return "unexpected " + quote_token(rest) + " after the end of the value; expected the end of the text";
  if (starts_value(rest[0])) return "missing ',' before this";
  if (rest[0] == ':' && error.in_array) return "unexpected ':' in a list; only an object, in braces, has keys";
  return "unexpected " + quote_token(rest) + (error.in_object ? "; expected ',' or '}'" : "; expected ',' or ']'");
}

}  // namespace quell::detail
