// What the schema asks of a node, pass by pass.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "quell/graph/parameters.h"
#include "quell/graph/schema_parts.h"
#include "quell/graph/versions.h"

namespace quell::detail {
namespace {

const quell_param_desc& param_of(const quell_pass_desc& pass, std::uint32_t i) {
  return *QUELL_AT(quell_param_desc, pass.params, i);
}
const quell_port_desc& input_of(const quell_pass_desc& pass, std::uint32_t i) {
  return *QUELL_AT(quell_port_desc, pass.inputs, i);
}

// The default as it would be written in a graph; nothing where JSON has no such number.
std::optional<Json> default_json(const quell_param_desc& desc) {
  Json list = to_json_value(*desc.default_value, {});
  for (Json& element : list.elements) {
    if (element.kind == Json::Kind::number && !std::isfinite(element.number)) return std::nullopt;
    if (desc.type == QUELL_PARAM_ENUM) element = make_json(desc.enum_values[element.integer]);
  }
  return desc.is_array ? std::move(list) : Json(list.elements.at(0));
}

// Whole numbers keep to what 64 bits hold; numbers may have no bounds.
void add_range(const quell_param_desc& desc, JsonMembers& schema) {
  const auto bound = [&](double value) {
    if (desc.type == QUELL_PARAM_DOUBLE) return make_json(value);
    if (value < -0x1p63) return make_json(std::numeric_limits<std::int64_t>::min());
    if (value >= 0x1p63) return make_json(std::numeric_limits<std::int64_t>::max());
    return make_json(static_cast<std::int64_t>(value < 0 ? std::ceil(value) : std::floor(value)));
  };
  const auto is_bound = [&](double value) { return desc.type == QUELL_PARAM_INT || std::isfinite(value); };
  if (is_bound(desc.min_value)) schema.add("minimum", bound(desc.min_value));
  if (is_bound(desc.max_value)) schema.add("maximum", bound(desc.max_value));
}

JsonMembers one_value_schema(const quell_param_desc& desc) {
  JsonMembers schema;
  switch (desc.type) {
    case QUELL_PARAM_BOOL:
      return std::move(schema.add("type", "boolean"));
    case QUELL_PARAM_ENUM:
      schema.add("enum", std::vector<std::string>(desc.enum_values, desc.enum_values + desc.enum_count));
      return std::move(
          schema.add("enumDescriptions", std::vector<std::string>(desc.enum_docs, desc.enum_docs + desc.enum_count)));
    case QUELL_PARAM_INT:
    case QUELL_PARAM_DOUBLE:
      add_range(desc, schema.add("type", desc.type == QUELL_PARAM_INT ? "integer" : "number"));
      return schema;
    default:
      return std::move(schema.add("type", "string").add("pattern", std::string(kNoZeroPattern)));
  }
}

Json param_schema(const quell_param_desc& desc) {
  const std::optional<Json> standard = default_json(desc);
  std::string takes = "Takes " + expected_value(desc);
  if (standard) takes += "; " + write_json(*standard, std::numeric_limits<std::size_t>::max()) + " by default";
  std::erase(takes, '\n');
  const std::string doc = desc.doc;
  JsonMembers schema;
  schema.add("description", doc + (doc.empty() ? "" : "\n") + takes + ".");
  schema.add("markdownDescription", to_markdown(doc) + (doc.empty() ? "" : "\n\n") + to_markdown(takes) + ".");
  if (desc.is_array) {
    schema.add("type", "array").add("minItems", std::int64_t{desc.min_count});
    if (desc.max_count != std::numeric_limits<std::uint32_t>::max()) schema.add("maxItems", std::int64_t{desc.max_count});
    schema.add("items", one_value_schema(desc).take());
  } else {
    for (JsonMember& member : one_value_schema(desc).take().members) schema.add(member.key, std::move(member.value));
  }
  if (standard) schema.add("default", *standard);
  return schema.take();
}

// A name that a parameter had in earlier versions.
struct FormerName {
  std::string name;
  std::uint32_t last_version = 0;  // that had it
  std::set<std::uint32_t> params;  // what it means; another one, perhaps, in another version
};

std::vector<FormerName> former_names(const quell_pass_desc& pass) {
  std::vector<FormerName> names;
  for (std::uint32_t i = 0; i < pass.change_count; ++i) {
    const quell_change& change = *QUELL_AT(quell_change, pass.changes, i);
    const std::uint32_t version = change.version - 1;
    if (!change.renamed_to || version < pass.oldest_version) continue;
    const std::optional<std::uint32_t> param = find_param(pass, version, change.param);
    if (!param) continue;
    auto known = std::find_if(names.begin(), names.end(), [&](const FormerName& other) { return other.name == change.param; });
    if (known == names.end()) known = names.insert(names.end(), {change.param, 0, {}});
    known->last_version = std::max(known->last_version, version);
    known->params.insert(*param);
  }
  return names;
}

Json former_schema(const quell_pass_desc& pass, const FormerName& former) {
  std::vector<Json> meanings;
  for (const std::uint32_t param : former.params) meanings.push_back(param_schema(param_of(pass, param)));
  const std::string today = param_of(pass, *former.params.rbegin()).name;
  return JsonMembers()
      .add("anyOf", std::move(meanings))
      .add("deprecationMessage", "Since version " + std::to_string(former.last_version + 1) + " it is called '" + today + "'.")
      .take();
}

bool is_name_of_today(const quell_pass_desc& pass, const std::string& name) {
  for (std::uint32_t i = 0; i < pass.param_count; ++i)
    if (name == param_of(pass, i).name) return true;
  return false;
}

Json params_schema(const quell_pass_desc& pass, const std::vector<FormerName>& former) {
  JsonMembers params;
  for (std::uint32_t i = 0; i < pass.param_count; ++i) {
    std::vector<Json> meanings{param_schema(param_of(pass, i))};
    for (const FormerName& other : former)
      if (other.name == param_of(pass, i).name) meanings.push_back(former_schema(pass, other));
    params.add(param_of(pass, i).name,
               meanings.size() == 1 ? std::move(meanings[0]) : JsonMembers().add("anyOf", std::move(meanings)).take());
  }
  for (const FormerName& other : former)
    if (!is_name_of_today(pass, other.name)) params.add(other.name, former_schema(pass, other));
  Json schema = closed_object(params.take());
  std::vector<Json> twice;
  for (const FormerName& other : former) {
    if (other.params.size() != 1 || is_name_of_today(pass, other.name)) continue;
    const std::vector<Json> both{make_json(other.name), make_json(param_of(pass, *other.params.begin()).name)};
    twice.push_back(JsonMembers().add("not", JsonMembers().add("required", both).take()).take());
  }
  if (!twice.empty()) schema.members.push_back({"allOf", {}, make_json(std::move(twice))});
  return schema;
}

// A former name needs a version that had it.
std::vector<Json> version_conditions(const quell_pass_desc& pass, const std::vector<FormerName>& former) {
  std::vector<Json> conditions;
  for (const FormerName& other : former) {
    if (is_name_of_today(pass, other.name)) continue;
    const Json has_it = JsonMembers().add("required", std::vector<Json>{make_json(other.name)}).take();
    const Json condition = JsonMembers()
                               .add("required", std::vector<Json>{make_json("params")})
                               .add("properties", JsonMembers().add("params", has_it).take())
                               .take();
    const Json version = JsonMembers().add("maximum", std::int64_t{other.last_version}).take();
    const Json then = JsonMembers()
                          .add("required", std::vector<Json>{make_json("version")})
                          .add("properties", JsonMembers().add("version", version).take())
                          .take();
    conditions.push_back(JsonMembers().add("if", condition).add("then", then).take());
  }
  return conditions;
}

Json version_schema(const quell_pass_desc& pass) {
  return JsonMembers()
      .add("description", kVersionDoc)
      .add("type", "integer")
      .add("minimum", std::int64_t{pass.oldest_version})
      .add("maximum", std::int64_t{pass.version})
      .add("default", std::int64_t{pass.version})
      .take();
}

Json port_schema(const quell_port_desc& port, EdgeSchemas& edges) {
  const bool optional = port.flags & QUELL_PORT_OPTIONAL, is_array = port.flags & QUELL_PORT_ARRAY;
  const std::string takes = "Takes " + std::string(is_array ? "a list of " : "") + quell::describe(Types{port.types}) +
                            (is_array ? ", or one alone" : "") + (optional ? "; optional." : ".");
  const std::string doc = port.doc;
  JsonMembers schema;
  schema.add("description", doc + (doc.empty() ? "" : "\n") + takes);
  schema.add("markdownDescription", to_markdown(doc) + (doc.empty() ? "" : "\n\n") + to_markdown(takes));
  Json source = edges.refer(port.types, optional);
  if (!is_array) return schema.add("allOf", std::vector<Json>{std::move(source)}).take();
  JsonMembers list;
  if (!optional) list.add("minItems", 1);
  schema.add("if", JsonMembers().add("type", "array").take());
  schema.add("then", list.add("items", source).take());
  return schema.add("else", std::move(source)).take();
}

std::vector<std::string> required_inputs(const quell_pass_desc& pass) {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < pass.input_count; ++i)
    if (!(input_of(pass, i).flags & QUELL_PORT_OPTIONAL)) names.emplace_back(input_of(pass, i).name);
  return names;
}

Json in_schema(const quell_pass_desc& pass, EdgeSchemas& edges) {
  JsonMembers ports;
  for (std::uint32_t i = 0; i < pass.input_count; ++i) ports.add(input_of(pass, i).name, port_schema(input_of(pass, i), edges));
  Json schema = closed_object(ports.take());
  const std::vector<std::string> required = required_inputs(pass);
  if (!required.empty()) schema.members.push_back({"required", {}, make_json(required)});
  return schema;
}

std::string markdown_of(const quell_pass_desc& pass) {
  std::string text = "**" + to_markdown(pass.id) + "**, version " + std::to_string(pass.version);
  for (const char* paragraph : {pass.summary, pass.doc})
    if (*paragraph) text += "\n\n" + to_markdown(paragraph);
  std::string outputs;
  for (std::uint32_t i = 0; i < pass.output_count; ++i) {
    const quell_port_desc& port = *QUELL_AT(quell_port_desc, pass.outputs, i);
    outputs += "\n- `" + std::string(port.name) + "`" + (*port.doc ? ": " + to_markdown(port.doc) : "");
  }
  text += "\n\nOutputs:\n" + outputs;
  return *pass.source ? text + "\n\n*Source:* " + to_markdown(pass.source) : text;
}

}  // namespace

