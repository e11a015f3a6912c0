// The file that a frame's picture was read from, and what of it goes on to the results. Private to core/sequence.
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "quell/sequence/file_sink.h"
#include "quell/sequence/image_file.h"

namespace quell {

/// Where an image lies in a file's coordinates.
struct Placement {
  Rectangle display;
  Rectangle image;  ///< its pixels
  Rectangle data;   ///< those that are written: never empty
  float pixel_aspect = 1;
};
/// That of an image by itself.
Placement place_alone(Size size);

/// A channel that is carried over.
struct KeptChannel {
  std::string name;   ///< in the results
  int channel = 0;    ///< index into ImageFile::channels()
  bool half = false;  ///< in the results; else 4 bytes, uint or float
  bool uint = false;
};

/// Open; not thread-safe.
class OriginalFile {
 public:
  /// Throws Error(input).
  explicit OriginalFile(const Original& original);

  Size picture_size() const;
  /// Of a result of that size: that of the picture, if it has as many pixels. Where the picture's file holds no pixels, nothing
  /// is written either.
  Placement place(Size size) const;
  /// What the header tells of the picture, with its types. With `channels`, what it tells of other channels, too.
  void add_attributes(OIIO::ImageSpec& spec, bool channels) const;

  /// The channels that the graph does not read, but for those whose name in the results is among `taken`; these go to `left_out`.
  /// Channels of the layer that the picture is in lose the layer's name, as the picture's own do.
  std::vector<KeptChannel> choose(const std::vector<std::string>& taken, std::vector<std::string>* left_out = nullptr) const;
  /// Fills channels of `band`'s pixels, one after the other in each pixel, bit for bit as they stand in the file; integers of 8
  /// and 16 bits, which OpenEXR has not, become floats from 0 to 1. Pixels that the file does not hold are 0. `pixel_bytes` lead
  /// from a pixel to the next. Throws Error(input) for a truncated or damaged file.
  void read(const std::vector<KeptChannel>& channels, const Rectangle& band, std::byte* out, std::size_t pixel_bytes);
  /// Alpha of the picture, when the graph does not read it.
  std::optional<int> alpha() const;
  ImageFile& file() { return file_; }

 private:
  struct Copied;
  void read_part(int part, const std::vector<Copied>& channels, const Rectangle& band, std::byte* out, std::size_t pixel_bytes);
  Rectangle window() const;
  std::string layer() const;
  bool is_read(const std::string& channel) const;

  Original original_;
  ImageFile file_;
  int color_ = 0;  // the picture's first channel
};

}  // namespace quell
