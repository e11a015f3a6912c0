#include "quell/graph/versions.h"

#include <algorithm>

#include "quell/graph/fields.h"

namespace quell::detail {
namespace {

// What was changed after `version`, the oldest change first.
std::vector<const quell_change*> changes_since(const quell_pass_desc& pass, std::uint32_t version) {
  std::vector<const quell_change*> changes;
  for (std::uint32_t i = 0; i < pass.change_count; ++i) {
    const quell_change* change = QUELL_AT(quell_change, pass.changes, i);
    if (change->version > version) changes.push_back(change);
  }
  std::stable_sort(changes.begin(), changes.end(),
                   [](const quell_change* a, const quell_change* b) { return a->version < b->version; });
  return changes;
}

std::optional<std::uint32_t> index_of(const quell_pass_desc& pass, std::string_view name) {
  for (std::uint32_t i = 0; i < pass.param_count; ++i)
    if (name == QUELL_AT(quell_param_desc, pass.params, i)->name) return i;
  return std::nullopt;
}

// Today's name of what was called `name` before changes[first].
std::string_view renamed(const std::vector<const quell_change*>& changes, std::size_t first, std::string_view name) {
  for (std::size_t i = first; i < changes.size(); ++i)
    if (changes[i]->renamed_to && name == changes[i]->param) name = changes[i]->renamed_to;
  return name;
}

}  // namespace

std::string refuse_version(const quell_pass_desc& pass, std::uint32_t version) {
  const std::string id = std::string("'") + pass.id + "'", here = std::to_string(pass.version);
  if (version > pass.version)
    return "this graph needs version " + std::to_string(version) + " of the pass " + id + "; version " + here +
           " is installed: a newer plugin is needed";
  if (version < pass.oldest_version)
    return "version " + std::to_string(version) + " of the pass " + id + " is no longer supported; expected " +
           (pass.oldest_version == pass.version ? here : std::to_string(pass.oldest_version) + " to " + here) +
           ": look at the node's parameters again, then raise its version";
  return "";
}

std::optional<std::uint32_t> find_param(const quell_pass_desc& pass, std::uint32_t version, std::string_view name) {
  const std::optional<std::uint32_t> former = index_of(pass, renamed(changes_since(pass, version), 0, name));
  return former ? former : index_of(pass, name);
}

std::string suggest_param(const quell_pass_desc& pass, std::string_view name) {
  for (std::uint32_t i = 0; i < pass.change_count; ++i) {
    const quell_change& change = *QUELL_AT(quell_change, pass.changes, i);
    if (change.renamed_to && name == change.param)
      return std::string("; it is called '") + change.renamed_to + "' since version " + std::to_string(change.version);
  }
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < pass.param_count; ++i) names.emplace_back(QUELL_AT(quell_param_desc, pass.params, i)->name);
  return suggest(name, names, "; it has none");
}

std::vector<FormerDefault> former_defaults(const quell_pass_desc& pass, std::uint32_t version) {
  const std::vector<const quell_change*> changes = changes_since(pass, version);
  std::vector<FormerDefault> result;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (!changes[i]->former_default) continue;
    const std::optional<std::uint32_t> param = index_of(pass, renamed(changes, i, changes[i]->param));
    // The first change after `version` tells what that version meant; later ones changed what came after it.
    const auto is_same = [&](const FormerDefault& other) { return other.param == param; };
    if (param && std::none_of(result.begin(), result.end(), is_same)) result.push_back({*param, changes[i]->former_default});
  }
  return result;
}

}  // namespace quell::detail
