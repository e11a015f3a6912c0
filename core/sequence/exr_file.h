// Reading the planes of an OpenEXR file.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "quell/image/image.h"

namespace quell {

/// Part of an image, in its pixels.
struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Rectangle&) const = default;
};

/// An open file (its first part). The image is the display window; the data window may cover less of it, or more. Decodes on the
/// calling thread alone. Not thread-safe; any number may be open at a time.
class ExrFile {
 public:
  /// Throws Error(input) for a file that is missing, is not OpenEXR, is deep, or whose header claims a size beyond
  /// Image::kMaxSize. Takes no memory for pixels.
  explicit ExrFile(const std::filesystem::path& path);
  ~ExrFile();

  Size size() const { return size_; }
  /// The part of the image for which the file holds pixels; empty when none.
  const Rectangle& covered() const { return covered_; }
  /// Whether the data window reaches beyond the image.
  bool cropped() const { return cropped_; }
  const std::vector<std::string>& channels() const { return channels_; }
  bool is_uint(int channel) const;

  /// Reads channels (indices into channels()) into the planes of an image of size(), 0 outside covered(). Half and float keep
  /// their bits' value; uint is rounded to float. Throws Error(input) for a truncated or damaged file.
  void read(const std::vector<int>& selected, FloatOutput out);
  /// The same for one uint channel.
  void read(int channel, IdOutput out);

 private:
  struct Input;
  [[noreturn]] void fail(const std::string& what) const;
  template <class Value, class Store>
  void read_rows(int first, int count, const Store& store);

  std::filesystem::path path_;
  std::unique_ptr<Input> input_;
  Size size_;
  Rectangle data_, covered_;  // both relative to the image
  bool cropped_ = false;
  std::vector<std::string> channels_;
};

}  // namespace quell
