// The sources of inputs in the schema.
#include <algorithm>
#include <limits>
#include <set>

#include "quell/graph/document.h"
#include "quell/graph/schema_parts.h"

namespace quell::detail {
namespace {

Json number_list(Json element) { return JsonMembers().add("type", "array").add("items", std::move(element)).take(); }

// Lists of that many elements. The numbers are ascending.
void limit_counts(JsonMembers& list, const std::set<int>& counts) {
  const int least = *counts.begin(), most = *counts.rbegin();
  if (most - least + 1 == static_cast<int>(counts.size())) {
    list.add("minItems", least).add("maxItems", most);
    return;
  }
  std::vector<Json> choices;
  for (const int count : counts) choices.push_back(JsonMembers().add("minItems", count).add("maxItems", count).take());
  list.add("anyOf", std::move(choices));
}

// One number or one for each plane, as it fits one of the types.
std::vector<Json> constant_lists(Types types) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  std::set<int> counts;
  for (int type = 0; type < QUELL_TYPE_COUNT; ++type) {
    const PortType port = static_cast<PortType>(type);
    if (accepts(types, port) && is_image(port) && port != QUELL_TYPE_ID) counts.insert({1, info(port).channels});
  }
  std::vector<Json> lists;
  if (!counts.empty()) {
    JsonMembers list;
    list.add("type", "array");
    list.add("items", JsonMembers().add("type", "number").add("minimum", -kLargest).add("maximum", kLargest).take());
    limit_counts(list, counts);
    lists.push_back(list.take());
  }
  if (accepts(types, QUELL_TYPE_ID)) {
    JsonMembers list;
    list.add("type", "array");
    list.add("items", JsonMembers().add("type", "integer").add("minimum", 0).add("maximum", std::int64_t{QUELL_NO_ID}).take());
    limit_counts(list, {1});
    lists.push_back(list.take());
  }
  if (accepts(types, QUELL_TYPE_VALUE)) {
    Json list = number_list(JsonMembers().add("type", "number").take());
    list.members.push_back({"minItems", {}, make_json(1)});
    lists.push_back(std::move(list));
  }
  return lists;
}

Json none_schema() {
  return JsonMembers()
      .add("enum", std::vector<Json>{make_json("none")})
      .add("description", "Nothing: the input counts as not connected in such a frame. Only where the port is optional.")
      .take();
}

Json object_with(const std::string& key, Json value) {
  Json object = closed_object(JsonMembers().add(key, std::move(value)).take());
  object.members.push_back({"required", {}, make_json(std::vector<Json>{make_json(key)})});
  return object;
}

std::vector<Json> initial_snippets(bool optional, bool has_constants) {
  std::vector<Json> snippets;
  const auto add = [&](const char* label, Json body) {
    snippets.push_back(JsonMembers().add("label", label).add("body", std::move(body)).take());
  };
  if (optional) add("none", make_json("none"));
  if (has_constants) add("a constant", JsonMembers().add("constant", std::vector<Json>{make_json("^${1:0}")}).take());
  add("another source", JsonMembers().add("from", "${1:node.port}").take());
  return snippets;
}

// What is well formed as an initial value, whether it suits a port or not.
Json loose_initial_schema() {
  Json numbers = number_list(JsonMembers().add("type", "number").take());
  std::vector<Json> choices{none_schema(), object_with("constant", std::move(numbers)),
                            object_with("from", text_schema(kSourcePattern, "What stands at that place in the same frame."))};
  return JsonMembers().add("anyOf", std::move(choices)).take();
}

// What may stand for a missing frame on an edge that arrives at such a port.
Json initial_schema(Types types, bool optional) {
  std::vector<Json> choices;
  if (optional) choices.push_back(none_schema());
  std::vector<Json> constants = constant_lists(types);
  const bool has_constants = !constants.empty();
  if (has_constants) {
    Json list = constants.size() == 1 ? std::move(constants[0]) : JsonMembers().add("anyOf", std::move(constants)).take();
    list.members.push_back({"description", {}, make_json("An image of that value: one number, or one for each plane.")});
    choices.push_back(object_with("constant", std::move(list)));
  }
  choices.push_back(object_with("from", text_schema(kSourcePattern, "What stands at that place in the same frame.")));
  return JsonMembers()
      .add("description", "What stands for a frame that is not part of the run, has failed, or had another size.")
      .add("anyOf", std::move(choices))
      .add("defaultSnippets", initial_snippets(optional, has_constants))
      .take();
}

// Without a delay an initial value is never used; then its form alone counts.
Json when_delayed(Types types, bool optional, JsonMembers edge) {
  const auto with_initial = [](Json initial) { return JsonMembers().add("initial", std::move(initial)).take(); };
  const Json zero = JsonMembers().add("const", 0).take();
  const Json delayed = JsonMembers().add("delay", JsonMembers().add("not", zero).take()).take();
  edge.add("if", JsonMembers().add("required", std::vector<Json>{make_json("delay")}).add("properties", delayed).take());
  edge.add("then", JsonMembers()
                       .add("required", std::vector<Json>{make_json("initial")})
                       .add("properties", with_initial(initial_schema(types, optional)))
                       .take());
  edge.add("else", JsonMembers().add("properties", with_initial(refer_to("initial"))).take());
  return edge.take();
}

std::vector<Json> edge_snippets(bool optional) {
  JsonMembers delayed;
  delayed.add("from", "${1:node.port}").add("delay", "^${2:1}");
  if (optional)
    delayed.add("initial", "none");
  else
    delayed.add("initial", JsonMembers().add("constant", std::vector<Json>{make_json("^${3:0}")}).take());
  return {JsonMembers().add("label", "a source").add("body", "${1:node.port}").take(),
          JsonMembers().add("label", "of an earlier frame").add("body", delayed.take()).take()};
}

// Keywords that speak of strings leave objects alone, and the other way round, so that no choice between the two is needed, whose
// messages would be vague.
Json edge_schema(Types types, bool optional) {
  JsonMembers properties;
  properties.add("from", text_schema(kSourcePattern, "The source: \"node.port\", or the name of an input of the graph."));
  properties.add("delay",
                 JsonMembers()
                     .add("description", "How many frames back; below 0 looks ahead, which only inputs of the graph can.")
                     .add("type", "integer")
                     .add("minimum", -kLongestDelay)
                     .add("maximum", kLongestDelay)
                     .add("default", 1)
                     .take());
  properties.add("initial", make_json(true));
  JsonMembers edge;
  edge.add("type", std::vector<Json>{make_json("string"), make_json("object")});
  edge.add("pattern", std::string(kSourcePattern));
  edge.add("patternErrorMessage", "A source is \"node.port\", \"node.port[1]\" or the name of an input of the graph.");
  edge.add("additionalProperties", false);
  edge.add("required", std::vector<Json>{make_json("from")});
  edge.add("properties", properties.take());
  edge.add("dependencies", JsonMembers().add("initial", std::vector<Json>{make_json("delay")}).take());
  edge.add("defaultSnippets", edge_snippets(optional));
  return when_delayed(types, optional, std::move(edge));
}

}  // namespace

Json EdgeSchemas::refer(Types types, bool optional) {
  definitions_.try_emplace("initial", loose_initial_schema());
  std::string name =
      std::string("source_for_") + (optional ? "optional_" : "") + (types == kAllTypes ? "anything" : quell::describe(types));
  std::erase(name, ',');
  std::replace(name.begin(), name.end(), ' ', '_');
  definitions_.try_emplace(name, edge_schema(types, optional));
  return refer_to(name);
}

}  // namespace quell::detail
