// Computes frames of a plan, one node after the other, and keeps their history.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "quell/graph/plan.h"
#include "quell/runtime/history.h"
#include "quell/runtime/node_runner.h"

namespace quell {

/// A computed frame.
struct FrameResult {
  std::vector<std::pair<std::string, Item>> outputs;  ///< as Plan::results() names them
  std::vector<double> node_seconds;                   ///< in the order of Plan::nodes
};

class FrameRun {
 public:
  /// Yields a graph input some frames ahead; nothing where there is no such frame.
  using Ahead = std::function<Item(int input, int frames)>;

  FrameRun(Plan plan, const HostServices& services, BufferPool& pool);

  const Plan& plan() const { return plan_; }
  /// `inputs` has one item for each graph input, nothing where it is absent; an image that nobody else holds may be overwritten.
  /// Throws Error(frame) or Cancelled; the frame then counts as absent for those that follow.
  FrameResult compute(std::int64_t frame, std::vector<Item> inputs, const Ahead& ahead);

 private:
  // What stands at every endpoint in the frame at hand.
  struct Values {
    std::vector<Item> inputs;
    std::vector<PortItems> nodes;  // by index into Graph::nodes; empty for a node that did not run
    Item get(const Endpoint& endpoint) const;
    void drop(const Endpoint& endpoint);
  };

  const Node& node(std::size_t step) const { return plan_.graph->nodes[static_cast<std::size_t>(plan_.nodes[step].node)]; }
  void run_step(std::size_t step, std::int64_t frame, Values& values, const Ahead& ahead);
  Item fetch(std::size_t step, const Edge& edge, std::int64_t frame, const Values& values, const Ahead& ahead);
  Item initial(std::size_t step, const Edge& edge, const Values& values);
  /// The one size of the images that a node reads.
  Size image_size(const Node& reader) const;
  Item make_constant(const Shape& shape, const std::vector<double>& values);
  void keep_history(std::int64_t frame, const Values& values);

  Plan plan_;
  BufferPool& pool_;
  std::vector<NodeRunner> runners_;
  History history_;
  std::map<const Edge*, Item> constants_;
};

}  // namespace quell
