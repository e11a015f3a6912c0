// A series of images that is compared with another: files of one input, by frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quell/sequence/sequence.h"

namespace quell::app {

/// What the images are, which decides what is taken of a folder.
enum class SeriesRole {
  reference,  ///< the input `reference` where there is one, else `color`
  image,      ///< `color`
  motion,     ///< `motion`
};

class ImageSeries {
 public:
  /// `what` is a folder, a sequence.json, or files as --in takes them: "out/color.####.exr", "a.exr:ViewLayer.Combined",
  /// "a.png:transfer=linear". `options` tells the part of the images to read. Throws Error(input) or Error(usage), naming `what`.
  static ImageSeries open(const std::string& what, SeriesRole role, SequenceOptions options = {});
  /// An input of a sequence that is open. Throws Error(input) when there is no such input.
  ImageSeries(std::shared_ptr<Sequence> sequence, std::string input);

  /// Folder and pattern, with the layer that was named, for people.
  std::string files() const { return files_; }
  /// Names for it, the most telling first: the layer, the file's stem or the folder's name, then the folders above.
  const std::vector<std::string>& names() const { return names_; }
  /// Whether it is one file, named as such.
  bool is_single() const { return single_.has_value(); }

  /// On disk, ascending.
  const std::vector<std::int64_t>& frames() const { return frames_; }
  /// Those that its sequence.json, if it has one, chooses; else those on disk.
  const std::vector<std::int64_t>& wanted_frames() const { return wanted_; }
  bool has(std::int64_t frame) const;

  /// Of a single file, that one for every frame, as in all that follows.
  std::filesystem::path file(std::int64_t frame) const;
  /// Of the first frame, by its header. Throws Error(input).
  Size size() const;
  /// Color, or motion. Throws Error(input).
  Image read(std::int64_t frame, BufferPool& pool) const;
  /// Whether the first file holds what a display shows, an sRGB curve that reading undoes. Reads it. Throws Error(input).
  bool is_display_referred(BufferPool& pool) const;

  const std::shared_ptr<Sequence>& sequence() const { return sequence_; }

 private:
  std::shared_ptr<Sequence> sequence_;
  std::string input_, files_;
  std::vector<std::string> names_;
  std::vector<std::int64_t> frames_, wanted_;
  std::optional<std::int64_t> single_;
};

/// An operand of `quell compare`: "[LABEL=]WHAT".
struct Operand {
  std::string label;  ///< "" when not given
  std::string what;
};
/// A file of the whole text's name is taken for itself, whatever its name.
Operand parse_operand(const std::string& text);

/// A label for each series: the one given, else the shortest that is distinct; never "reference". Throws Error(usage) when two
/// given ones are equal, or one cannot be part of a file's name.
std::vector<std::string> make_labels(const std::vector<Operand>& operands, const std::vector<ImageSeries>& series);

}  // namespace quell::app
