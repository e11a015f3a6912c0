// Which layers of a file serve an input, by the tables of renderer_names.h.
#include <algorithm>
#include <limits>
#include <set>

#include "quell/sequence/renderer_names.h"

namespace quell {
namespace {

constexpr int kLastResort = 9;     // worse than every row
constexpr int kOwnNameInside = 2;  // "filter.color": worse than a file's plain R,G,B

using Channels = std::vector<FileChannel>;

struct Candidate {
  Selection selection;
  int rank;
};

/// A row serves the input that it names; one that is called like its type, all other inputs of that type, too, colors excepted:
/// a color of another name (a light, say) is another one.
bool serves(const RendererName& row, std::string_view input, PortType type) {
  if (row.type != type) return false;
  if (row.input == input) return true;
  if (row.input != name(type)) return false;
  const auto& usual = usual_inputs();
  const bool is_other = std::find(usual.begin(), usual.end(), input) != usual.end();
  return type == QUELL_TYPE_COLOR ? input == "noisy" : !is_other;
}

std::vector<int> find_channels(const Layer& layer, const Channels& channels, std::string_view sets) {
  if (sets == "*") return layer.channels.size() == 1 ? layer.channels : std::vector<int>();
  for (std::string_view left = sets;;) {
    auto found = find_suffixes(layer, channels, left.substr(0, left.find('|')));
    if (!found.empty() || left.find('|') == std::string_view::npos) return found;
    left.remove_prefix(left.find('|') + 1);
  }
}

bool has_channel(const Channels& channels, std::string_view name) {
  return std::any_of(channels.begin(), channels.end(), [&](const FileChannel& channel) { return channel.name == name; });
}

Selection select(const Layer& layer, std::vector<int> chosen, const Channels& channels) {
  std::optional<int> alpha = find_alpha(channels, chosen.front());
  if (alpha && std::find(chosen.begin(), chosen.end(), *alpha) != chosen.end()) alpha.reset();
  return {layer.name, std::move(chosen), alpha};
}

std::optional<Candidate> match_row(const RendererName& row, std::string_view called, const Layer& layer,
                                   const Channels& channels) {
  if (!matches(row.layer, called) || (!row.beside.empty() && !has_channel(channels, row.beside))) return std::nullopt;
  // A plane of a vector is no image of its own: Z of a position is no depth.
  if (info(row.type).channels == 1 && !find_suffixes(layer, channels, "X,Y,Z").empty()) return std::nullopt;
  auto chosen = find_channels(layer, channels, row.channels);
  if (chosen.empty()) return std::nullopt;
  Selection selection = select(layer, std::move(chosen), channels);
  selection.renderer = row.renderer == "any" ? "" : row.renderer;
  selection.conventions = row.conventions;
  return Candidate{std::move(selection), row.rank};
}

std::optional<Candidate> match_layer(std::span<const RendererName> rows, std::string_view called, const Layer& layer,
                                     const Channels& channels, std::string_view input, PortType type) {
  for (const RendererName& row : rows)
    if (serves(row, input, type))
      if (auto found = match_row(row, called, layer, channels)) return found;
  return std::nullopt;
}

/// A layer that has the input's own name, wholly or in its last part.
std::optional<Candidate> match_own_name(const Layer& layer, const Channels& channels, std::string_view input, PortType type) {
  if (layer.name.empty() || !matches(input, layer.name)) return std::nullopt;
  auto chosen = usual_channels(layer, channels, info(type).channels, false);
  if (chosen.empty()) return std::nullopt;
  const bool is_whole = upper(layer.name) == upper(input);
  return Candidate{select(layer, std::move(chosen), channels), is_whole ? 0 : kOwnNameInside};
}

/// Whether a layer is known as something else than a color.
bool is_known(const Layer& layer, const Channels& channels) {
  for (const std::string& input : usual_inputs()) {
    const PortType type = port_type(input).value_or(QUELL_TYPE_COLOR);
    if (input == "color" || input == "alpha") continue;
    if (match_own_name(layer, channels, input, type)) return true;
    if (match_layer(renderer_names(), layer.name, layer, channels, input, type)) return true;
  }
  return false;
}

/// Colors of names that are in no table, such as those that users of Mitsuba choose.
std::vector<Candidate> find_unknown_colors(const std::vector<Layer>& layers, const Channels& channels) {
  std::vector<Candidate> found;
  for (const Layer& layer : layers)
    if (auto chosen = find_suffixes(layer, channels, "R,G,B"); !chosen.empty() && !is_known(layer, channels))
      found.push_back({select(layer, std::move(chosen), channels), kLastResort});
  return found;
}

std::vector<Selection> best_of(const std::vector<Candidate>& candidates) {
  int best = std::numeric_limits<int>::max();
  for (const Candidate& candidate : candidates) best = std::min(best, candidate.rank);
  std::vector<Selection> result;
  for (const Candidate& candidate : candidates)
    if (candidate.rank == best) result.push_back(candidate.selection);
  return result;
}

}  // namespace

bool matches(std::string_view pattern, std::string_view name) {
  if (pattern == "*") return true;
  if (pattern.empty()) return name.empty();
  const bool needs_prefix = pattern.starts_with("*.");
  const std::string end = upper(needs_prefix ? pattern.substr(2) : pattern), whole = upper(name);
  if (whole == end) return !needs_prefix;
  return whole.size() > end.size() + 1 && whole.ends_with(end) && whole[whole.size() - end.size() - 1] == '.';
}

std::optional<Selection> recognize_layer(const Layer& layer, const Channels& channels, std::string_view input, PortType type) {
  const auto found = match_layer(renderer_names(), layer.name, layer, channels, input, type);
  return found ? std::optional(found->selection) : std::nullopt;
}

std::vector<Selection> recognize(const Channels& channels, std::string_view input, PortType type) {
  const std::vector<Layer> layers = group_layers(channels);
  std::vector<Candidate> candidates;
  for (const Layer& layer : layers) {
    auto found = match_layer(renderer_names(), layer.name, layer, channels, input, type);
    if (!found) found = match_own_name(layer, channels, input, type);
    if (found) candidates.push_back(*found);
  }
  if (candidates.empty() && (input == "color" || input == "noisy") && type == QUELL_TYPE_COLOR)
    candidates = find_unknown_colors(layers, channels);
  return best_of(candidates);
}

std::vector<Selection> recognize_by_file_name(std::string_view stem, const Channels& channels, std::string_view input,
                                              PortType type) {
  const std::vector<Layer> layers = group_layers(channels);
  if (layers.size() != 1) return {};
  const auto found = match_layer(renderer_file_names(), stem, layers.front(), channels, input, type);
  return found ? std::vector{found->selection} : std::vector<Selection>();
}

}  // namespace quell
