#include "quell/text/diagnostic.h"

#include <algorithm>
#include <map>
#include <set>

#include "quell/text/json_clean.h"

namespace quell {
namespace {

constexpr std::size_t kMostShown = 200;
constexpr std::size_t kLongestLine = 160;  // bytes; of longer ones, what is near the place is shown
constexpr std::size_t kContextBytes = 70;

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

std::string_view line_at(const Position& where, std::size_t& column) {
  const std::string_view text = where.source->text;
  const std::size_t offset = std::min(where.offset, text.size());
  const std::size_t before = offset == 0 ? std::string_view::npos : text.rfind('\n', offset - 1);
  const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
  std::string_view line = text.substr(begin, text.find('\n', offset) - begin);
  if (line.ends_with('\r')) line.remove_suffix(1);
  column = std::min(offset - begin, line.size());
  return line;
}

// The line of the text and, below it, a caret. Tabs stay tabs so that the caret stands under the place at any tab width.
std::string quote(const Position& where) {
  std::size_t column = 0;
  std::string_view line = line_at(where, column);
  std::string head, tail;
  const bool is_long = line.size() > kLongestLine;
  if (is_long && line.size() > column + kContextBytes) {
    std::size_t end = column + kContextBytes;
    while (end < line.size() && continues_character(line[end])) ++end;
    if (end < line.size()) line = line.substr(0, end), tail = "...";
  }
  if (is_long && column > kContextBytes) {
    std::size_t begin = column - kContextBytes;
    while (continues_character(line[begin])) --begin;
    if (begin > 0) line.remove_prefix(begin), column -= begin, head = "...";
  }
  std::string caret(head.size(), ' ');
  for (const char c : line.substr(0, column))
    if (!continues_character(c)) caret += c == '\t' ? '\t' : ' ';
  return "    " + head + printable(line) + tail + "\n    " + caret + "^";
}

std::string prefix(const Position& where) {
  if (!where.source) return "";
  return where.source->name + ":" + std::to_string(where.line()) + ":" + std::to_string(where.column()) + ": ";
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n') || c == 0x7f) c = '?';
  for (std::size_t bad; (bad = detail::first_invalid_utf8(result)) < result.size();) result[bad] = '?';
  return result;
}

int Position::line() const {
  if (!source) return 0;
  const std::string& text = source->text;
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text.size()));
  return static_cast<int>(std::count(text.begin(), end, '\n')) + 1;
}

int Position::column() const {
  if (!source) return 0;
  std::size_t column = 0;
  line_at(*this, column);
  return static_cast<int>(column) + 1;
}

void Diagnostics::error(const Position& where, std::string message, std::vector<Note> notes) {
  entries_.push_back({where, std::move(message), std::move(notes)});
}

std::vector<const Diagnostics::Entry*> Diagnostics::by_place() const {
  std::map<const SourceText*, std::size_t> order;
  std::vector<const Entry*> entries;
  for (const Entry& entry : entries_) {
    order.emplace(entry.where.source.get(), order.size());
    entries.push_back(&entry);
  }
  std::stable_sort(entries.begin(), entries.end(), [&](const Entry* a, const Entry* b) {
    const std::size_t source_a = order[a->where.source.get()], source_b = order[b->where.source.get()];
    return source_a != source_b ? source_a < source_b : a->where.offset < b->where.offset;
  });
  std::set<std::tuple<const SourceText*, std::size_t, std::string_view>> told;
  std::erase_if(entries, [&](const Entry* entry) {
    return !told.emplace(entry->where.source.get(), entry->where.offset, entry->message).second;
  });
  return entries;
}

std::string Diagnostics::render(const Entry& entry) {
  std::string result = prefix(entry.where) + "error: " + printable(entry.message);
  if (entry.where.source) result += "\n" + quote(entry.where);
  for (const Note& note : entry.notes) result += "\n" + prefix(note.where) + "note: " + printable(note.message);
  return result;
}

std::string Diagnostics::render() const {
  std::string result;
  const std::vector<const Entry*> entries = by_place();
  for (std::size_t i = 0; i < entries.size() && i < kMostShown; ++i) result += (i ? "\n" : "") + render(*entries[i]);
  if (entries.size() > kMostShown) result += "\nand " + std::to_string(entries.size() - kMostShown) + " more errors";
  return result;
}

void Diagnostics::throw_if_any(Fault fault) const {
  if (!empty()) throw Error(fault, "", render());
}

}  // namespace quell
