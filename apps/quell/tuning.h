// The search of `quell tune`, without graphs: for the place in a box where a figure is smallest.
#pragma once

#include <functional>
#include <vector>

namespace quell::app {

struct SearchOptions {
  int evaluations = 50;
  bool looks_everywhere = false;  ///< first over the whole box, with half of the evaluations
};

/// From `start`, with coordinates from 0 to 1, by Rowan's Subplex (NLopt's LN_SBPLX), which takes nothing for granted of the
/// figure but that near places have near figures; before it, when asked, by DIRECT-L (Gablonsky and Kelley 2001). The same for
/// the same figures. Whoever gives `cost` keeps what was best. Ends early when `cost` throws; what it throws comes back.
void find_least(const std::vector<double>& start, const SearchOptions& options,
                const std::function<double(const std::vector<double>&)>& cost);

}  // namespace quell::app
