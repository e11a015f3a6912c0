// The channels of a file as layers, and which of them is read as an input.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quell/image/port_type.h"
#include "quell/sequence/conventions.h"
#include "quell/sequence/image_file.h"

namespace quell {

/// Channels whose names are equal up to the last dot.
struct Layer {
  std::string name;           ///< "ViewLayer.Normal"; "" for channels without a dot
  std::vector<int> channels;  ///< in the file's order
};

/// In the order in which the file has them.
std::vector<Layer> group_layers(const std::vector<FileChannel>& channels);
/// "X" of "ViewLayer.Normal.X".
std::string_view channel_suffix(std::string_view name);
/// In capitals; letters outside ASCII stay as they are.
std::string upper(std::string_view text);

/// The channels of `layer` with these suffixes (capitals, one for each plane, commas between), whatever their case; empty when
/// one is missing.
std::vector<int> find_suffixes(const Layer& layer, const std::vector<FileChannel>& channels, std::string_view suffixes);

/// The channels of a layer for an image of `planes`: R,G,B or X,Y,Z for three, X,Y, R,G or U,V for two, the only one for one.
/// With `alone`, the layer may have no other channel, alpha (A) excepted. Empty when there are none such.
std::vector<int> usual_channels(const Layer& layer, const std::vector<FileChannel>& channels, int planes, bool alone);

/// What is read of a file as one input.
struct Selection {
  std::string layer;             ///< "ViewLayer.Normal"; "" for channels without one, or channels that were named one by one
  std::vector<int> channels;     ///< one for each plane
  std::optional<int> alpha;      ///< the channel A of the layer, when it is not itself read
  std::string renderer = {};     ///< by whose table the layer was recognized: "Blender"; "" when by none
  Conventions conventions = {};  ///< as that renderer has them
};

/// The channel A that belongs to another: of the same layer.
std::optional<int> find_alpha(const std::vector<FileChannel>& channels, int beside);

}  // namespace quell
