#include <algorithm>

#include "quell/sequence/image_input.h"
#include "quell/sequence/renderer_names.h"
#include "quell/text/diagnostic.h"
#include "quell/text/shell_word.h"

namespace quell {
namespace {

using Channels = std::vector<FileChannel>;
using Names = std::vector<std::string>;
constexpr std::size_t kShown = 12;  // names in a message

std::string joined(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

Names names_of(const Channels& channels, const std::vector<int>& indices) {
  Names names;
  for (const int index : indices) names.push_back(channels[static_cast<std::size_t>(index)].name);
  return names;
}

Names all_names(const Channels& channels) {
  Names names;
  for (const FileChannel& channel : channels) names.push_back(channel.name);
  return names;
}

std::string shortened(Names names) {
  if (names.size() > kShown) {
    names.resize(kShown);
    names.emplace_back("...");
  }
  return joined(names);
}

std::string needs(PortType type) {
  const int planes = info(type).channels;
  return std::string(name(type)) + " needs " +
         (planes == 1   ? "1 channel"
          : planes == 2 ? "2 channels (X,Y, R,G or U,V)"
                        : "3 channels (R,G,B or X,Y,Z)");
}

class Selector {
 public:
  Selector(const Channels& channels, const ImageRequest& request, const std::string& file)
      : channels_(channels),
        request_(request),
        file_(file),
        input_(request.input.empty() ? std::string(name(request.type)) : request.input),
        layers_(group_layers(channels)) {}

  Selection select() const {
    if (!request_.channels.empty()) return select_stated();
    if (!request_.layer.empty()) return select_in_layer();
    std::vector<Selection> found;
    if (!request_.shared) found = recognize_by_file_name(request_.stem, channels_, input_, request_.type);
    if (found.empty()) found = recognize(channels_, input_, request_.type);
    if (found.size() == 1) return found.front();
    if (found.size() > 1) fail_doubtful(found);
    if (layers_.size() == 1 && !request_.shared) {
      auto usual = usual_channels(layers_.front(), channels_, planes(), true);
      if (!usual.empty()) return with_alpha("", std::move(usual));
      fail("; name them with \"channels\"");
    }
    fail_unrecognized();
  }

 private:
  int planes() const { return info(request_.type).channels; }

  [[noreturn]] void refuse(const std::string& what) const { throw Error(Fault::input, file_, what); }

  [[noreturn]] void fail(const std::string& why) const {
    const std::size_t count = channels_.size();
    refuse("found " + std::to_string(count) + (count == 1 ? " channel (" : " channels (") + shortened(all_names(channels_)) +
           "), but " + needs(request_.type) + why);
  }

  std::string option(const std::string& layer) const {
    return "--in " + shell_word(input_ + "=" + (request_.pattern.empty() ? file_ : request_.pattern) + ":" + layer);
  }

  /// What stands after the colon of an --in option to choose this: the layer, or the channel of one that has no name.
  std::string handle(const Selection& selection) const {
    if (!selection.layer.empty() && planes() > 1) return selection.layer;
    return planes() == 1 ? names_of(channels_, selection.channels).front()
                         : "channels=" + joined(names_of(channels_, selection.channels));
  }

  [[noreturn]] void fail_doubtful(const std::vector<Selection>& found) const {
    std::string text = "several layers could be the input '" + input_ + "':";
    for (const Selection& selection : found)
      text += "\n  " + joined(names_of(channels_, selection.channels)) +
              (selection.renderer.empty() ? "" : "  (" + selection.renderer + ")") + "  choose it with " +
              option(handle(selection));
    refuse(text);
  }

  [[noreturn]] void fail_unrecognized() const {
    std::string text = "nothing in this file is recognized as the input '" + input_ + "' (" + needs(request_.type) + "); it has:";
    for (const Layer& layer : layers_)
      text +=
          "\n  " + (layer.name.empty() ? std::string("without a layer") : layer.name) + "  (" + shortened(suffixes(layer)) + ")";
    refuse(text + "\nname what to read, for example: " + option(layers_.back().name.empty() ? "LAYER" : layers_.back().name));
  }

  Names suffixes(const Layer& layer) const {
    Names names;
    for (const std::string& name : names_of(channels_, layer.channels)) names.emplace_back(channel_suffix(name));
    return names;
  }

  Selection with_alpha(std::string layer, std::vector<int> chosen) const {
    std::optional<int> alpha = find_alpha(channels_, chosen.front());
    if (alpha && std::find(chosen.begin(), chosen.end(), *alpha) != chosen.end()) alpha.reset();
    return {std::move(layer), std::move(chosen), alpha};
  }

  std::optional<int> find_channel(const std::string& wanted) const {
    const auto found =
        std::find_if(channels_.begin(), channels_.end(), [&](const FileChannel& channel) { return channel.name == wanted; });
    if (found == channels_.end()) return std::nullopt;
    return static_cast<int>(found - channels_.begin());
  }

  Selection select_stated() const {
    if (static_cast<int>(request_.channels.size()) != planes())
      fail("; " + std::to_string(request_.channels.size()) + " are named: " + joined(request_.channels));
    std::vector<int> chosen;
    for (const std::string& wanted : request_.channels) {
      const std::optional<int> found = find_channel(wanted);
      if (!found) fail("; there is no '" + wanted + "'" + did_you_mean(wanted, all_names(channels_)));
      chosen.push_back(*found);
    }
    return with_alpha("", std::move(chosen));
  }

  Selection select_in_layer() const {
    const auto layer =
        std::find_if(layers_.begin(), layers_.end(), [&](const Layer& candidate) { return candidate.name == request_.layer; });
    if (layer == layers_.end()) return select_one_channel();
    if (auto known = recognize_layer(*layer, channels_, input_, request_.type)) return *known;
    auto usual = usual_channels(*layer, channels_, planes(), false);
    if (!usual.empty()) return with_alpha(layer->name, std::move(usual));
    refuse("the layer '" + layer->name + "' has " + shortened(suffixes(*layer)) + ", but " + needs(request_.type) +
           "; name them with \"channels\"");
  }

  Selection select_one_channel() const {
    const std::optional<int> channel = find_channel(request_.layer);
    if (!channel) {
      Names names;
      for (const Layer& layer : layers_)
        if (!layer.name.empty()) names.push_back(layer.name);
      const Names candidates = all_names(channels_);
      Names known = names;
      known.insert(known.end(), candidates.begin(), candidates.end());
      refuse("there is no layer or channel '" + request_.layer + "'" + did_you_mean(request_.layer, known) + "; the file has " +
             (names.empty() ? "the channels " + shortened(candidates) : "the layers " + list_names(names, "and")));
    }
    if (planes() != 1) refuse("'" + request_.layer + "' is a single channel, but " + needs(request_.type));
    return with_alpha("", {*channel});
  }

  const Channels& channels_;
  const ImageRequest& request_;
  const std::string& file_;
  std::string input_;
  std::vector<Layer> layers_;
};

}  // namespace

Selection select_channels(const Channels& in_file, const ImageRequest& request, const std::string& file) {
  return Selector(in_file, request, file).select();
}

}  // namespace quell
