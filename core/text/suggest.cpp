// "Did you mean": the rule of Clang, with a limit of a third of the misspelt name's length.
#include <algorithm>
#include <cctype>
#include <numeric>

#include "quell/text/diagnostic.h"

namespace quell {
namespace {

bool equal_but_for_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

// Damerau-Levenshtein distance (optimal string alignment): insertions, deletions, replacements, swapped neighbors.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::vector<std::string> nearest(std::string_view misspelt, const std::vector<std::string>& names) {
  constexpr std::size_t kLongest = 200;  // nobody mistypes more than that, and the distance costs the product of the lengths
  if (misspelt.empty() || misspelt.size() > kLongest) return {};
  // A distance of the whole length would be another name altogether.
  const std::size_t limit = std::min((misspelt.size() + 2) / 3, misspelt.size() - 1);
  std::vector<std::pair<std::size_t, std::string>> close;
  for (const std::string& name : names) {
    const std::size_t longer = std::max(name.size(), misspelt.size()), shorter = std::min(name.size(), misspelt.size());
    if (equal_but_for_case(name, misspelt))
      close.emplace_back(0, name);
    else if (longer - shorter <= limit) {
      const std::size_t distance = edit_distance(misspelt, name);
      if (distance <= limit) close.emplace_back(distance, name);
    }
  }
  std::stable_sort(close.begin(), close.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> result;
  for (const auto& [distance, name] : close)
    if (result.size() < 3) result.push_back(name);
  return result;
}

std::string did_you_mean(std::string_view misspelt, const std::vector<std::string>& names) {
  const std::vector<std::string> close = nearest(misspelt, names);
  return close.empty() ? "" : "; did you mean " + list_names(close) + "?";
}

std::string list_names(const std::vector<std::string>& names, std::string_view last_joint) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 < names.size() ? ", " : " " + std::string(last_joint) + " ";
    list += "'" + names[i] + "'";
  }
  return list;
}

}  // namespace quell
