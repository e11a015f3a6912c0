// Every parameter of every node gets its value: the pass's default, the node's "params", the graphs' parameters, and last what
// comes from outside. Private to this box.
#pragma once

#include <map>
#include <utility>

#include "quell/graph/parameters.h"
#include "quell/graph/scope.h"

namespace quell::detail {

/// A value for "node.param", "subgraph.param", "subgraph.node.param" or, from outside, a parameter of the graph itself.
struct Setting {
  Text target;
  Json value;
  std::optional<Json> plain;     ///< the same as text, for parameters that are text
  std::filesystem::path folder;  ///< relative paths are taken from it
};

class Settings {
 public:
  Settings(Unfolded& graph, Diagnostics& errors) : graph_(graph), errors_(errors) {}

  /// All that the files say, inner graphs first, so that outer ones win.
  void apply_files();
  /// A setting from outside.
  void apply(const Setting& setting);

  /// A parameter of a leaf.
  struct Slot {
    Leaf* leaf;
    std::uint32_t param;
    auto operator<=>(const Slot&) const = default;
  };
  /// What a parameter of the graph itself sets, after apply_files().
  std::vector<Slot> set_by(const WrittenParam& param) { return find_own(graph_.root, param.name, param.name.text); }

 private:
  void apply_files(const Scope& scope);
  void apply_former_defaults(Leaf& leaf);
  void apply_node_params(const Scope& scope, const WrittenNode& node);
  std::vector<Slot> find(const Scope& scope, const Text& target, std::string_view path);
  std::vector<Slot> find_own(const Scope& scope, const Text& target, std::string_view name);
  std::vector<Slot> find_in(const Scope& scope, const WrittenNode& node, const Text& target, std::string_view rest);
  std::vector<Slot> find_in_leaf(Leaf& leaf, const Text& target, std::string_view name);
  static std::vector<Slot> find_in_swapped(Leaf& leaf, std::uint32_t former);
  bool fits_swapped(Leaf& leaf, const quell_param_desc& desc, const Setting& setting);
  void assign(const std::vector<Slot>& slots, const Setting& setting, const Scope* by);

  Unfolded& graph_;
  Diagnostics& errors_;
  // What each graph's parameter sets, each slot once: through n subgraphs there may be 2^n ways to it.
  std::map<std::pair<const Scope*, const WrittenParam*>, std::vector<Slot>> own_;
  std::vector<Note> notes_;  // of the scope whose settings are being applied
};

}  // namespace quell::detail
