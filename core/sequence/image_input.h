// An image file as an input of a given port type.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "quell/image/image.h"

namespace quell {

struct ImageRequest {
  PortType type = QUELL_TYPE_COLOR;
  std::vector<std::string> channels = {};       ///< names, one for each plane; empty: the usual ones of the type
  std::optional<std::int64_t> background = {};  ///< see convert_ids()
};

/// Picks the file's channels for the planes of a type: those asked for; else the only ones (alpha, A, left aside) when their
/// names are R,G,B or X,Y,Z, for two planes X,Y, R,G or U,V, or any single one. Names differ from each other in more than case.
/// Throws Error(input) with the channels found and needed.
std::vector<int> select_channels(const std::vector<std::string>& in_file, const ImageRequest& request, const std::string& file);

/// The size of an image, from its header alone; its channels are checked, too. Throws Error(input).
Size probe_image(const std::filesystem::path& file, const ImageRequest& request);

/// Reads an image and converts it to the meaning of its type. `note` is told what a person should know. Throws Error(input).
Image read_image(const std::filesystem::path& file, const ImageRequest& request, BufferPool& pool,
                 const std::function<void(const std::string&)>& note);

}  // namespace quell
