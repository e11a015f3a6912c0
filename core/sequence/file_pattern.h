// File names with a frame number in them: "beauty_%d.exr", "color.%04d.exr", "color.####.exr".
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quell/text/diagnostic.h"

namespace quell {

/// A file name with one counter, in a folder. The counter is `%d`, `%04d` (at least 4 characters, a minus sign counted, as in C)
/// or `####` (at least 4 digits, a minus sign not counted); `%%` is a percent sign.
class FilePattern {
 public:
  FilePattern() = default;
  /// Throws Error(usage), with a caret, for no counter, two of them, one in the folder's name, or a malformed one. A relative
  /// pattern is taken from `base`. `source` is the option or file that messages name.
  static FilePattern parse(std::string_view text, const std::filesystem::path& base, const std::string& source);
  /// The same for text that stands at a place in a larger one; the error, if any, is added to `errors`.
  static std::optional<FilePattern> parse(std::string_view text, const std::filesystem::path& base, const Position& where,
                                          Diagnostics& errors);
  /// FOLDER/<prefix><at least `digits` digits><suffix>.
  FilePattern(std::filesystem::path folder, std::string prefix, int digits, std::string suffix);

  /// One file, which is that frame, whether a number stands in its name or not. It is its own pattern.
  static FilePattern single(const std::filesystem::path& file, std::int64_t frame);

  const std::filesystem::path& folder() const { return folder_; }
  /// The file name's pattern as it was written; that of the constructor is written with `#`, or `%d` when not padded.
  const std::string& name() const { return name_; }
  /// Folder and name.
  std::string text() const { return (folder_ / name_).string(); }
  /// Least number of digits; 1 when not padded.
  int digits() const { return digits_; }

  /// What files are called besides their number: the text before it, without the dot or underline in between, or, of a single
  /// file, the name without its extension.
  std::string stem() const;
  /// The frame of a single file.
  const std::optional<std::int64_t>& single_frame() const { return single_frame_; }

  /// Of a single file, its name for every frame.
  std::string file_name(std::int64_t frame) const;
  std::filesystem::path path(std::int64_t frame) const { return folder_ / file_name(frame); }

  struct Match {
    std::int64_t frame;
    bool exact;  ///< false: the number is padded in another way, so that file_name(frame) differs
  };
  std::optional<Match> match(std::string_view name) const;

 private:
  std::filesystem::path folder_;
  std::string prefix_, suffix_, name_;
  int digits_ = 1;
  std::optional<std::int64_t> single_frame_;  // then the name is prefix_
  bool sign_counts_ = false;                  // as in printf
};

/// A number with at least `digits` digits, a minus sign not counted.
std::string padded(std::int64_t number, int digits);

/// A file name with a frame number before its extension, taken apart: "beauty_", "12", ".exr".
struct NumberedName {
  std::string prefix, number, suffix;
};
/// Nothing when no number stands there after a dot or an underline.
std::optional<NumberedName> take_apart(const std::string& name);

/// The files of a pattern in a folder's listing.
struct FrameFiles {
  std::vector<std::int64_t> frames;           ///< ascending
  std::vector<std::string> padded_otherwise;  ///< names that match but for the padding, and so are left out
};
FrameFiles find_frames(const FilePattern& pattern, const std::vector<std::string>& listing);

/// Names of the regular files in a folder, sorted. Throws Error(input) when it is missing or cannot be read.
std::vector<std::string> list_files(const std::filesystem::path& folder);

}  // namespace quell
