#include "quell/graph/scope.h"

#include <algorithm>
#include <cstddef>

#include "quell/graph/fields.h"
#include "quell/graph/versions.h"

namespace quell::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDeepestGraph = 50;   // graphs within graphs
constexpr std::size_t kMostNodes = 10'000;  // files that include each other repeatedly grow without end

// The same file by whatever way it is named.
fs::path identity(const fs::path& file) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(file, error);
  return error ? file.lexically_normal() : canonical;
}

class Unfolder {
 public:
  Unfolder(const Registry& passes, Diagnostics& errors) : passes_(passes), errors_(errors) {}

  std::unique_ptr<Unfolded> run(const SourceTextPtr& source) {
    const fs::path key = identity(source->name);
    std::optional<Document>& document = result_->documents[key];
    document = read_document(source, errors_);
    if (!document) return nullptr;
    result_->root.document = &*document;
    fill(result_->root, {{key, source->name}});
    if (node_count_ > kMostNodes) return nullptr;
    return std::move(result_);
  }

 private:
  struct Inclusion {
    fs::path key;
    std::string name;
  };
  using Chain = std::vector<Inclusion>;  // the files that lead to a scope, outermost first

  void fill(Scope& scope, const Chain& chain) {
    for (const WrittenNode& node : scope.document->nodes) {
      if (++node_count_ > kMostNodes) return tell_too_many();
      Child& child = scope.children[node.name.text];
      if (node.graph) {
        child.scope = include(scope, node, chain);
      } else {
        child.leaf = static_cast<int>(result_->leaves.size());
        result_->leaves.push_back(make_leaf(scope, node));
      }
    }
  }

  void tell_too_many() {
    errors_.error(result_->root.document->nodes.front().name.where,
                  "the graph has more than " + std::to_string(kMostNodes) + " nodes, those of its subgraphs included");
  }

  std::nullptr_t refuse(const Scope& scope, const WrittenNode& node, std::string why) {
    errors_.error(node.graph->where, std::move(why), scope.included_from());
    return nullptr;
  }

  std::unique_ptr<Scope> include(const Scope& scope, const WrittenNode& node, Chain chain) {
    const std::string& path = node.graph->text;
    if (path.empty() || path.find('\0') != std::string::npos)
      return refuse(scope, node, "this names no file; expected the path of a graph, from this file's folder");
    if (chain.size() > kDeepestGraph)
      return refuse(scope, node, "graphs are nested more than " + std::to_string(kDeepestGraph) + " deep");
    const fs::path file = (scope.document->folder() / path).lexically_normal();
    const fs::path key = identity(file);
    chain.push_back({key, file.string()});
    if (const auto first = std::find_if(chain.begin(), chain.end() - 1, [&](const Inclusion& i) { return i.key == key; });
        first != chain.end() - 1) {
      std::string names = first->name;
      for (auto next = first + 1; next != chain.end(); ++next) names += " -> " + next->name;
      return refuse(scope, node, "a graph cannot include itself: " + names);
    }
    const std::optional<Document>& document = load(file, key, *node.graph, scope);
    if (!document) return nullptr;
    auto inner = std::make_unique<Scope>();
    inner->document = &*document;
    inner->prefix = scope.prefix + node.name.text + ".";
    inner->parent = &scope, inner->node = &node;
    fill(*inner, chain);
    return inner;
  }

  const std::optional<Document>& load(const fs::path& file, const fs::path& key, const Text& named, const Scope& scope) {
    const auto [it, is_new] = result_->documents.try_emplace(key);
    if (!is_new) return it->second;
    try {
      it->second = read_document(read_text(file, Fault::usage, kLargestFile), errors_);
    } catch (const Error& error) {
      const std::string reason = std::string(error.what()).substr(error.where().size() + 2);  // behind "file: "
      errors_.error(named.where, "the graph '" + file.string() + "' " + reason, scope.included_from());
    }
    return it->second;
  }

  Leaf make_leaf(const Scope& scope, const WrittenNode& node) {
    Leaf leaf;
    leaf.name = scope.prefix + node.name.text;
    leaf.written = &node, leaf.scope = &scope;
    if (!node.pass) return leaf;
    const RegisteredPass* pass = passes_.find(node.pass->text);
    if (!pass) {
      tell_unknown_pass(*node.pass, scope);
      return leaf;
    }
    const std::string refused = node.version ? refuse_version(*pass->desc, *node.version) : "";
    if (!refused.empty()) {
      errors_.error(node.version_where, refused, scope.included_from());
      return leaf;
    }
    leaf.pass = pass->desc;
    leaf.params.resize(pass->desc->param_count);
    leaf.inputs.resize(pass->desc->input_count);
    return leaf;
  }

  void tell_unknown_pass(const Text& pass, const Scope& scope) {
    std::vector<std::string> names;
    for (const auto& [name, registered] : passes_.passes()) names.push_back(name);
    std::vector<Note> notes = scope.included_from();
    std::vector<std::string> folders;
    for (const fs::path& folder : passes_.folders()) folders.push_back(folder.string());
    if (!folders.empty()) notes.push_back({{}, "plugins were looked for in " + list_names(folders, "and")});
    for (const PluginReport& report : passes_.reports())
      if (!report.error.empty()) notes.push_back({{}, "the plugin " + report.file.string() + " was not loaded: " + report.error});
    if (was_told_of_folders_) notes = scope.included_from();
    was_told_of_folders_ = true;
    const std::string close = did_you_mean(pass.text, names);
    errors_.error(pass.where,
                  "unknown pass '" + pass.text + "'" + (close.empty() ? "; 'quell passes' lists those that are there" : close),
                  std::move(notes));
  }

  const Registry& passes_;
  Diagnostics& errors_;
  std::unique_ptr<Unfolded> result_ = std::make_unique<Unfolded>();
  std::size_t node_count_ = 0;
  bool was_told_of_folders_ = false;
};

}  // namespace

std::vector<Note> Scope::included_from() const {
  std::vector<Note> notes;
  for (const Scope* scope = this; scope->parent; scope = scope->parent)
    notes.push_back(
        {scope->node->graph->where, "included from here, as '" + scope->prefix.substr(0, scope->prefix.size() - 1) + "'"});
  return notes;
}

std::vector<std::string> Scope::node_names() const {
  std::vector<std::string> names;
  for (const WrittenNode& written : document->nodes) names.push_back(written.name.text);
  return names;
}

const WrittenNode* Scope::find_node(std::string_view name) const {
  const auto found = std::find_if(document->nodes.begin(), document->nodes.end(),
                                  [&](const WrittenNode& written) { return written.name.text == name; });
  return found == document->nodes.end() ? nullptr : &*found;
}

int Scope::find_input(std::string_view name) const {
  const auto found =
      std::find_if(document->inputs.begin(), document->inputs.end(), [&](const GraphInput& input) { return input.name == name; });
  return found == document->inputs.end() ? -1 : static_cast<int>(found - document->inputs.begin());
}

std::unique_ptr<Unfolded> unfold(const SourceTextPtr& source, const Registry& passes, Diagnostics& errors) {
  return Unfolder(passes, errors).run(source);
}

}  // namespace quell::detail
