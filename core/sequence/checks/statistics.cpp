#include "quell/sequence/checks/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace quell {
namespace {

std::string formatted(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

void Distribution::sort() const {
  if (!sorted_) std::sort(values_.begin(), values_.end());
  sorted_ = true;
}

double Distribution::quantile(double share) const {
  if (values_.empty()) return 0;
  sort();
  const auto count = static_cast<double>(values_.size());
  const double rank = std::clamp(std::ceil(share * count), 1.0, count);
  return values_[static_cast<std::size_t>(rank) - 1];
}

double Distribution::share_within(double limit) const {
  if (values_.empty()) return 0;
  sort();
  const auto end = std::upper_bound(values_.begin(), values_.end(), limit, [](double a, float b) { return a < double{b}; });
  return static_cast<double>(end - values_.begin()) / static_cast<double>(values_.size());
}

std::string short_number(double value) {
  if (value == 0) return "0";
  if (std::abs(value) >= 99.5) return formatted(std::abs(value) < 1e7 ? "%.0f" : "%.2g", value);
  return formatted("%.2g", value);
}

std::string pixels(double value) { return short_number(value) + " px"; }

std::string percent(double share) {
  if (share <= 0) return "none";
  if (share >= 1) return "all";
  if (share < 0.0001) return "less than 0.01 %";
  if (share > 0.9999) return "more than 99.99 %";
  if (share < 0.01 || share > 0.99) return formatted("%.2f %%", 100 * share);
  return formatted("%.0f %%", 100 * share);
}

std::string percent_of(double share, const std::string& noun) { return percent(share) + " of " + noun; }

}  // namespace quell
