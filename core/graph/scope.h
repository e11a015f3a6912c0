// Subgraphs unfolded: a tree of scopes, one for every use of a graph file, with the nodes that run a pass as leaves. Private to
// this box.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quell/graph/document.h"

namespace quell::detail {

struct Scope;

/// What a node turned out to be. Neither a leaf nor a scope: it is broken, which was told.
struct Child {
  int leaf = -1;  ///< index into Unfolded::leaves
  std::unique_ptr<Scope> scope;
};

/// One use of a graph file.
struct Scope {
  const Document* document = nullptr;
  std::string prefix;                 ///< of the names of its nodes: "", "svgf.", "svgf.variance."
  const Scope* parent = nullptr;      ///< null for the graph itself
  const WrittenNode* node = nullptr;  ///< of the parent; null for the graph itself
  std::map<std::string, Child, std::less<>> children;

  /// Where this scope comes from, for errors inside of it: the innermost first.
  std::vector<Note> included_from() const;
  std::vector<std::string> node_names() const;
  /// The node of that name; null when there is none.
  const WrittenNode* find_node(std::string_view name) const;
  /// Index of the input of that name; -1 when there is none.
  int find_input(std::string_view name) const;
};

/// An edge as it arrives at a port, whatever subgraphs lie between.
struct Arrival {
  enum class State {
    connected,
    absent,  ///< an optional input of a subgraph that is not connected
    broken,  ///< does not lead anywhere, which was told
  } state = State::broken;
  Edge edge;
  Position initial_where;        ///< of the initial value, or of the edge
  std::optional<PortType> type;  ///< declared by the subgraph's input that it came through
  bool none_was_told = false;    ///< that input is not optional, so "none" was told there already
};

/// A value that was set, and by whom.
struct SetParam {
  std::optional<ParamValue> value;  ///< nothing: the pass's default, or broken
  const Scope* set_in = nullptr;    ///< the file that set it last; null when only a default did
  Position where;
};

/// A node that runs a pass. It keeps its place in the list even when its pass is not known.
struct Leaf {
  std::string name;
  const WrittenNode* written = nullptr;
  const Scope* scope = nullptr;
  const quell_pass_desc* pass = nullptr;  ///< null: broken, which was told
  std::vector<SetParam> params;
  bool params_are_broken = false;
  std::vector<std::vector<Arrival>> inputs;  ///< for each input port of the pass

  const quell_pass_desc* swapped_from = nullptr;  ///< the pass that the file names, where --swap chose another
  std::uint32_t swapped_version = 0;              ///< of it, as the file names it
  std::vector<std::string> left_out;              ///< its parameters that the file sets and the other pass does not take

  const quell_port_desc& input(std::size_t i) const { return *QUELL_AT(quell_port_desc, pass->inputs, i); }
  const quell_port_desc& output(std::size_t i) const { return *QUELL_AT(quell_port_desc, pass->outputs, i); }
  const quell_param_desc& param(std::size_t i) const { return *QUELL_AT(quell_param_desc, pass->params, i); }
};

/// The whole tree. Documents are shared by the scopes that use one file.
struct Unfolded {
  std::map<std::filesystem::path, std::optional<Document>> documents;
  Scope root;
  std::vector<Leaf> leaves;                       ///< in the order of the files
  std::vector<std::unique_ptr<Document>> edited;  ///< copies of documents, for scopes that --swap and --bypass change
};

/// Reads the graph and every graph that it includes, and looks up the passes. Nothing when the graph itself is
/// unreadable, or too large.
std::unique_ptr<Unfolded> unfold(const SourceTextPtr& source, const Registry& passes, Diagnostics& errors);

}  // namespace quell::detail
