#include "text_layout.h"

namespace quell::app {

// UTF-8's continuation bytes take no column.
std::size_t columns_of(std::string_view text) {
  std::size_t columns = 0;
  for (const char c : text) columns += (static_cast<unsigned char>(c) & 0xc0u) == 0x80u ? 0 : 1;
  return columns;
}

namespace {

void wrap_line(std::string_view line, std::size_t indent, std::string& out) {
  const std::string margin(indent, ' ');
  std::size_t column = 0;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    if (line.empty()) break;
    const std::string_view word = line.substr(0, line.find(' '));
    line.remove_prefix(word.size());
    if (column > 0 && column + 1 + columns_of(word) > kColumns) out += '\n', column = 0;
    out += column == 0 ? margin : " ";
    column += (column == 0 ? indent : 1) + columns_of(word);
    out += word;
  }
  out += '\n';
}

}  // namespace

std::string wrap(std::string_view text, std::size_t indent) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    wrap_line(text.substr(0, end), indent, out);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string entry(std::string_view left, std::string_view right, std::size_t indent, std::size_t column) {
  std::string head = std::string(indent, ' ').append(left);
  std::string body = wrap(right, column);
  if (body.empty()) return head + "\n";
  if (columns_of(head) + 2 > column) return head + "\n" + body;
  return head + body.substr(columns_of(head));
}

}  // namespace quell::app
