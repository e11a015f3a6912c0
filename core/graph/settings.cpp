#include "quell/graph/settings.h"

#include <algorithm>

#include "quell/graph/fields.h"
#include "quell/graph/versions.h"

namespace quell::detail {
namespace {

std::vector<std::string> own_params(const Scope& scope) {
  std::vector<std::string> names;
  for (const WrittenParam& param : scope.document->params) names.push_back(param.name.text);
  return names;
}

// In messages.
std::string name_of(const Scope& scope) {
  return scope.parent ? "the graph '" + scope.prefix.substr(0, scope.prefix.size() - 1) + "'" : "the graph";
}

std::uint32_t version_of(const Leaf& leaf) { return leaf.written->version.value_or(leaf.pass->version); }

// Whether a name stands in one of the files around a leaf, and not in an option.
bool stands_in_a_file(const Leaf& leaf, const Text& target) {
  for (const Scope* scope = leaf.scope; scope; scope = scope->parent)
    if (scope->document->source == target.where.source) return true;
  return false;
}

bool is_same_kind(const quell_param_desc& a, const quell_param_desc& b) { return a.type == b.type && a.is_array == b.is_array; }

void leave_out(Leaf& leaf, const std::string& param) {
  if (std::ranges::find(leaf.left_out, param) == leaf.left_out.end()) leaf.left_out.push_back(param);
}

}  // namespace

void Settings::apply_files() {
  for (Leaf& leaf : graph_.leaves)
    if (leaf.pass && leaf.written->version) apply_former_defaults(leaf);
  apply_files(graph_.root);
}

void Settings::apply_files(const Scope& scope) {
  for (const WrittenNode& node : scope.document->nodes) {
    const Child& child = scope.children.at(node.name.text);
    if (child.scope) apply_files(*child.scope);
  }
  notes_ = scope.included_from();
  for (const WrittenNode& node : scope.document->nodes) apply_node_params(scope, node);
  for (const WrittenParam& param : scope.document->params) {
    const std::vector<Slot> slots = find_own(scope, param.name, param.name.text);
    if (param.value) assign(slots, {param.name, *param.value, {}, scope.document->folder()}, &scope);
  }
  notes_.clear();
}

void Settings::apply_former_defaults(Leaf& leaf) {
  for (const FormerDefault& former : former_defaults(*leaf.pass, version_of(leaf))) {
    const quell_param_desc& desc = leaf.param(former.param);
    Json value = to_json_value(*former.value, leaf.written->version_where);
    if (desc.type == QUELL_PARAM_ENUM)
      for (Json& element : value.elements)
        if (element.kind == Json::Kind::integer && element.integer >= 0 && element.integer < std::int64_t{desc.enum_count})
          element.kind = Json::Kind::string, element.string = desc.enum_values[element.integer];
    if (!desc.is_array && value.elements.size() == 1) value = Json(value.elements[0]);
    const ValueContext context{leaf.name + "." + desc.name, {}, leaf.scope->included_from()};
    leaf.params[former.param].value = to_param(desc, value, context, errors_);
  }
}

void Settings::apply_node_params(const Scope& scope, const WrittenNode& node) {
  for (const WrittenValue& param : node.params)
    assign(find_in(scope, node, param.name, param.name.text), {param.name, param.value, {}, scope.document->folder()}, &scope);
}

void Settings::apply(const Setting& setting) {
  const bool is_own = setting.target.text.find('.') == std::string::npos;
  const std::vector<Slot> slots = is_own ? find_own(graph_.root, setting.target, setting.target.text)
                                         : find(graph_.root, setting.target, setting.target.text);
  assign(slots, setting, nullptr);
}

// A parameter of the graph that the scope stands for.
std::vector<Settings::Slot> Settings::find_own(const Scope& scope, const Text& target, std::string_view name) {
  for (const WrittenParam& param : scope.document->params) {
    if (param.name.text != name) continue;
    const auto [known, is_new] = own_.try_emplace({&scope, &param});
    std::vector<Slot>& slots = known->second;
    if (!is_new) return slots;
    for (const Text& inner : param.sets)
      for (const Slot& slot : find(scope, inner, inner.text)) slots.push_back(slot);
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    return slots;
  }
  std::vector<std::string> names = own_params(scope);
  const std::string close = did_you_mean(name, names);
  if (!scope.parent) names.emplace_back("node.param");
  errors_.error(target.where,
                name_of(scope) + " has no parameter '" + std::string(name) + "'" +
                    (close.empty() ? suggest("", names, "; it has none") : close),
                notes_);
  return {};
}

// "node.param" in a scope, `path` being what is left of the target.
std::vector<Settings::Slot> Settings::find(const Scope& scope, const Text& target, std::string_view path) {
  const std::size_t dot = path.find('.');
  const std::string_view name = path.substr(0, dot);
  if (dot == std::string_view::npos) {
    errors_.error(target.where, "'" + target.text + "' names no parameter; expected 'node.param'", notes_);
    return {};
  }
  const WrittenNode* node = scope.find_node(name);
  if (!node) {
    errors_.error(target.where, name_of(scope) + " has no node '" + std::string(name) + "'" + suggest(name, scope.node_names()),
                  notes_);
    return {};
  }
  return find_in(scope, *node, target, path.substr(dot + 1));
}

// What `rest` names in a node: a parameter of its pass; a parameter or node of its graph.
std::vector<Settings::Slot> Settings::find_in(const Scope& scope, const WrittenNode& node, const Text& target,
                                              std::string_view rest) {
  const Child& child = scope.children.at(node.name.text);
  if (child.scope)
    return rest.find('.') == std::string_view::npos ? find_own(*child.scope, target, rest) : find(*child.scope, target, rest);
  if (child.leaf < 0) return {};
  Leaf& leaf = graph_.leaves[static_cast<std::size_t>(child.leaf)];
  return leaf.pass ? find_in_leaf(leaf, target, rest) : std::vector<Slot>();
}

// What a file says of a pass that --swap replaced holds for the other pass, too, where that has such a parameter.
std::vector<Settings::Slot> Settings::find_in_swapped(Leaf& leaf, std::uint32_t former) {
  const quell_param_desc& before = *QUELL_AT(quell_param_desc, leaf.swapped_from->params, former);
  const std::optional<std::uint32_t> now = find_param(*leaf.pass, leaf.pass->version, before.name);
  if (now && is_same_kind(before, leaf.param(*now))) return {{&leaf, *now}};
  leave_out(leaf, before.name);
  return {};
}

std::vector<Settings::Slot> Settings::find_in_leaf(Leaf& leaf, const Text& target, std::string_view name) {
  if (leaf.swapped_from && stands_in_a_file(leaf, target)) {
    if (const auto former = find_param(*leaf.swapped_from, leaf.swapped_version, name)) return find_in_swapped(leaf, *former);
    errors_.error(target.where,
                  "the pass '" + std::string(leaf.swapped_from->id) + "' has no parameter '" + std::string(name) + "'" +
                      suggest_param(*leaf.swapped_from, name),
                  notes_);
    return {};
  }
  if (const std::optional<std::uint32_t> param = find_param(*leaf.pass, version_of(leaf), name)) return {{&leaf, *param}};
  errors_.error(target.where,
                "the pass '" + std::string(leaf.pass->id) + "' has no parameter '" + std::string(name) + "'" +
                    suggest_param(*leaf.pass, name),
                notes_);
  leaf.params_are_broken = true;
  return {};
}

// Whether a value that a file has for the pass that --swap replaced is possible for the other one. A mistake in it is told.
bool Settings::fits_swapped(Leaf& leaf, const quell_param_desc& desc, const Setting& setting) {
  const std::optional<std::uint32_t> former = find_param(*leaf.swapped_from, leaf.swapped_from->version, desc.name);
  const ValueContext context{leaf.name + "." + desc.name, setting.folder, notes_};
  if (!former || !to_param(*QUELL_AT(quell_param_desc, leaf.swapped_from->params, *former), setting.value, context, errors_))
    return false;
  Diagnostics unfit;
  if (to_param(desc, setting.value, context, unfit)) return true;
  leave_out(leaf, desc.name);
  return false;
}

void Settings::assign(const std::vector<Slot>& slots, const Setting& setting, const Scope* by) {
  for (const auto& [leaf, index] : slots) {
    const quell_param_desc& desc = leaf->param(index);
    SetParam& param = leaf->params[index];
    const std::string label = leaf->name + "." + desc.name;
    if (by && param.set_in == by) {
      errors_.error(
          setting.target.where,
          "'" + label + "' is set twice, here and in line " + std::to_string(param.where.line()) + "; expected one of them",
          notes_);
      continue;
    }
    if (by && leaf->swapped_from && !fits_swapped(*leaf, desc, setting)) continue;
    const bool is_text = desc.type == QUELL_PARAM_STRING || desc.type == QUELL_PARAM_PATH || desc.type == QUELL_PARAM_ENUM;
    const Json& value = setting.plain && is_text && !desc.is_array ? *setting.plain : setting.value;
    param.value = to_param(desc, value, {label, setting.folder, notes_}, errors_);
    param.set_in = by, param.where = setting.target.where;
    leaf->params_are_broken = leaf->params_are_broken || !param.value;
  }
}

}  // namespace quell::detail
