#include "quell/text/json_write.h"

#include <array>
#include <charconv>
#include <cmath>

namespace quell {
namespace {

constexpr double kLargestExact = 0x1p53;  // beyond it doubles leave integers out

std::string number(double value) {
  std::array<char, 32> text{};  // the shortest text that reads back as the same double has at most 24 characters
  const bool is_whole = std::abs(value) <= kLargestExact && std::trunc(value) == value;
  const std::to_chars_result end = is_whole
                                       ? std::to_chars(text.data(), text.data() + text.size(), static_cast<std::int64_t>(value))
                                       : std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

std::string plain(const Json& value) {
  switch (value.kind) {
    case Json::Kind::boolean:
      return value.boolean ? "true" : "false";
    case Json::Kind::integer:
      return std::to_string(value.integer);
    case Json::Kind::number:
      return std::isfinite(value.number) ? number(value.number) : "null";
    case Json::Kind::string:
      return quote_json(value.string);
    default:
      return "null";
  }
}

// In one line. Stops early, with a longer text than `room`, when that does not hold it.
std::string in_one_line(const Json& value, std::size_t room) {
  const bool is_object = value.kind == Json::Kind::object;
  if (!is_object && value.kind != Json::Kind::array) return plain(value);
  const std::size_t count = is_object ? value.members.size() : value.elements.size();
  if (count == 0) return is_object ? "{}" : "[]";
  std::string text = is_object ? "{ " : "[";
  for (std::size_t i = 0; i < count && text.size() <= room; ++i) {
    if (i > 0) text += ", ";
    if (is_object) text += quote_json(value.members[i].key) + ": ";
    text += in_one_line(is_object ? value.members[i].value : value.elements[i], room);
  }
  return text + (is_object ? " }" : "]");
}

// `before` bytes stand in front of the value in its line, and `after` follow it.
void write(const Json& value, std::size_t indent, std::size_t before, std::size_t after, std::size_t columns, std::string& out) {
  const bool is_object = value.kind == Json::Kind::object;
  if (std::string line = in_one_line(value, columns);
      before + line.size() + after <= columns || (!is_object && value.kind != Json::Kind::array)) {
    out += line;
    return;
  }
  const std::size_t count = is_object ? value.members.size() : value.elements.size();
  const std::string inner(indent + 2, ' ');
  out += is_object ? "{" : "[";
  for (std::size_t i = 0; i < count; ++i) {
    const std::string key = is_object ? quote_json(value.members[i].key) + ": " : "";
    out += (i > 0 ? ",\n" : "\n") + inner + key;
    const Json& element = is_object ? value.members[i].value : value.elements[i];
    write(element, indent + 2, inner.size() + key.size(), i + 1 < count ? 1 : 0, columns, out);
  }
  out += "\n" + std::string(indent, ' ') + (is_object ? "}" : "]");
}

}  // namespace

Json make_json(std::string_view text) {
  Json json;
  json.kind = Json::Kind::string, json.string = text;
  return json;
}

Json make_json(bool value) {
  Json json;
  json.kind = Json::Kind::boolean, json.boolean = value;
  return json;
}

Json make_json(std::int64_t value) {
  Json json;
  json.kind = Json::Kind::integer, json.integer = value, json.number = static_cast<double>(value);
  return json;
}

Json make_json(double value) {
  Json json;
  json.kind = Json::Kind::number, json.number = value;
  return json;
}

Json make_json(std::vector<Json> elements) {
  Json json;
  json.kind = Json::Kind::array, json.elements = std::move(elements);
  return json;
}

Json make_json(const std::vector<std::string>& texts) {
  std::vector<Json> elements;
  for (const std::string& text : texts) elements.push_back(make_json(text));
  return make_json(std::move(elements));
}

Json make_object() {
  Json json;
  json.kind = Json::Kind::object;
  return json;
}

JsonMembers& JsonMembers::add(std::string key, Json value) {
  object_.members.push_back({std::move(key), {}, std::move(value)});
  return *this;
}

std::string write_json(const Json& value, std::size_t columns) {
  std::string out;
  write(value, 0, 0, 0, columns, out);
  return out + "\n";
}

}  // namespace quell
