// One frame by itself, node after node.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "quell/runtime/lane.h"

namespace quell {

/// Runs every step of a frame that has begun, or those that its history needs, in the plan's order. Throws Cancelled.
void compute_steps(Lane& lane, const PlanState& state, bool history_only = false);

/// Computes a frame from its inputs, one item for each of the graph's (nothing where it is absent), and returns what
/// Plan::results() names. What is left from an earlier time that this frame, or one after it, was computed, is void. Throws
/// Error(frame) with the words of the first node that failed, Cancelled.
std::vector<std::pair<std::string, Item>> compute_frame(Lane& lane, PlanState& state, std::int64_t frame,
                                                        std::vector<Item> inputs);

}  // namespace quell
