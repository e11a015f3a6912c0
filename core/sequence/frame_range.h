// Which frames: "0-11", "1-100x2", "1,5,9-12".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quell/text/diagnostic.h"

namespace quell {

/// A set of frame numbers, ascending, as a person writes it: single frames and ranges `first-last`, both ends included, with an
/// optional step (`x2` or `:2`), separated by commas. Numbers may be negative ("-5--1").
class FrameRange {
 public:
  static constexpr std::size_t kMaxFrames = 10'000'000;

  FrameRange() = default;
  /// Any order, duplicates allowed.
  explicit FrameRange(std::vector<std::int64_t> frames);
  /// Throws Error(usage), with a caret under the place, for text that is malformed, descends, overflows 64 bits or names more
  /// than kMaxFrames frames. `source` is the option or file that messages name.
  static FrameRange parse(std::string_view text, const std::string& source = "--frames");
  /// The same for text that stands at a place in a larger one; the error, if any, is added to `errors`.
  static std::optional<FrameRange> parse(std::string_view text, const Position& where, Diagnostics& errors);

  /// Ascending, each once.
  const std::vector<std::int64_t>& frames() const { return frames_; }
  bool contains(std::int64_t frame) const;
  /// The shortest usual text for these frames: "1-8", "0-10x2", "1,5,9-12"; "none" when empty.
  std::string text() const;

 private:
  std::vector<std::int64_t> frames_;
};

}  // namespace quell
