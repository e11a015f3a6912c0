// An image file as an input of a given port type.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "quell/image/image.h"
#include "quell/sequence/conventions.h"
#include "quell/sequence/image_file.h"
#include "quell/sequence/layers.h"

namespace quell {

struct ImageRequest {
  PortType type = QUELL_TYPE_COLOR;
  std::vector<std::string> channels = {};  ///< full names, one for each plane; empty: see select_channels()
  Conventions conventions = {};            ///< stated; the others are as the recognized renderer or the file's format has them
  std::function<std::shared_ptr<const Camera>(int frames_back)> camera = {};  ///< see ConversionContext
  /// What to read, in pixels from the upper left corner of the display window; may reach beyond it. Nothing: the display window.
  std::optional<Rectangle> window = {};
  std::string layer = {};    ///< full name of the layer, or of the one channel, to read; empty: see select_channels()
  std::string input = {};    ///< the input's name; empty: that of the type
  std::string pattern = {};  ///< of the files, for messages that show an --in option; empty: the file
  std::string stem = {};     ///< the file's name without frame and extension: what the file is called
  bool shared = false;       ///< the file serves other inputs, too, so that its name tells nothing
};

/// Picks the channels for the planes of an image:
/// - those named in the request, or in the layer named there, by the tables of renderer_names.h or the usual names;
/// - else those that the tables know as this input, by the layers' names or the file's;
/// - else, of a file with one layer that serves this input alone, the only ones (alpha, A, left aside) when their names are R,G,B
///   or X,Y,Z, for two planes X,Y, R,G or U,V, or any single one.
/// Throws Error(input) with what the file has, and the candidates where several are as good.
Selection select_channels(const std::vector<FileChannel>& in_file, const ImageRequest& request, const std::string& file);

/// The size of an image, from its header alone; its channels are checked, too. Throws Error(input).
Size probe_image(const std::filesystem::path& path, const ImageRequest& request);

/// Reads an image and converts it to the meaning of its type. `note` is told what a person should know. Throws Error(input).
Image read_image(const std::filesystem::path& path, const ImageRequest& request, BufferPool& pool,
                 const std::function<void(const std::string&)>& note);

/// An image as its file holds it, and what read_image() makes of it.
struct StoredImage {
  Image image;  ///< of the type asked for, ids as a scalar; 0 outside the data window, and nothing converted
  std::string format;
  std::vector<std::string> channels;  ///< full names, one for each plane
  Selection selection;
  Numbers numbers = Numbers::single;  ///< of the first channel
  Conventions conventions;            ///< by which read_image() converts it
  Size whole;                         ///< of the display window
  int x = 0, y = 0;                   ///< where in it the image's pixel (0, 0) lies
};
/// Throws Error(input).
StoredImage read_stored(const std::filesystem::path& path, const ImageRequest& request, BufferPool& pool);

}  // namespace quell
