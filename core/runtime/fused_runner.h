// Runs fused nodes on one frame: each thread takes a band of rows and goes down it a few rows at a time, node after node.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quell/graph/plan.h"
#include "quell/runtime/failure.h"
#include "quell/runtime/host.h"
#include "quell/runtime/raw_port.h"

namespace quell {

/// Keeps its tables from frame to frame, as NodeRunner does. One frame at a time.
class FusedRunner {
 public:
  /// `turn` is fused, and one of the plan's, which outlives the runner. `name` stands in the trace.
  FusedRunner(std::string name, const Plan& plan, const PlannedTurn& turn, const HostServices& services, BufferPool& pool);
  ~FusedRunner();
  FusedRunner(FusedRunner&&) noexcept;

  /// What goes into each node and comes out of it, by position in Plan::nodes.
  struct Tables {
    std::vector<PortItems> inputs, outputs;
    std::vector<Outcome> outcomes;
    std::vector<std::string> errors;
    std::vector<double> seconds;
  };
  /// Computes the outputs of all nodes but those that are lost, as NodeRunner::run does. Items that fused nodes yield are not
  /// among the inputs, and outputs that are Plan::inner stay empty. A node that fails, or is lost with that, harms no other. The
  /// time that all took is divided among them as the threads spent it. Throws Cancelled, and what the pool throws.
  void run(std::int64_t frame, Tables& tables);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace quell
