#include "quell/graph/plan_text.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace quell::planning {

std::string Table::render() const {
  std::vector<std::size_t> widths;
  for (const Line& line : lines_)
    for (std::size_t i = 0; i < line.cells.size(); ++i) {
      widths.resize(std::max(widths.size(), i + 1), 0);
      widths[i] = std::max(widths[i], line.cells[i].size());
    }
  std::string text;
  for (const Line& line : lines_) {
    std::string row = line.heading;
    if (!line.cells.empty()) row.assign(indent_, ' ');
    for (std::size_t i = 0; i < line.cells.size(); ++i) {
      row += line.cells[i];
      if (widths[i] > 0) row.append(widths[i] - line.cells[i].size() + 2, ' ');
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

std::string wrap(const std::string& text, std::size_t indent) {
  constexpr std::size_t kColumns = 110;
  std::istringstream words(text);
  std::string result, line, word;
  const auto finish = [&] {
    if (!line.empty()) result += std::string(indent, ' ') + line + "\n";
    line.clear();
  };
  while (words >> word) {
    if (!line.empty() && indent + line.size() + 1 + word.size() > kColumns) finish();
    line += (line.empty() ? "" : " ") + word;
  }
  finish();
  return result;
}

std::string format_bytes(std::size_t bytes) {
  struct Unit {
    double size;
    const char* format;
  };
  constexpr Unit kUnits[] = {{1024.0 * 1024 * 1024, "%.2f GiB"}, {1024.0 * 1024, "%.1f MiB"}, {1024.0, "%.1f KiB"}};
  char text[32];
  for (const Unit& unit : kUnits)
    if (static_cast<double>(bytes) >= unit.size) {
      std::snprintf(text, sizeof text, unit.format, static_cast<double>(bytes) / unit.size);
      return text;
    }
  return std::to_string(bytes) + " B";
}

std::string format_size(const Shape& shape) {
  if (is_image(shape.type)) return std::to_string(shape.size.width) + " x " + std::to_string(shape.size.height);
  return shape.type == QUELL_TYPE_VALUE ? format_count(shape.value_count, "value") : "";
}

std::string format_count(long long count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace quell::planning
