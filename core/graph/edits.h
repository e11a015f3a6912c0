// Variants of a graph that are not in its file: --swap gives a node another pass, --bypass short-circuits it. Both change the
// documents of the scopes that they name, before anything is connected, so that whatever follows sees the changed graph. Private
// to this box.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "quell/graph/scope.h"

namespace quell::detail {

/// A node that an option names.
struct EditedNode {
  Scope* scope = nullptr;
  const WrittenNode* node = nullptr;
  const Child* child = nullptr;
};

/// An output as a source names it: "parts.items[1]".
struct OutputName {
  std::string_view node, port, item;  ///< item is "[1]", or ""
};
/// Nothing for the name of a graph input.
std::optional<OutputName> split_source(std::string_view source);

/// A place in a document that names a source.
struct Reader {
  Text& from;
  const WrittenNode* node = nullptr;  ///< null: the outputs of the graph, or its reset
  std::string_view input;             ///< of the node
  std::string label;                  ///< "the input 'color' of 'blend'"
};
/// Calls for every source of a document that is an output of `node`.
void for_each_reader(Document& document, std::string_view node, const std::function<void(const Reader&)>& call);

/// The document of a scope, which from now on belongs to it alone and may be changed.
Document& own_document(Unfolded& graph, Scope& scope);

class Edits {
 public:
  Edits(Unfolded& graph, const Registry& passes, Diagnostics& errors) : graph_(graph), passes_(passes), errors_(errors) {}

  void apply(const GraphOptions& options);
  /// What was changed, when all parameters have been set.
  std::vector<std::string> describe() const;
  /// Throws the errors found so far; where they are not of an option itself, they may be due to one, which is said.
  void throw_if_any() const;

 private:
  struct Made {
    std::string option;  ///< "--swap filter=atrous"
    int leaf = -1;       ///< whose parameters may have been left out
    std::vector<std::string> changes;
  };
  std::optional<EditedNode> find(const Text& path);
  void swap(const Text& option);
  void bypass(const Text& option);

  Unfolded& graph_;
  const Registry& passes_;
  Diagnostics& errors_;
  std::vector<Made> made_;
  bool are_right_ = true;
};

/// Gives a node another pass. Returns what changed; an error at `option` leaves the node as it is.
std::vector<std::string> swap_pass(Unfolded& graph, const EditedNode& edited, const quell_pass_desc& pass, const Position& option,
                                   Diagnostics& errors);

/// Lets whoever reads the node's outputs read its inputs instead. Returns what changed; an error at `option` changes nothing.
std::vector<std::string> bypass_node(Unfolded& graph, const EditedNode& edited, const Position& option, Diagnostics& errors);

}  // namespace quell::detail
