#include "quell/graph/outside.h"

#include "quell/graph/fields.h"

namespace quell::detail {
namespace {

// Lets a value that was parsed from a copy of a text stand in the text itself.
void move_to(Json& value, const SourceTextPtr& source) {
  value.where.source = source;
  for (Json& element : value.elements) move_to(element, source);
  for (JsonMember& member : value.members) {
    member.where.source = source;
    move_to(member.value, source);
  }
}

std::optional<Setting> read_set(const std::string& option, Diagnostics& errors) {
  const auto source = std::make_shared<SourceText>(SourceText{"--set", option});
  const std::size_t equals = option.find('=');
  if (equals == std::string::npos || equals == 0) {
    errors.error({source, 0}, "expected a parameter and its value, such as 'filter.radius=8'");
    return std::nullopt;
  }
  Setting setting;
  setting.target = {option.substr(0, equals), {source, 0}};
  Json text;
  text.kind = Json::Kind::string, text.string = option.substr(equals + 1), text.where = {source, equals + 1};
  // The value is parsed where it stands, with spaces in front, so that its places are those of the option.
  const auto padded = std::make_shared<SourceText>(SourceText{"--set", std::string(equals + 1, ' ') + text.string});
  Diagnostics ignored;  // what is no JSON is plain text
  std::optional<Json> value = parse_json(padded, ignored);
  if (value && ignored.empty() && value->kind != Json::Kind::string) {
    move_to(*value, source);
    setting.plain = text;
  } else if (value && ignored.empty()) {
    move_to(*value, source);
  } else {
    value = text;
  }
  setting.value = std::move(*value);
  return setting;
}

// {"node": {"param": value}} is the same as {"node.param": value}.
void flatten(const Json& object, const std::string& prefix, const std::filesystem::path& folder, std::vector<Setting>& settings) {
  for (const JsonMember& member : object.members) {
    const std::string name = prefix + member.key;
    if (member.value.kind == Json::Kind::object)
      flatten(member.value, name + ".", folder, settings);
    else
      settings.push_back({{name, member.where}, member.value, {}, folder});
  }
}

}  // namespace

std::vector<Setting> read_outside(const GraphOptions& options, Diagnostics& errors) {
  std::vector<Setting> settings;
  for (const std::filesystem::path& file : options.params) {
    try {
      const SourceTextPtr source = read_text(file, Fault::usage, kLargestFile);
      const std::optional<Json> root = parse_json(source, errors);
      if (root && expect(*root, Json::Kind::object, "a file of parameters", errors))
        flatten(*root, "", file.parent_path(), settings);
    } catch (const Error& error) { errors.error({}, "--params " + std::string(error.what())); }
  }
  for (const std::string& option : options.set)
    if (std::optional<Setting> setting = read_set(option, errors)) settings.push_back(std::move(*setting));
  return settings;
}

}  // namespace quell::detail