Json pass_schema(const quell_pass_desc& pass, EdgeSchemas& edges) {
  const std::vector<FormerName> former = former_names(pass);
  JsonMembers properties;
  properties.add("version", version_schema(pass));
  properties.add("in", in_schema(pass, edges));
  properties.add("params", params_schema(pass, former));
  JsonMembers schema;
  schema.add("description", std::string(pass.summary)).add("markdownDescription", markdown_of(pass));
  schema.add("properties", properties.take());
  if (!required_inputs(pass).empty()) schema.add("required", std::vector<Json>{make_json("in")});
  if (std::vector<Json> conditions = version_conditions(pass, former); !conditions.empty())
    schema.add("allOf", std::move(conditions));
  return schema.take();
}

Json pass_snippet(const quell_pass_desc& pass) {
  JsonMembers in;
  int number = 0;
  for (std::uint32_t i = 0; i < pass.input_count; ++i) {
    const quell_port_desc& port = input_of(pass, i);
    if (port.flags & QUELL_PORT_OPTIONAL) continue;
    Json source = make_json("${" + std::to_string(++number) + ":" + port.name + "}");
    in.add(port.name, port.flags & QUELL_PORT_ARRAY ? make_json(std::vector<Json>{std::move(source)}) : std::move(source));
  }
  JsonMembers body;
  body.add("pass", std::string(pass.id));
  if (!in.empty()) body.add("in", in.take());
  return JsonMembers()
      .add("label", std::string(pass.id))
      .add("description", std::string(pass.summary))
      .add("body", body.take())
      .take();
}

}  // namespace quell::detail
