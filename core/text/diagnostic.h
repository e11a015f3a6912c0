// Errors with their place in a text, collected so that all of them are told in one go.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "quell/text/error.h"

namespace quell {

/// A text and the name under which messages speak of it: a file's path, or an option such as "--set".
struct SourceText {
  std::string name;
  std::string text;
};
using SourceTextPtr = std::shared_ptr<const SourceText>;

/// A place in a text. Columns count bytes from 1, as compilers do.
struct Position {
  SourceTextPtr source;
  std::size_t offset = 0;
  int line() const;
  int column() const;
};

/// Another place that helps to understand an error; rendered after it as `file:line:column: note: message`.
struct Note {
  Position where;
  std::string message;
};

/// Collects errors and renders them as `file:line:column: error: message`, the line of the text, and a caret under the place.
class Diagnostics {
 public:
  void error(const Position& where, std::string message, std::vector<Note> notes = {});
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  /// All errors, by place, separated by line feeds; files stand in the order of their first error, and what was said of a place
  /// once is not repeated. A position without a source gives the message alone. From the 200th on, errors are only counted.
  std::string render() const;
  /// Throws an Error whose text is render(), when there are any.
  void throw_if_any(Fault fault = Fault::usage) const;

 private:
  struct Entry {
    Position where;
    std::string message;
    std::vector<Note> notes;
  };
  std::vector<const Entry*> by_place() const;
  static std::string render(const Entry& entry);
  std::vector<Entry> entries_;
};

/// The text with control characters but line feeds and tabs, and broken UTF-8, replaced by '?': what may reach a terminal.
std::string printable(std::string_view text);

/// The names nearest to a misspelt one, best first, at most three; names that are not close are left out. Names that differ in
/// case alone come first; else close means an edit distance (swapped neighbors count once) of at most a third of the length.
std::vector<std::string> nearest(std::string_view misspelt, const std::vector<std::string>& names);
/// "; did you mean 'sigma'?" for nearest(), or "" when nothing is close.
std::string did_you_mean(std::string_view misspelt, const std::vector<std::string>& names);
/// "'a', 'b' or 'c'" for messages.
std::string list_names(const std::vector<std::string>& names, std::string_view last_joint = "or");

}  // namespace quell
