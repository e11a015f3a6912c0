// What a frame costs a graph that ships, in memory, once history is there.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "quell/runtime/session.h"
#include "tests/bench/graph_frames.h"

namespace quell::bench {

/// Means over the frames of a lap that are in the middle of a sequence.
struct LapTimes {
  double frame = 0;           ///< seconds, all nodes and what is between them
  double reading = 0;         ///< of it: looking through the inputs for NaN
  std::vector<double> nodes;  ///< seconds, in the order of the plan

  /// What is neither.
  double rest() const;
};

/// Runs a graph that ships over frames, lap after lap, one node after the other.
class GraphLaps {
 public:
  GraphLaps(const std::string& name, Size size, SessionOptions options, int count = GraphFrames::kFrames);
  /// The same graph and frames with other options.
  GraphLaps(const GraphLaps& other, SessionOptions options);

  LapTimes next();
  const Plan& plan() const { return *session_->plan(); }
  const std::string& from() const { return frames_->from(); }

 private:
  std::shared_ptr<const Graph> graph_;
  std::shared_ptr<GraphFrames> frames_;
  std::unique_ptr<Session> session_;
  int lap_ = 0;
};

/// Of several laps: of each figure the smallest.
struct GraphTimes {
  Plan plan;
  std::string from;  ///< whose frames, for people
  LapTimes best;
};
GraphTimes time_graph(const std::string& name, Size size, int threads);

}  // namespace quell::bench
