// Runs fused nodes on one frame: each thread takes a band of rows and goes down it a few rows at a time, node after node.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quell/graph/plan.h"
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

  /// As NodeRunner::run, of all nodes at once. `inputs`, `outputs` and `seconds` are by position in Plan::nodes; items that fused
  /// nodes yield are not among the inputs. Outputs that are Plan::inner stay empty. The time that it took is divided among
  /// `seconds` as the threads spent it. When several nodes fail, the first one in the plan's order is told of.
  void run(std::int64_t frame, std::vector<PortItems>& inputs, std::vector<PortItems>& outputs, std::vector<double>& seconds);
  /// Position of the node that failed last; -1 when it was none of them.
  int failed_node() const;

 private:
  struct Tables;
  std::unique_ptr<Tables> tables_;
};

}  // namespace quell
