#include "quell/graph/schema.h"

#include "quell/graph/schema_parts.h"

namespace quell {
namespace {

using namespace detail;  // NOLINT: this file is the box's own

Json named_objects(Json value, std::string_view description, std::string_view names = kNamePattern) {
  return JsonMembers()
      .add("description", std::string(description))
      .add("type", "object")
      .add("propertyNames",
           JsonMembers()
               .add("pattern", std::string(names))
               .add("patternErrorMessage",
                    "Names have small letters, digits and '_', and start with a letter; no node is called 'input'.")
               .take())
      .add("additionalProperties", std::move(value))
      .take();
}

Json required(const std::vector<std::string>& keys) { return make_json(keys); }

Json text_schema(std::string_view description) {
  return JsonMembers().add("description", std::string(description)).add("type", "string").take();
}

Json type_schema() {
  std::vector<std::string> names, docs;
  for (int type = 0; type < QUELL_TYPE_COUNT; ++type) {
    const PortTypeInfo& known = info(static_cast<PortType>(type));
    names.emplace_back(known.name);
    docs.push_back((known.channels > 0 ? std::to_string(known.channels) + (known.channels > 1 ? " planes: " : " plane: ")
                                       : std::string("no image: ")) +
                   std::string(known.doc));
  }
  return JsonMembers().add("enum", names).add("enumDescriptions", docs).take();
}

Json inputs_schema() {
  const Json optional = JsonMembers()
                            .add("description", "Whether a sequence may lack it. What needs it is left out, then.")
                            .add("type", "boolean")
                            .add("default", false)
                            .take();
  Json object = closed_object(JsonMembers()
                                  .add("type", JsonMembers().add("allOf", std::vector<Json>{refer_to("type")}).take())
                                  .add("optional", optional)
                                  .add("doc", text_schema("What it is for."))
                                  .take());
  object.members.push_back({"required", {}, required({"type"})});
  Json input = JsonMembers()
                   .add("description", "An input: its type, or an object that says more.")
                   .add("anyOf", std::vector<Json>{refer_to("type"), std::move(object)})
                   .take();
  return named_objects(std::move(input), "What a sequence must offer, and of which type.");
}

// What any parameter of any pass could take.
Json any_value_schema() {
  const Json scalar = JsonMembers().add("type", required({"boolean", "number", "string"})).take();
  return JsonMembers()
      .add("description", "Set unless the graph's user sets another value. Without it, the defaults of the nodes stand.")
      .add("type", required({"boolean", "number", "string", "array"}))
      .add("items", scalar)
      .take();
}

Json params_schema() {
  Json target = JsonMembers()
                    .add("type", "string")
                    .add("pattern", R"(^[a-z][a-z0-9_]*(\.[a-z][a-z0-9_]*)+$)")
                    .add("patternErrorMessage", "A parameter of a node is written \"node.param\".")
                    .take();
  const Json sets = JsonMembers()
                        .add("description", "The parameters that it sets: \"node.param\".")
                        .add("type", "array")
                        .add("minItems", 1)
                        .add("items", std::move(target))
                        .take();
  Json param = closed_object(
      JsonMembers().add("default", any_value_schema()).add("sets", sets).add("doc", text_schema("What it does.")).take());
  param.members.push_back({"required", {}, required({"sets"})});
  const Json body = JsonMembers().add("default", "^$2").add("sets", std::vector<Json>{make_json("${1:node.param}")}).take();
  const Json snippet = JsonMembers().add("label", "a parameter").add("body", body).take();
  param.members.push_back({"defaultSnippets", {}, make_json(std::vector<Json>{snippet})});
  return named_objects(std::move(param), "What a user turns, for one or several nodes; of a subgraph, what shows outside.");
}

Json pass_ids_schema(const Registry& passes) {
  std::vector<std::string> ids, summaries;
  for (const auto& [id, pass] : passes.passes()) {
    ids.push_back(id);
    summaries.emplace_back(pass.desc->summary);
  }
  return JsonMembers()
      .add("description", "The pass that the node runs.")
      .add("enum", ids)
      .add("enumDescriptions", summaries)
      .take();
}

// A node that is another graph. Its ports and parameters stand in that file.
Json subgraph_schema(EdgeSchemas& edges) {
  const Json param_names = JsonMembers().add("pattern", R"(^[a-z][a-z0-9_]*(\.[a-z][a-z0-9_]*)*$)").take();
  const Json params = JsonMembers()
                          .add("description", "The other graph's params by name, or \"node.param\" of its nodes.")
                          .add("type", "object")
                          .add("propertyNames", param_names)
                          .add("additionalProperties", any_value_schema())
                          .take();
  return JsonMembers()
      .add("description", "Another graph as a node, with its inputs, outputs and params.")
      .add("properties", JsonMembers()
                             .add("in", named_objects(edges.refer(kAllTypes, true), "Sources for the inputs of the other graph."))
                             .add("params", params)
                             .add("pass", false)
                             .add("version", false)
                             .take())
      .take();
}

std::string definition_of(const std::string& pass) { return "pass_" + pass; }

Json node_properties(const Registry& passes) {
  const auto object = [](const char* description) {
    return JsonMembers().add("description", description).add("type", "object").take();
  };
  return JsonMembers()
      .add("pass", pass_ids_schema(passes))
      .add("graph", detail::text_schema("^[^\\u0000]+$", "Another graph that this node is: its path, from this file's folder."))
      .add("version", JsonMembers().add("description", kVersionDoc).add("type", "integer").add("minimum", 1).take())
      .add("in", object("The sources of the node's inputs: \"node.port\", or the name of an input of the graph."))
      .add("params", object("Parameters that differ from their defaults."))
      .add("doc", text_schema("What the node is for, or why it is set as it is."))
      .take();
}

Json node_schema(const Registry& passes) {
  std::vector<Json> conditions, snippets;
  for (const auto& [id, pass] : passes.passes()) {
    const Json runs_it = JsonMembers()
                             .add("required", required({"pass"}))
                             .add("properties", JsonMembers().add("pass", JsonMembers().add("const", id).take()).take())
                             .take();
    conditions.push_back(JsonMembers().add("if", runs_it).add("then", refer_to(definition_of(id))).take());
    snippets.push_back(pass_snippet(*pass.desc));
  }
  JsonMembers body;
  body.add("graph", "${1:file.json}").add("in", make_object());
  snippets.push_back(
      JsonMembers().add("label", "another graph").add("description", "A graph file as a node").add("body", body.take()).take());
  Json node = closed_object(node_properties(passes));
  const auto add = [&](const char* key, Json value) { node.members.push_back({key, {}, std::move(value)}); };
  add("if", JsonMembers().add("required", required({"graph"})).take());
  add("then", refer_to("subgraph"));
  add("else", JsonMembers().add("required", required({"pass"})).take());
  if (!conditions.empty()) add("allOf", make_json(std::move(conditions)));
  add("defaultSnippets", make_json(std::move(snippets)));
  return node;
}

// "input.color" is an input of the graph among the results, so no node has that name.
Json nodes_schema() {
  Json nodes =
      named_objects(refer_to("node"), "The nodes by name. Each runs a pass, or is another graph.", "^(?!input$)[a-z][a-z0-9_]*$");
  nodes.members.push_back({"minProperties", {}, make_json(1)});
  return nodes;
}

Json outputs_schema() {
  Json source = detail::text_schema(kSourcePattern, "Where it comes from: \"node.port\", or the name of an input of the graph.");
  Json outputs = named_objects(std::move(source), "What is written, by name.");
  outputs.members.push_back({"minProperties", {}, make_json(1)});
  return outputs;
}

Json root_properties() {
  const Json version =
      JsonMembers().add("description", "The version of the format: 1.").add("enum", std::vector<Json>{make_json(1)}).take();
  return JsonMembers()
      .add("$schema", text_schema("Where editors find this schema."))
      .add("quell", version)
      .add("name", text_schema("The graph's name; without it, that of its file."))
      .add("doc", text_schema("What the graph does, and after which paper."))
      .add("inputs", inputs_schema())
      .add("params", params_schema())
      .add("nodes", nodes_schema())
      .add("outputs", outputs_schema())
      .add("reset", detail::text_schema(kSourcePattern,
                                        "Of type value, a node's output or an input of the graph: where its first number is not "
                                        "0, the frame begins without history."))
      .take();
}

std::vector<Json> root_snippets() {
  Json body = JsonMembers()
                  .add("$schema", std::string(kSchemaFileName))
                  .add("quell", 1)
                  .add("doc", "$1")
                  .add("inputs", JsonMembers().add("color", "color").take())
                  .add("nodes", make_object())
                  .add("outputs", JsonMembers().add("color", "${2:node.port}").take())
                  .take();
  return {JsonMembers().add("label", "a graph").add("description", "An empty graph").add("body", std::move(body)).take()};
}

Json definitions(const Registry& passes) {
  EdgeSchemas edges;
  JsonMembers all;
  all.add("type", type_schema()).add("node", node_schema(passes)).add("subgraph", subgraph_schema(edges));
  for (const auto& [id, pass] : passes.passes()) all.add(definition_of(id), pass_schema(*pass.desc, edges));
  for (const auto& [name, schema] : edges.definitions()) all.add(name, schema);
  return all.take();
}

}  // namespace

namespace detail {

Json refer_to(std::string_view definition) {
  return JsonMembers().add("$ref", "#/definitions/" + std::string(definition)).take();
}

Json text_schema(std::string_view pattern, std::string_view description) {
  return JsonMembers()
      .add("description", std::string(description))
      .add("type", "string")
      .add("pattern", std::string(pattern))
      .take();
}

Json closed_object(Json properties) {
  return JsonMembers().add("type", "object").add("additionalProperties", false).add("properties", std::move(properties)).take();
}

std::string to_markdown(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (std::string_view(R"(\`*_[]<>)").find(c) != std::string_view::npos) out += '\\';
    out += c;
    if (c == '\n') out += '\n';  // a line of its own
  }
  return out;
}

}  // namespace detail

std::string graph_schema(const Registry& passes) {
  Json root = JsonMembers()
                  .add("$schema", "http://json-schema.org/draft-07/schema#")
                  .add("$id", std::string(kSchemaFileName))
                  .add("title", "quell graph")
                  .add("description", "A graph of passes that denoises an image sequence.")
                  .add("allowComments", true)
                  .add("allowTrailingCommas", true)
                  .take();
  for (JsonMember& member : closed_object(root_properties()).members) root.members.push_back(std::move(member));
  root.members.push_back({"required", {}, required({"quell", "nodes", "outputs"})});
  root.members.push_back({"defaultSnippets", {}, make_json(root_snippets())});
  root.members.push_back({"definitions", {}, definitions(passes)});
  return write_json(root);
}

}  // namespace quell
