#include "tests/bench/figure.h"

#include <algorithm>
#include <limits>

#include "quell/runtime/executor.h"

namespace quell::bench {

std::vector<double> time_alternately(int repeats, const std::vector<std::function<double()>>& ways) {
  std::vector<double> best(ways.size(), std::numeric_limits<double>::infinity());
  for (int i = 0; i < repeats; ++i)
    for (std::size_t k = 0; k < ways.size(); ++k) best[k] = std::min(best[k], ways[k]());
  return best;
}

double spread(const std::vector<double>& values) {
  const auto [smallest, largest] = std::ranges::minmax(values);
  return largest / smallest - 1;
}

int acceptance_threads() { return std::min(2, available_threads()); }

}  // namespace quell::bench
