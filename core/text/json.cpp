#include "quell/text/json.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "quell/text/json_clean.h"
#include "quell/text/json_syntax.h"

namespace quell {
namespace {

// Builds a Json from nlohmann's events. These come without places, so a cursor walks through the text from token to token.
class Builder {
 public:
  Builder(const SourceTextPtr& source, std::string_view text, Diagnostics& errors)
      : source_(source), text_(text), errors_(errors) {}

  Json take() { return std::move(root_); }

  // The parser's events; each returns whether to go on.
  bool null() { return add(Json::Kind::null), true; }
  bool boolean(bool value) { return add(Json::Kind::boolean).boolean = value, true; }
  bool number_integer(std::int64_t value) {
    Json& json = add(Json::Kind::integer);
    json.integer = value, json.number = static_cast<double>(value);
    return true;
  }
  bool number_unsigned(std::uint64_t value) {
    if (value <= std::uint64_t{std::numeric_limits<std::int64_t>::max()}) return number_integer(static_cast<std::int64_t>(value));
    return number_float(static_cast<double>(value), {});
  }
  bool number_float(double value, const std::string&) { return add(Json::Kind::number).number = value, true; }
  bool string(std::string& value) { return add(Json::Kind::string).string = std::move(value), true; }
  bool binary(nlohmann::json::binary_t&) { return false; }  // does not occur in text
  bool start_object(std::size_t) { return open_.push_back(&add(Json::Kind::object)), true; }
  bool start_array(std::size_t) { return open_.push_back(&add(Json::Kind::array)), true; }
  bool end_object() { return drop_duplicates(*open_.back()), close(); }
  bool end_array() { return close(); }
  bool key(std::string& name) {
    open_.back()->members.push_back({std::move(name), next_token(), {}});
    after_key_ = true;
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) {
    skip_separator();
    if (error.id == 406) {  // a number beyond the range of double
      errors_.error({source_, cursor_}, "this number is too large; the largest is about 1.8e308");
      return false;
    }
    detail::JsonSyntaxError found;
    found.text = text_;
    found.token_begin = position <= cursor_ ? token_ : cursor_;  // "01": the parser took 0, the cursor the whole word
    found.stopped_at = std::min(position, text_.size());
    found.in_object = !open_.empty() && open_.back()->kind == Json::Kind::object;
    found.in_array = !open_.empty() && open_.back()->kind == Json::Kind::array;
    found.after_key = after_key_;
    errors_.error({source_, found.token_begin}, detail::explain(found));
    return false;
  }

