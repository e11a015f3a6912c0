// The "nodes" of a graph file, and the edges in their "in".
#include <algorithm>
#include <limits>

#include "quell/graph/document.h"
#include "quell/graph/fields.h"

namespace quell::detail {
namespace {

std::optional<WrittenInitial> read_initial(const Json& value, Diagnostics& errors) {
  const std::string expected = "; expected \"none\", {\"constant\": [...]} or {\"from\": \"node.port\"}";
  WrittenInitial initial;
  initial.where = value.where;
  if (value.kind == Json::Kind::string && value.string == "none") return initial;
  if (value.kind != Json::Kind::object) {
    errors.error(value.where, "\"initial\" cannot be " + excerpt(value) + expected);
    return std::nullopt;
  }
  const Fields fields(value, "an initial value", {"constant", "from"}, errors);
  if ((fields.any("constant") != nullptr) == (fields.any("from") != nullptr)) {
    errors.error(value.where, "\"initial\" must have either \"constant\" or \"from\"" + expected);
    return std::nullopt;
  }
  if (const std::optional<Text> from = fields.text("from")) {
    initial.kind = Initial::Kind::endpoint, initial.from = *from;
    return initial;
  }
  const Json* constant = fields.find("constant", Json::Kind::array);
  if (!constant) return std::nullopt;
  initial.kind = Initial::Kind::constant;
  for (const Json& element : constant->elements) {
    if (!element.is_number()) {
      errors.error(element.where, "a constant must be a number, not " + excerpt(element));
      return std::nullopt;
    }
    initial.constant.push_back(element.number);
  }
  return initial;
}

bool read_delay(const Fields& fields, WrittenEdge& edge, Diagnostics& errors) {
  const Json* delay = fields.find("delay", Json::Kind::integer);
  if (!delay) return false;
  edge.delay_where = delay->where;
  edge.delay = static_cast<int>(std::clamp(delay->integer, -std::int64_t{kLongestDelay}, std::int64_t{kLongestDelay}));
  if (edge.delay == delay->integer) return true;
  errors.error(delay->where,
               "a delay of " + excerpt(*delay) + " frames is too long; the most is " + std::to_string(kLongestDelay));
  return false;
}

std::optional<WrittenEdge> read_delayed_edge(const Json& value, Diagnostics& errors) {
  const Fields fields(value, "an edge", {"from", "delay", "initial"}, errors);
  WrittenEdge edge;
  edge.where = value.where, edge.delay_where = value.where;
  const std::optional<Text> from = fields.text("from");
  if (!fields.any("from")) errors.error(value.where, "the key \"from\" is missing; expected the source, \"from\": \"node.port\"");
  bool is_whole = from.has_value() && !fields.has_unknown();
  if (fields.any("delay")) is_whole = read_delay(fields, edge, errors) && is_whole;
  if (const Json* initial = fields.any("initial")) {
    if (!fields.any("delay") && !fields.has_unknown())
      errors.error(initial->where, "only an edge with a delay has an initial value; expected \"delay\": 1 beside it");
    edge.initial = read_initial(*initial, errors);
    is_whole = is_whole && edge.initial;
  } else if (edge.delay != 0) {
    errors.error(edge.delay_where,
                 "an edge with a delay needs an initial value, for when there is no such frame; expected \"initial\": \"none\", "
                 "{\"constant\": [...]} or {\"from\": \"node.port\"}");
    return std::nullopt;
  }
  if (!is_whole) return std::nullopt;
  edge.from = *from;
  return edge;
}

std::optional<WrittenEdge> read_edge(const Json& value, Diagnostics& errors) {
  if (value.kind == Json::Kind::object) return read_delayed_edge(value, errors);
  if (value.kind == Json::Kind::string) return WrittenEdge{{value.string, value.where}, 0, value.where, {}, value.where};
  errors.error(value.where,
               "a source must be a string like \"node.port\" or an object with \"from\" and \"delay\", not " + excerpt(value));
  return std::nullopt;
}

WrittenPort read_port(const JsonMember& member, Diagnostics& errors) {
  WrittenPort port;
  port.name = {member.key, member.where};
  port.value_where = member.value.where;
  port.is_list = member.value.kind == Json::Kind::array;
  const auto add = [&](const Json& value) {
    if (std::optional<WrittenEdge> edge = read_edge(value, errors))
      port.edges.push_back(std::move(*edge));
    else
      port.is_broken = true;
  };
  if (port.is_list)
    for (const Json& element : member.value.elements) add(element);
  else
    add(member.value);
  return port;
}

void read_version(const Fields& fields, WrittenNode& node, Diagnostics& errors) {
  const Json* version = fields.find("version", Json::Kind::integer);
  if (!version) return;
  node.version_where = version->where;
  if (version->integer < 1 || version->integer > std::numeric_limits<std::int32_t>::max())
    errors.error(version->where, "versions of passes count from 1; got " + excerpt(*version));
  else
    node.version = static_cast<std::uint32_t>(version->integer);
  if (node.graph) errors.error(version->where, "\"version\" is that of a pass; a node with \"graph\" has none: remove it");
}

WrittenNode read_node(const JsonMember& member, Diagnostics& errors) {
  WrittenNode node;
  node.name = {member.key, member.where};
  node.params_where = member.where;
  const Fields fields(member.value, "a node", {"pass", "graph", "in", "params", "version", "doc"}, errors);
  node.doc = fields.text_or_empty("doc");
  node.pass = fields.text("pass");
  node.graph = fields.text("graph");
  if (fields.any("pass") && fields.any("graph")) {
    errors.error(member.where, "the node '" + member.key + "' has both \"pass\" and \"graph\"; expected one of them");
    node.pass.reset(), node.graph.reset();
  } else if (!fields.any("pass") && !fields.any("graph")) {
    errors.error(member.where, "the node '" + member.key + "' does nothing; expected \"pass\": \"...\" or \"graph\": \"...\"");
  }
  read_version(fields, node, errors);
  if (const Json* in = fields.find("in", Json::Kind::object))
    for (const JsonMember& port : in->members) node.in.push_back(read_port(port, errors));
  for (const JsonMember& outer : member.value.members)
    if (outer.key == "params") node.params_where = outer.where;
  if (const Json* params = fields.find("params", Json::Kind::object))
    for (const JsonMember& param : params->members) node.params.push_back({{param.key, param.where}, param.value});
  return node;
}

}  // namespace

std::vector<WrittenNode> read_nodes(const Json& nodes, Diagnostics& errors) {
  std::vector<WrittenNode> result;
  for (const JsonMember& member : nodes.members) {
    expect_name(member, "a node", errors);
    if (expect(member.value, Json::Kind::object, "a node", errors))
      result.push_back(read_node(member, errors));
    else
      result.push_back({{member.key, member.where}, {}, {}, {}, {}, {}, {}, {}, {}});
  }
  return result;
}

}  // namespace quell::detail
