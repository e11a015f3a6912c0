#include "quell/graph/fields.h"

#include <algorithm>

namespace quell::detail {
namespace {

bool is_snake_case(std::string_view name) {
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name[0] >= 'a' && name[0] <= 'z' && std::all_of(name.begin(), name.end(), allowed);
}

}  // namespace

std::string suggest(std::string_view misspelt, const std::vector<std::string>& names, std::string_view none) {
  if (names.empty()) return std::string(none);
  const std::string close = did_you_mean(misspelt, names);
  return close.empty() ? "; expected " + list_names(names) : close;
}

bool is_meant(const std::string& name, const std::vector<std::string>& misspelt) {
  return std::any_of(misspelt.begin(), misspelt.end(), [&](const std::string& other) { return !nearest(other, {name}).empty(); });
}

bool expect(const Json& value, Json::Kind kind, std::string_view what, Diagnostics& errors) {
  if (value.kind == kind) return true;
  errors.error(value.where, std::string(what) + " must be " + std::string(describe(kind)) + ", not " + excerpt(value));
  return false;
}

bool expect_name(const JsonMember& member, std::string_view what, Diagnostics& errors) {
  if (is_snake_case(member.key)) return true;
  errors.error(member.where, "'" + member.key + "' cannot be the name of " + std::string(what) +
                                 "; expected small letters, digits and '_', starting with a letter");
  return false;
}

Fields::Fields(const Json& object, std::string what, const std::vector<std::string>& keys, Diagnostics& errors)
    : object_(object), errors_(errors) {
  for (const JsonMember& member : object.members)
    if (std::find(keys.begin(), keys.end(), member.key) == keys.end()) {
      has_unknown_ = true;
      errors.error(member.where, "unknown key '" + member.key + "' in " + what + suggest(member.key, keys));
    }
}

const Json* Fields::find(std::string_view key, Json::Kind kind) const {
  const Json* value = object_.find(key);
  return value && expect(*value, kind, "\"" + std::string(key) + "\"", errors_) ? value : nullptr;
}

std::optional<Text> Fields::text(std::string_view key) const {
  const Json* value = find(key, Json::Kind::string);
  return value ? std::optional(Text{value->string, value->where}) : std::nullopt;
}

std::string Fields::text_or_empty(std::string_view key) const {
  const Json* value = find(key, Json::Kind::string);
  return value ? value->string : "";
}

bool Fields::flag(std::string_view key) const {
  const Json* value = find(key, Json::Kind::boolean);
  return value && value->boolean;
}

}  // namespace quell::detail
