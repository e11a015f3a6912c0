#include "quell/sequence/layers.h"

#include <algorithm>

namespace quell {
namespace {

std::string_view layer_name(std::string_view channel) {
  const std::size_t dot = channel.rfind('.');
  return dot == std::string_view::npos ? std::string_view() : channel.substr(0, dot);
}

bool is_alpha(const std::vector<FileChannel>& channels, int index) {
  return upper(channel_suffix(channels[static_cast<std::size_t>(index)].name)) == "A";
}

}  // namespace

std::string_view channel_suffix(std::string_view name) { return name.substr(name.rfind('.') + 1); }  // npos + 1 is 0

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return result;
}

std::vector<Layer> group_layers(const std::vector<FileChannel>& channels) {
  std::vector<Layer> layers;
  for (int i = 0; i < static_cast<int>(channels.size()); ++i) {
    const std::string_view name = layer_name(channels[static_cast<std::size_t>(i)].name);
    auto found = std::find_if(layers.begin(), layers.end(), [&](const Layer& layer) { return layer.name == name; });
    if (found == layers.end()) found = layers.insert(layers.end(), Layer{std::string(name), {}});
    found->channels.push_back(i);
  }
  return layers;
}

std::vector<int> find_suffixes(const Layer& layer, const std::vector<FileChannel>& channels, std::string_view suffixes) {
  std::vector<int> found;
  for (std::string_view left = suffixes;;) {
    const std::string wanted = upper(left.substr(0, left.find(',')));
    const auto channel = std::find_if(layer.channels.begin(), layer.channels.end(), [&](int index) {
      return upper(channel_suffix(channels[static_cast<std::size_t>(index)].name)) == wanted;
    });
    if (channel == layer.channels.end()) return {};
    found.push_back(*channel);
    if (left.find(',') == std::string_view::npos) return found;
    left.remove_prefix(left.find(',') + 1);
  }
}

std::vector<int> usual_channels(const Layer& layer, const std::vector<FileChannel>& channels, int planes, bool alone) {
  const auto alphas = std::count_if(layer.channels.begin(), layer.channels.end(), [&](int i) { return is_alpha(channels, i); });
  const std::size_t count = layer.channels.size();
  const std::size_t others = count > 1 && alphas == 1 ? count - 1 : count;
  if (planes == 1) {
    if (others != 1) return {};
    const bool first_is_alpha = count > 1 && is_alpha(channels, layer.channels[0]);
    return {layer.channels[first_is_alpha ? 1 : 0]};
  }
  if (alone && others != static_cast<std::size_t>(planes)) return {};
  const std::vector<std::string_view> sets =
      planes == 3 ? std::vector<std::string_view>{"R,G,B", "X,Y,Z"} : std::vector<std::string_view>{"X,Y", "R,G", "U,V"};
  for (const std::string_view set : sets)
    if (auto found = find_suffixes(layer, channels, set); !found.empty()) return found;
  return {};
}

std::optional<int> find_alpha(const std::vector<FileChannel>& channels, int beside) {
  const std::string_view layer = layer_name(channels[static_cast<std::size_t>(beside)].name);
  for (int i = 0; i < static_cast<int>(channels.size()); ++i)
    if (i != beside && is_alpha(channels, i) && layer_name(channels[static_cast<std::size_t>(i)].name) == layer) return i;
  return std::nullopt;
}

}  // namespace quell
