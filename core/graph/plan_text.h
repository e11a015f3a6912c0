// Plain text for people: tables, numbers with units. Private to this box.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "quell/image/item.h"

namespace quell::planning {

/// Rows of cells in columns as wide as their widest cell. A heading has a line of its own and widens no column.
class Table {
 public:
  explicit Table(std::size_t indent) : indent_(indent) {}
  void add_heading(std::string text) { lines_.push_back({std::move(text), {}}); }
  void add_row(std::vector<std::string> cells) { lines_.push_back({{}, std::move(cells)}); }
  /// Every line ends with a line feed.
  std::string render() const;

 private:
  struct Line {
    std::string heading;  // unless there are cells
    std::vector<std::string> cells;
  };
  std::size_t indent_;
  std::vector<Line> lines_;
};

/// Breaks text between words into lines of at most 110 bytes, each indented and ended.
std::string wrap(const std::string& text, std::size_t indent);

/// "512 B", "3.5 KiB", "10.6 MiB", "1.20 GiB".
std::string format_bytes(std::size_t bytes);
/// "1280 x 720", "8 values", or nothing for a camera.
std::string format_size(const Shape& shape);
/// "1 frame", "2 frames".
std::string format_count(long long count, const std::string& noun);

}  // namespace quell::planning
