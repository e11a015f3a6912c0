// Images as the report's page carries them: half floats where these hold the values, deflated, in text.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "quell/image/image.h"

namespace quell::app {

/// The nearest half float, ties to even; beyond the largest one infinity, NaN stays NaN.
std::uint16_t to_half(float value);

/// The lower and higher bytes of a value stand in planes of their own, lowest first, each with the pixels of all channels, row by
/// row; these bytes are deflated (zlib's format, which a browser's DecompressionStream reads) and written in Base64.
struct PackedImage {
  Size size;
  int channels = 0;
  std::string format;  ///< "f16"; "f32" where they do not do; "u32" for ids
  std::string text;
  bool operator==(const PackedImage&) const = default;
};

/// What is kept of floats.
enum class Precision {
  shown,  ///< the nearest half floats, unless a value is beyond them
  exact,  ///< floats, unless half floats hold the same values
};
PackedImage pack(const Image& image, Precision precision = Precision::shown);

/// All images of a report, by number. Thread-safe.
class PackedImages {
 public:
  /// The number of an equal image where there is one: graphs have much in common.
  int add(PackedImage image);
  /// Bytes of text so far.
  std::size_t bytes() const;
  /// Not while one is added.
  const std::vector<PackedImage>& all() const { return images_; }

 private:
  mutable std::mutex mutex_;
  std::vector<PackedImage> images_;
  std::unordered_multimap<std::size_t, int> by_hash_;
  std::size_t bytes_ = 0;
};

}  // namespace quell::app
