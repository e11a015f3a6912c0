// How many frames before a frame its results depend on: what a part of a sequence has to compute first, so that it fits what lies
// before it.
#pragma once

#include <optional>
#include <string>

#include "quell/graph/plan.h"

namespace quell {

struct Preroll {
  std::optional<int> frames;  ///< nothing: there is no such number
  std::string reason;  ///< what decides it, for people: "'blend' keeps 0.8 of its history, of which 21 frames leave 0.0092"
};

/// Edges that look back need as many frames as they look back. A loop needs, for each way through it, as many frames as the
/// passes on it say that history lasts: until no more than `tolerance` of it is left, and until what they count has settled (see
/// quell_inference::kept). With a tolerance of 0 the frames are those that the results depend on at all.
///
/// What is left is the share of earlier frames in averages. Where a filter decides by their values, results may differ by more,
/// or by less.
Preroll find_preroll(const Plan& plan, double tolerance);

}  // namespace quell
