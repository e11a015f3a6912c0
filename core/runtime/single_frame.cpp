#include "quell/runtime/single_frame.h"

namespace quell {

void compute_steps(Lane& lane, const PlanState& state, bool history_only) {
  for (int step = 0; step < static_cast<int>(state.wiring.steps.size()); ++step) {
    const bool is_wanted = !history_only || state.wiring.feeds_history[static_cast<std::size_t>(step)];
    if (!is_wanted || lane.is_lost(step)) {
      lane.skip(step);
      continue;
    }
    lane.fetch(step);
    lane.run(step);
    lane.publish(step);
  }
}

std::vector<std::pair<std::string, Item>> compute_frame(Lane& lane, PlanState& state, std::int64_t frame,
                                                        std::vector<Item> inputs) {
  state.history.forget_from(frame);
  lane.begin(frame, {std::move(inputs), {}});
  try {
    compute_steps(lane, state);
  } catch (const Cancelled&) {
    lane.clear();
    state.history.forget_from(frame);
    throw;
  }
  state.history.advance(frame);
  std::vector<std::pair<std::string, Item>> results;
  for (std::size_t i = 0; i < state.wiring.results.size(); ++i)
    results.emplace_back(state.wiring.results[i].first, lane.result(i));
  const bool ok = lane.failed_node() < 0;
  const std::string error = ok ? "" : lane.error();
  lane.clear();
  if (!ok) throw Error(Fault::frame, "", error);
  return results;
}

}  // namespace quell
