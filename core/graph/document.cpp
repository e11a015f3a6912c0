#include "quell/graph/document.h"

#include <map>

#include "quell/graph/fields.h"

namespace quell::detail {
namespace {

constexpr std::int64_t kFormatVersion = 1;

class Reader {
 public:
  Reader(const SourceTextPtr& source, Diagnostics& errors) : errors_(errors) { document_.source = source; }

  std::optional<Document> read(const Json& root) {
    if (!expect(root, Json::Kind::object, "a graph", errors_) || !check_version(root)) return std::nullopt;
    const Fields fields(root, "the graph", {"$schema", "quell", "name", "doc", "inputs", "params", "nodes", "outputs", "reset"},
                        errors_);
    fields.text_or_empty("$schema");
    document_.doc = fields.text_or_empty("doc");
    document_.name = fields.text_or_empty("name");
    if (document_.name.empty()) document_.name = std::filesystem::path(document_.source->name).stem().string();
    read_inputs(fields.find("inputs", Json::Kind::object));
    read_params(fields.find("params", Json::Kind::object));
    if (const Json* nodes = required(root, fields, "nodes", "at least one node")) document_.nodes = read_nodes(*nodes, errors_);
    if (const Json* outputs = required(root, fields, "outputs", "at least one output")) read_outputs(*outputs);
    document_.reset = fields.text("reset");
    check_names();
    return std::move(document_);
  }

 private:
  // The version comes first: a newer format may have keys that would only confuse.
  bool check_version(const Json& root) {
    const Json* version = root.find("quell");
    if (!version) {
      errors_.error(root.where, "the key \"quell\" is missing; expected the version of the format, \"quell\": 1");
      return true;
    }
    if (!expect(*version, Json::Kind::integer, "\"quell\", the version of the format,", errors_)) return true;
    if (version->integer == kFormatVersion) return true;
    const std::string number = std::to_string(version->integer);
    if (version->integer < kFormatVersion) {
      errors_.error(version->where, "there is no version " + number + " of the format; expected \"quell\": 1");
      return true;
    }
    errors_.error(version->where,
                  "this graph has version " + number + " of the format; this quell reads version 1: a newer quell is needed");
    return false;
  }

  const Json* required(const Json& root, const Fields& fields, const std::string& key, const std::string& content) {
    std::vector<std::string> keys;
    for (const JsonMember& member : root.members) keys.push_back(member.key);
    if (!fields.any(key) && !is_meant(key, keys))
      errors_.error(root.where, "the key \"" + key + "\" is missing; a graph has " + content);
    const Json* value = fields.find(key, Json::Kind::object);
    if (value && value->members.empty()) errors_.error(value->where, "\"" + key + "\" is empty; a graph has " + content);
    return value;
  }

  void read_inputs(const Json* inputs) {
    if (!inputs) return;
    for (const JsonMember& member : inputs->members) {
      GraphInput input;
      input.name = member.key, input.where = member.where;
      expect_name(member, "an input", errors_);
      bool is_known = false;
      if (member.value.kind == Json::Kind::object) {
        const Fields fields(member.value, "an input", {"type", "optional", "doc"}, errors_);
        input.optional = fields.flag("optional");
        input.doc = fields.text_or_empty("doc");
        if (!fields.any("type")) errors_.error(member.value.where, "the key \"type\" is missing" + suggest("", type_names()));
        const Json* type = fields.find("type", Json::Kind::string);
        is_known = type && read_type(*type, input);
      } else if (member.value.kind == Json::Kind::string) {
        is_known = read_type(member.value, input);
      } else {
        errors_.error(member.value.where,
                      "an input must be the name of a type, or an object with \"type\", not " + excerpt(member.value));
      }
      document_.inputs.push_back(std::move(input));
      document_.broken_inputs.push_back(!is_known);
    }
  }

  static std::vector<std::string> type_names() {
    std::vector<std::string> names;
    for (int type = 0; type < QUELL_TYPE_COUNT; ++type) names.emplace_back(name(static_cast<PortType>(type)));
    return names;
  }
  bool read_type(const Json& value, GraphInput& input) {
    const std::optional<PortType> type = port_type(value.string);
    input.type = type.value_or(input.type);
    if (!type) errors_.error(value.where, "unknown type '" + value.string + "'" + suggest(value.string, type_names()));
    return type.has_value();
  }

  void read_params(const Json* params) {
    if (!params) return;
    for (const JsonMember& member : params->members) {
      expect_name(member, "a parameter", errors_);
      if (!expect(member.value, Json::Kind::object, "a parameter of the graph", errors_)) continue;
      const Fields fields(member.value, "a parameter of the graph", {"default", "sets", "doc"}, errors_);
      fields.text_or_empty("doc");
      WrittenParam param{{member.key, member.where}, {}, {}};
      if (const Json* value = fields.any("default")) param.value = *value;
      const Json* sets = fields.find("sets", Json::Kind::array);
      if (!fields.any("sets") || (sets && sets->elements.empty()))
        errors_.error(sets ? sets->where : member.value.where,
                      "the parameter '" + member.key + "' sets nothing; expected \"sets\": [\"node.param\", ...]");
      for (const Json& target : sets ? sets->elements : std::vector<Json>())
        if (expect(target, Json::Kind::string, "what a parameter sets", errors_))
          param.sets.push_back({target.string, target.where});
      document_.params.push_back(std::move(param));
    }
  }

  void read_outputs(const Json& outputs) {
    for (const JsonMember& member : outputs.members) {
      expect_name(member, "an output", errors_);
      if (expect(member.value, Json::Kind::string, "the source of an output, \"node.port\",", errors_))
        document_.outputs.push_back({{member.key, member.where}, {member.value.string, member.value.where}});
    }
  }

  void check_names() {
    std::map<std::string_view, const GraphInput*> inputs;
    for (const GraphInput& input : document_.inputs) inputs.emplace(input.name, &input);
    for (const WrittenNode& node : document_.nodes) {
      if (node.name.text == "input")
        errors_.error(node.name.where,
                      "a node cannot be called 'input': 'input.color' is the graph input 'color' among the results; expected "
                      "another name");
      if (const auto same = inputs.find(node.name.text); same != inputs.end())
        errors_.error(node.name.where, "the node '" + node.name.text + "' has the name of the input in line " +
                                           std::to_string(same->second->where.line()) +
                                           "; expected another name for one of them");
    }
  }

  Document document_;
  Diagnostics& errors_;
};

}  // namespace

std::optional<Document> read_document(const SourceTextPtr& source, Diagnostics& errors) {
  const std::optional<Json> root = parse_json(source, errors);
  return root ? Reader(source, errors).read(*root) : std::nullopt;
}

}  // namespace quell::detail
