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

/// Collects errors and renders them as `file:line:column: error: message`, the line of the text, and a caret under the place.
class Diagnostics {
 public:
  void error(const Position& where, std::string message);
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  /// All errors, by place, separated by line feeds.
  std::string render() const;
  /// Throws an Error whose text is render(), when there are any.
  void throw_if_any(Fault fault = Fault::usage) const;

 private:
  struct Entry {
    Position where;
    std::string message;
  };
  std::vector<Entry> entries_;
};

/// The names nearest to a misspelt one, best first, at most three; names that are not close are left out.
std::vector<std::string> nearest(std::string_view misspelt, const std::vector<std::string>& names);
/// "; did you mean 'sigma'?" for nearest(), or "" when nothing is close.
std::string did_you_mean(std::string_view misspelt, const std::vector<std::string>& names);
/// "'a', 'b' or 'c'" for messages.
std::string list_names(const std::vector<std::string>& names, std::string_view last_joint = "or");

}  // namespace quell
