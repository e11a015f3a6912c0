// A plan that runs: its wiring, and what outlasts a frame.
#pragma once

#include <vector>

#include "quell/runtime/history.h"
#include "quell/runtime/wiring.h"

namespace quell {

struct PlanState {
  Plan plan;
  Wiring wiring;
  History history;
  std::vector<Item> constants;  ///< of Wiring::constants

  /// `cuts`: see History.
  PlanState(Plan to_run, int frames_in_flight, BufferPool& pool, std::vector<std::int64_t> cuts = {});
};

}  // namespace quell
