// What one set of parameters is worth: the figures of a graph's output over frames of a sequence.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "job.h"
#include "measuring_sink.h"
#include "quell/graph/graph.h"
#include "quell/runtime/rerun.h"

namespace quell::app {

/// What is searched by: a metric, or "mixed", the geometric mean of mse, relmse and flip, each over its figure at the start.
struct Goal {
  std::string name;
  std::vector<Metric> metrics;
};
/// "psnr", or another metric that is known of every frame by itself, or "mixed". Throws Error(usage) with --metric as its place.
Goal parse_goal(const std::string& name);

/// Figures of the goal's metrics.
using Figures = std::vector<double>;
/// Smaller is better. `start` are those that the search began with.
double cost(const Goal& goal, const Figures& figures, const Figures& start);
/// "psnr 31.24 dB"; "mixed 0.93", and what it is made of.
std::string figures_text(const Goal& goal, const Figures& figures, const Figures& start);

/// Runs a graph over frames again and again, and measures its only color output, or its first.
class Trials {
 public:
  /// Frames are those of the job. Throws Error(usage) when the graph has no color output.
  Trials(const Job& job, MeasuringOptions options, SessionOptions session);

  /// Of a graph that differs from the one before in parameters alone: figures of each set of frames. The frames up to the last
  /// of all sets are run. Throws Error(frame) when one fails, Error(input) when one cannot be measured, Interrupted when a
  /// signal came.
  std::vector<Figures> run(const std::shared_ptr<const Graph>& graph, const std::vector<std::vector<std::int64_t>>& sets);

  struct Interrupted {};

 private:
  const Job& job_;
  MeasuringOptions options_;
  SessionOptions session_;
  Rerun rerun_;
  int count_ = 0;
};

}  // namespace quell::app