 private:
  void skip_space() {
    while (cursor_ < text_.size() && std::strchr(" \t\r\n", text_[cursor_])) ++cursor_;
  }
  // At most the one ',' or ':' that may stand before the next token.
  void skip_separator() {
    skip_space();
    const bool follows_value = !after_key_ && cursor_ > 0 && token_ < cursor_ && !std::strchr("{[", text_[token_]);
    if (cursor_ < text_.size() && text_[cursor_] == (after_key_ ? ':' : ',') && (after_key_ || follows_value)) ++cursor_;
    skip_space();
  }
  // The place of the next token; the cursor moves behind it.
  Position next_token() {
    skip_separator();
    token_ = cursor_;
    const char first = text_[cursor_++];
    if (first == '"') {
      for (; text_[cursor_] != '"'; ++cursor_)
        if (text_[cursor_] == '\\') ++cursor_;
      ++cursor_;
    } else if (!std::strchr("{}[]", first)) {
      while (cursor_ < text_.size() &&
             (std::isalnum(static_cast<unsigned char>(text_[cursor_])) || std::strchr("+-._", text_[cursor_])))
        ++cursor_;
    }
    return {source_, token_};
  }
  Json& add(Json::Kind kind) {
    Json* json = &root_;
    if (!open_.empty()) json = after_key_ ? &open_.back()->members.back().value : &open_.back()->elements.emplace_back();
    json->kind = kind, json->where = next_token();
    after_key_ = false;
    return *json;
  }
  bool close() {
    next_token();
    open_.pop_back();
    return true;
  }
  // Tells every key that stands twice in an object, and keeps the first.
  void drop_duplicates(Json& object) {
    std::vector<std::size_t> order(object.members.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto key = [&](std::size_t i) -> const std::string& { return object.members[i].key; };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
    std::vector<bool> repeats(order.size(), false);
    for (std::size_t i = 1, first = 0; i < order.size(); ++i) {
      if (key(order[i]) != key(order[first])) {
        first = i;
        continue;
      }
      repeats[order[i]] = true;
      const int line = object.members[order[first]].where.line();
      errors_.error(object.members[order[i]].where,
                    "the key '" + key(order[i]) + "' is there already, in line " + std::to_string(line) + "; expected it once");
    }
    std::size_t index = 0;
    std::erase_if(object.members, [&](const JsonMember&) { return repeats[index++]; });
  }

  const SourceTextPtr& source_;
  std::string_view text_;
  Diagnostics& errors_;
  Json root_;
  std::vector<Json*> open_;  // only the innermost grows, so the others stay where they are
  std::size_t token_ = 0;    // where the last token begins
  std::size_t cursor_ = 0;   // behind it
  bool after_key_ = false;
};

/// The beginning of a text, as a JSON string.
std::string quote_beginning(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::size_t end = std::min(text.size(), kLongest);
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  std::string result = quote_json(text.substr(0, end));
  if (end < text.size()) result.insert(result.size() - 1, "...");
  return result;
}

}  // namespace

const Json* Json::find(std::string_view key) const {
  const auto found = std::find_if(members.begin(), members.end(), [&](const JsonMember& member) { return member.key == key; });
  return found == members.end() ? nullptr : &found->value;
}

std::string_view describe(Json::Kind kind) {
  switch (kind) {
    case Json::Kind::null:
      return "null";
    case Json::Kind::boolean:
      return "true or false";
    case Json::Kind::integer:
      return "an integer";
    case Json::Kind::number:
      return "a number";
    case Json::Kind::string:
      return "a string";
    case Json::Kind::array:
      return "a list";
    case Json::Kind::object:
      return "an object";
  }
  return "";
}

std::string excerpt(const Json& value) {
  switch (value.kind) {
    case Json::Kind::null:
      return "null";
    case Json::Kind::boolean:
      return value.boolean ? "true" : "false";
    case Json::Kind::integer:
      return std::to_string(value.integer);
    case Json::Kind::number: {
      char text[32];
      return {text, std::to_chars(text, text + sizeof(text), value.number).ptr};
    }
    case Json::Kind::string:
      return quote_beginning(value.string);
    case Json::Kind::array:
      return value.elements.empty() ? "[]" : "[...]";
    case Json::Kind::object:
      return value.members.empty() ? "{}" : "{...}";
  }
  return "";
}

std::string quote_json(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::optional<Json> parse_json(const SourceTextPtr& text, Diagnostics& errors) {
  const std::optional<std::string> clean = detail::clean_json(text, errors);
  if (!clean) return std::nullopt;
  Builder builder(text, *clean, errors);
  if (!nlohmann::json::sax_parse(*clean, &builder)) return std::nullopt;
  return builder.take();
}

SourceTextPtr read_text(const std::filesystem::path& file, Fault fault, std::size_t max_bytes) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) throw Error(fault, file.string(), "is a folder; expected a file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(fault, file.string(), std::string("cannot be opened: ") + std::strerror(errno));
  auto text = std::make_shared<SourceText>();
  text->name = file.string();
  std::string block(std::size_t{1} << 16, '\0');
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0) {
    text->text.append(block, 0, static_cast<std::size_t>(stream.gcount()));
    if (text->text.size() > max_bytes)
      throw Error(fault, file.string(), "is larger than " + std::to_string(max_bytes >> 20) + " MiB, the most that is read");
  }
  if (stream.bad()) throw Error(fault, file.string(), "cannot be read");
  if (text->text.starts_with("\xEF\xBB\xBF")) text->text.erase(0, 3);  // columns count from the first visible character
  return text;
}

}  // namespace quell
