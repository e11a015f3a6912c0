#include "quell/text/json_clean.h"

#include <algorithm>

namespace quell::detail {
namespace {

// Length of the UTF-8 sequence at the start of `text`; 0 when there is none. Ranges of Table 3-7 of the Unicode standard.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto tail = [&](std::size_t i) { return byte(i) >= 0x80 && byte(i) <= 0xBF; };
  const unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return tail(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const unsigned low = first == 0xE0 ? 0xA0 : 0x80, high = first == 0xED ? 0x9F : 0xBF;
    return second >= low && second <= high && tail(2) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const unsigned low = first == 0xF0 ? 0x90 : 0x80, high = first == 0xF4 ? 0x8F : 0xBF;
    return second >= low && second <= high && tail(2) && tail(3) ? 4 : 0;
  }
  return 0;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

class Cleaner {
 public:
  Cleaner(const SourceTextPtr& source, Diagnostics& errors) : source_(source), errors_(errors), text_(source->text) {}

  std::optional<std::string> run() {
    if (!check_encoding()) return std::nullopt;
    if (text_.starts_with("\xEF\xBB\xBF")) blank(0, 3);
    for (at_ = 0; at_ < text_.size();)
      if (!step()) return std::nullopt;
    if (open_.empty()) return std::move(text_);
    const std::size_t unclosed = suspect_.value_or(open_.back().offset);
    const std::string bracket(1, text_[unclosed]), expected(1, closing(text_[unclosed]));
    const std::string hint = suspect_ ? ", as the indentation tells" : "";
    return fail(unclosed, "this '" + bracket + "' is never closed" + hint + "; expected '" + expected + "'");
  }

 private:
  static char closing(char bracket) { return bracket == '{' ? '}' : ']'; }

  std::nullopt_t fail(std::size_t offset, std::string message) {
    errors_.error({source_, offset}, std::move(message));
    return std::nullopt;
  }
  void blank(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (text_[i] == '\n')
        line_begin_ = i + 1;
      else if (text_[i] != '\r')
        text_[i] = ' ';
    }
  }

  bool check_encoding() {
    const std::size_t bad = first_invalid_utf8(text_);
    if (bad == text_.size()) return true;
    const bool utf16 = text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF");
    fail(bad, utf16 ? "this is UTF-16; expected UTF-8 text" : "this byte is not valid UTF-8; expected UTF-8 text");
    return false;
  }

  // Takes one bracket, string, comment or other character.
  bool step() {
    const char c = text_[at_];
    if (c == '"') return take_string();
    if (c == '/') return take_comment();
    if (c == '{' || c == '[') return open();
    if (c == '}' || c == ']') return close();
    // The parser would take a zero for the end of the text.
    if (static_cast<unsigned char>(c) < 0x20 && !is_space(c))
      return fail(at_, "unexpected control character " + std::to_string(c)), false;
    if (c == '\n') line_begin_ = at_ + 1;
    if (c == ',')
      comma_ = at_;
    else if (!is_space(c))
      comma_.reset();
    ++at_;
    return true;
  }

  bool take_string() {
    comma_.reset();
    const std::size_t begin = at_++;
    for (; at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n'; ++at_) {
      if (text_[at_] == '\\' && at_ + 1 < text_.size() && text_[at_ + 1] != '\n') {
        ++at_;
      } else if (static_cast<unsigned char>(text_[at_]) < 0x20 && text_[at_] != '\r') {
        fail(at_, text_[at_] == '\t' ? "a tab inside of a string is written \\t" : "a control character inside of a string");
        return false;
      }
    }
    if (at_ < text_.size() && text_[at_] == '"') return ++at_, true;
    fail(begin, "this string is never closed; expected '\"' before the end of the line");
    return false;
  }

  bool take_comment() {
    const std::size_t begin = at_;
    const char kind = at_ + 1 < text_.size() ? text_[at_ + 1] : ' ';
    if (kind == '/') {
      at_ = std::min(text_.find('\n', begin), text_.size());
    } else if (kind == '*') {
      const std::size_t end = text_.find("*/", begin + 2);
      if (end == std::string::npos) return fail(begin, "this comment is never closed; expected '*/'"), false;
      at_ = end + 2;
    } else {
      return fail(begin, "unexpected '/'; comments start with '//' or '/*'"), false;
    }
    blank(begin, at_);
    return true;
  }

  bool open() {
    comma_.reset();
    open_.push_back({at_++, indentation()});
    if (open_.size() <= kDeepestJson) return true;
    fail(at_ - 1, "brackets are nested more than " + std::to_string(kDeepestJson) + " deep");
    return false;
  }

  bool close() {
    const std::string bracket = std::string("'") + text_[at_] + "'";
    if (open_.empty()) return fail(at_, "this " + bracket + " closes nothing; remove it"), false;
    const Position opened{source_, open_.back().offset};
    const char expected = closing(text_[opened.offset]);
    if (text_[at_] != expected) {
      fail(at_, "this " + bracket + " does not match the '" + text_[opened.offset] + "' of line " +
                    std::to_string(opened.line()) + ", column " + std::to_string(opened.column()) + "; expected '" + expected +
                    "'");
      return false;
    }
    // A comma after nothing ("[,]") is no trailing comma.
    if (comma_ && follows_value(*comma_)) blank(*comma_, *comma_ + 1);
    comma_.reset();
    const bool starts_line = line_begin_ + indentation() == at_;
    if (!suspect_ && starts_line && indentation() != open_.back().indentation) suspect_ = opened.offset;
    open_.pop_back();
    ++at_;
    return true;
  }

  // Of the line that is being read.
  std::size_t indentation() const { return text_.find_first_not_of(" \t", line_begin_) - line_begin_; }

  bool follows_value(std::size_t comma) const {
    const std::size_t before = text_.find_last_not_of(" \t\r\n", comma - 1);
    return comma > 0 && before != std::string::npos && std::string_view("[{,:").find(text_[before]) == std::string_view::npos;
  }

  const SourceTextPtr& source_;
  Diagnostics& errors_;
  std::string text_;
  std::size_t at_ = 0;
  std::size_t line_begin_ = 0;
  struct Bracket {
    std::size_t offset, indentation;  // the latter of its line
  };
  std::vector<Bracket> open_;           // around what is being read
  std::optional<std::size_t> suspect_;  // the first bracket that was closed by one of another indentation
  std::optional<std::size_t> comma_;    // the last character that was neither space nor comment, when it was a comma
};

}  // namespace

std::size_t first_invalid_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text.substr(at, 4));
    if (length == 0) return at;
    at += length;
  }
  return text.size();
}

std::optional<std::string> clean_json(const SourceTextPtr& source, Diagnostics& errors) { return Cleaner(source, errors).run(); }

}  // namespace quell::detail
