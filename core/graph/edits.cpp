#include "quell/graph/edits.h"

#include <algorithm>

#include "quell/graph/fields.h"

namespace quell::detail {
namespace {

Text as_text(const char* name, const std::string& value) {
  return {value, {std::make_shared<SourceText>(SourceText{name, value}), 0}};
}

std::string list(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

}  // namespace

std::optional<OutputName> split_source(std::string_view source) {
  const std::size_t dot = source.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const std::size_t bracket = std::min(source.find('[', dot), source.size());
  return OutputName{source.substr(0, dot), source.substr(dot + 1, bracket - dot - 1), source.substr(bracket)};
}

void for_each_reader(Document& document, std::string_view node, const std::function<void(const Reader&)>& call) {
  const auto is_meant = [&](const Text& from) {
    const std::optional<OutputName> source = split_source(from.text);
    return source && source->node == node;
  };
  for (WrittenNode& reader : document.nodes)
    for (WrittenPort& port : reader.in)
      for (WrittenEdge& edge : port.edges) {
        const std::string label = "the input '" + port.name.text + "' of '" + reader.name.text + "'";
        if (is_meant(edge.from)) call({edge.from, &reader, port.name.text, label});
        if (edge.initial && is_meant(edge.initial->from)) call({edge.initial->from, &reader, port.name.text, label});
      }
  for (WrittenOutput& output : document.outputs)
    if (is_meant(output.from)) call({output.from, nullptr, {}, "the output '" + output.name.text + "' of the graph"});
  if (document.reset && is_meant(*document.reset)) call({*document.reset, nullptr, {}, "the reset of the graph"});
}

Document& own_document(Unfolded& graph, Scope& scope) {
  for (const std::unique_ptr<Document>& own : graph.edited)
    if (own.get() == scope.document) return *own;
  Document& copy = *graph.edited.emplace_back(std::make_unique<Document>(*scope.document));
  scope.document = &copy;
  for (const WrittenNode& node : copy.nodes) {
    Child& child = scope.children.at(node.name.text);
    if (child.leaf >= 0) graph.leaves[static_cast<std::size_t>(child.leaf)].written = &node;
    if (child.scope) child.scope->node = &node;
  }
  return copy;
}

void Edits::apply(const GraphOptions& options) {
  const std::size_t before = errors_.size();
  for (const std::string& option : options.swap) swap(as_text("--swap", option));
  for (const std::string& option : options.bypass) bypass(as_text("--bypass", option));
  are_right_ = errors_.size() == before;
}

std::optional<EditedNode> Edits::find(const Text& path) {
  Scope* scope = &graph_.root;
  std::string_view rest = path.text;
  while (true) {
    const std::size_t dot = rest.find('.');
    const std::string_view name = rest.substr(0, dot);
    const std::string graph =
        scope->parent ? "the graph '" + scope->prefix.substr(0, scope->prefix.size() - 1) + "'" : "the graph";
    const WrittenNode* node = scope->find_node(name);
    if (!node) {
      errors_.error(path.where, graph + " has no node '" + std::string(name) + "'" + suggest(name, scope->node_names()));
      return std::nullopt;
    }
    const Child& child = scope->children.at(node->name.text);
    if (dot == std::string_view::npos) return EditedNode{scope, node, &child};
    if (!child.scope) {
      if (child.leaf >= 0)
        errors_.error(path.where, "the node '" + std::string(name) + "' runs a pass, and has no nodes in it; expected '" +
                                      std::string(path.text.substr(0, path.text.size() - rest.size() + dot)) + "'");
      return std::nullopt;
    }
    scope = child.scope.get();
    rest.remove_prefix(dot + 1);
  }
}

void Edits::swap(const Text& option) {
  const std::size_t equals = option.text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == option.text.size())
    return errors_.error(option.where, "expected a node and the pass that it is to run, such as 'filter=joint_bilateral'");
  const std::optional<EditedNode> edited = find({option.text.substr(0, equals), option.where});
  if (!edited) return;
  if (edited->child->scope)
    return errors_.error(option.where, "the node '" + edited->node->name.text + "' is a graph; expected one of its nodes" +
                                           suggest("", edited->child->scope->node_names()));
  const Position pass_where{option.where.source, equals + 1};
  const std::string id = option.text.substr(equals + 1);
  const RegisteredPass* pass = passes_.find(id);
  if (!pass) {
    std::vector<std::string> names;
    for (const auto& [name, registered] : passes_.passes()) names.push_back(name);
    const std::string close = did_you_mean(id, names);
    return errors_.error(pass_where,
                         "unknown pass '" + id + "'" + (close.empty() ? "; 'quell passes' lists those that are there" : close));
  }
  const Leaf& leaf = graph_.leaves[static_cast<std::size_t>(edited->child->leaf)];
  if (!leaf.pass) return;  // unknown, which was told
  if (leaf.swapped_from) return errors_.error(option.where, "'" + leaf.name + "' is swapped twice; expected one pass");
  made_.push_back({"--swap " + option.text, edited->child->leaf, {}});
  made_.back().changes = swap_pass(graph_, *edited, *pass->desc, option.where, errors_);
}

void Edits::bypass(const Text& option) {
  const std::optional<EditedNode> edited = find(option);
  if (!edited) return;
  const int leaf = edited->child->leaf;
  if (leaf >= 0 && graph_.leaves[static_cast<std::size_t>(leaf)].swapped_from)
    return errors_.error(option.where, "'" + option.text + "' is swapped and bypassed; expected one of the two");
  made_.push_back({"--bypass " + option.text, -1, {}});
  made_.back().changes = bypass_node(graph_, *edited, option.where, errors_);
}

std::vector<std::string> Edits::describe() const {
  std::vector<std::string> lines;
  for (const Made& made : made_) {
    std::vector<std::string> changes = made.changes;
    const std::vector<std::string> none;
    const std::vector<std::string>& params = made.leaf < 0 ? none : graph_.leaves[static_cast<std::size_t>(made.leaf)].left_out;
    if (!params.empty())
      changes.push_back("the parameter" + std::string(params.size() > 1 ? "s " : " ") + list_names(params, "and") +
                        " of the file " + (params.size() > 1 ? "are" : "is") + " left out");
    lines.push_back(made.option + (changes.empty() ? "" : ": " + list(changes)));
  }
  return lines;
}

void Edits::throw_if_any() const {
  if (errors_.empty() || made_.empty() || !are_right_) return errors_.throw_if_any();
  std::vector<std::string> options;
  for (const Made& made : made_) options.push_back(made.option);
  throw Error(Fault::usage, "", errors_.render() + "\nnote: this is the graph as changed by " + list(options));
}

}  // namespace quell::detail
