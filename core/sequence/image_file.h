// Reading the planes of an image file: OpenEXR, PNG, TIFF, Radiance HDR, PFM.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quell/image/image.h"
#include "quell/image/item.h"

namespace quell {

/// Part of an image, in pixels.
struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Rectangle&) const = default;
  bool empty() const { return width <= 0 || height <= 0; }
};
/// What both have in common; empty (all 0) when nothing.
Rectangle intersection(const Rectangle& a, const Rectangle& b);

enum class Numbers { half, single, uint32, uint16, uint8 };
inline bool is_integer(Numbers numbers) { return numbers != Numbers::half && numbers != Numbers::single; }

/// A channel, of all parts of a file. Its full name is unique in the file. In a file of several parts, the part's name stands
/// before the channel's own where that does not begin with it already: "ViewLayer.Normal.X" in the only part, and the channel "X"
/// of the part "ViewLayer.Normal" among others, have the same full name. Parts without a name are "part2", "part3", ....
struct FileChannel {
  std::string name;  ///< "ViewLayer.Normal.X"
  int part = 0;
  Numbers numbers = Numbers::single;
};

/// An open file with all its parts. Coordinates are those of the file: the display window may begin anywhere, the data window of
/// a part may cover less of it, or more. Of mip levels, only the largest is seen. The format is told by the first bytes, not by
/// the name. Decodes on the calling thread alone. Not thread-safe; any number may be open at a time.
class ImageFile {
 public:
  /// Throws Error(input) for a file that is missing, of no known format, deep, of more than one slice, turned (a TIFF or HDR that
  /// does not begin top left), or whose header claims a size beyond Image::kMaxSize. Takes no memory for pixels.
  explicit ImageFile(const std::filesystem::path& path);
  ~ImageFile();

  const std::filesystem::path& path() const;
  std::string_view format() const;  ///< "openexr", "png", "tiff", "hdr", "pfm"
  const std::vector<FileChannel>& channels() const;
  const Rectangle& display_window() const;
  /// Of a channel's part, in the same coordinates.
  const Rectangle& data_window(int channel) const;
  float pixel_aspect() const;

  /// A 4x4 matrix of the header ("worldToCamera") in the order in which the file holds its 16 numbers.
  std::optional<Matrix> matrix(std::string_view attribute) const;
  struct Attribute {
    std::string name, text;
  };
  /// What else the headers tell, as text, for people and to be carried over. How the pixels are stored is left out.
  std::vector<Attribute> attributes() const;

  /// Reads channels (indices into channels()) into the planes of an image of `window`'s size; what lies outside the data window
  /// is 0. Half and float keep their bits' value; uint32 is rounded to float; uint16 and uint8 become 0 to 1. Nothing else is
  /// done to them: alpha stays as associated as it is in the file, and no transfer curve is undone. Throws Error(input) for a
  /// truncated or damaged file.
  void read(const std::vector<int>& selected, const Rectangle& window, FloatOutput out);
  /// The same for one integer channel (is_integer()), as integers.
  void read(int channel, const Rectangle& window, IdOutput out);

  struct State;  ///< private to core/sequence
  State& state() { return *state_; }
  const State& state() const { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

}  // namespace quell
