#include "tests/bench/figure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "quell/runtime/executor.h"

namespace quell::bench {

std::vector<double> time_alternately(int repeats, const std::vector<std::function<double()>>& ways) {
  std::vector<double> best(ways.size(), std::numeric_limits<double>::infinity());
  for (int i = 0; i < repeats; ++i)
    for (std::size_t k = 0; k < ways.size(); ++k) best[k] = std::min(best[k], ways[k]());
  return best;
}

void require_same_filter(const FloatImage& got, const std::function<float(int, int)>& want, const std::string& what) {
  long close = 0;
  for (int y = 0; y < got.height; ++y)
    for (int x = 0; x < got.width; ++x) {
      const float wanted = want(x, y);
      if (std::abs(got.at(x, y) - wanted) <= 1e-2F * std::abs(wanted) + 1e-6F) ++close;
    }
  if (static_cast<double>(close) < 0.9 * got.width * got.height)
    throw std::runtime_error(what + " does something else than the pass");
}

double spread(const std::vector<double>& values) {
  const auto [smallest, largest] = std::ranges::minmax(values);
  return largest / smallest - 1;
}

std::string in_milliseconds(double a, double b) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4g ms and %.4g ms", a * 1e3, b * 1e3);
  return text;
}

std::string in_nanoseconds(const std::vector<double>& seconds, const char* unit) {
  std::string text;
  for (const double s : seconds) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.4g", text.empty() ? "" : ", ", s * 1e9);
    text += number;
  }
  return text + " " + unit;
}

int acceptance_threads() { return std::min(2, available_threads()); }

}  // namespace quell::bench
