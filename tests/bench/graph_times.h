// What a frame costs a graph that ships, in memory, once history is there.
#pragma once

#include <string>
#include <vector>

#include "quell/graph/plan.h"

namespace quell::bench {

struct GraphTimes {
  Plan plan;
  std::string from;           ///< whose frames, for people
  double frame = 0;           ///< seconds, all nodes and what is between them
  double reading = 0;         ///< of it: looking through the inputs for NaN
  std::vector<double> nodes;  ///< seconds, in the order of the plan
};

/// One node after the other on that many threads. Of a frame that is in the middle of a sequence: the mean over the last frames
/// of a lap, of several laps the fastest.
GraphTimes time_graph(const std::string& name, Size size, int threads);

}  // namespace quell::bench
