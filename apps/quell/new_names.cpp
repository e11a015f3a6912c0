#include "new_names.h"

#include <algorithm>
#include <array>

#include "quell/text/diagnostic.h"

namespace quell::app {
namespace {

constexpr std::size_t kLongest = 64;  // with what is added, still a file name everywhere

// Targets that CMake makes by itself, and macros that compilers define.
constexpr std::array<std::string_view, 12> kReserved = {"all",     "clean",      "edit_cache", "help", "install", "linux",
                                                        "package", "preinstall", "quell",      "test", "unix",    "tests"};

bool is_small(char c) { return c >= 'a' && c <= 'z'; }
bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_snake_case(std::string_view name) {
  const auto allowed = [](char c) { return is_small(c) || is_digit(c) || c == '_'; };
  return !name.empty() && is_small(name.front()) && std::all_of(name.begin(), name.end(), allowed);
}

/// "Soften-Edges" and "SoftenEdges" -> "soften_edges"; "" when nothing of use is left.
std::string snake_case(std::string_view name) {
  std::string text;
  char previous = '_';
  for (const char c : name) {
    const bool starts_word = !is_small(c) && !is_digit(c) && (!is_capital(c) || is_small(previous));
    if (starts_word && !text.empty() && text.back() != '_') text += '_';
    if (is_capital(c)) text += static_cast<char>(c - 'A' + 'a');
    if (is_small(c) || (is_digit(c) && !text.empty())) text += c;
    previous = c;
  }
  while (text.ends_with('_')) text.pop_back();
  return text;
}

}  // namespace

void check_new_name(const std::string& name, const char* what) {
  const auto refuse = [&](const std::string& why) {
    throw Error(Fault::usage, "", "'" + printable(name) + "' cannot be the name of " + what + ": " + why);
  };
  if (name.size() > kLongest) refuse("it is longer than " + std::to_string(kLongest) + " characters");
  if (!is_snake_case(name)) {
    const std::string better = snake_case(name);
    refuse("names have small letters, digits and '_', and start with a letter" +
           (is_snake_case(better) ? "; did you mean '" + better + "'?" : ""));
  }
  if (std::find(kReserved.begin(), kReserved.end(), name) != kReserved.end())
    refuse("quell, CMake or compilers keep this word for themselves; choose another, such as 'my_" + name + "'");
}

std::string pascal_case(std::string_view name) {
  std::string text;
  bool starts_word = true;
  for (const char c : name) {
    if (c != '_') text += starts_word && is_small(c) ? static_cast<char>(c - 'a' + 'A') : c;
    starts_word = c == '_';
  }
  return text;
}

std::string class_name(std::string_view name, std::string_view suffix) {
  const std::string text = pascal_case(name);
  const bool has_it = text.size() > suffix.size() && text.ends_with(suffix);
  return has_it ? text : text + std::string(suffix);
}

std::string fill_template(std::string_view text, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string filled;
  while (!text.empty()) {
    const auto value =
        std::find_if(values.begin(), values.end(), [&](const auto& entry) { return text.starts_with(entry.first); });
    if (value == values.end()) {
      filled += text.front();
      text.remove_prefix(1);
    } else {
      filled += value->second;
      text.remove_prefix(value->first.size());
    }
  }
  return filled;
}

}  // namespace quell::app
