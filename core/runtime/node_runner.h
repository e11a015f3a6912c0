// Runs one node on one frame: hands its items to the pass as the C interface wants them, and gives it its memory.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quell/image/item.h"
#include "quell/plugin/pass_instance.h"
#include "quell/runtime/host.h"
#include "quell/runtime/raw_port.h"

namespace quell {

/// What a node needs besides its inputs; the plan computes it with the pass's infer.
struct NodeLayout {
  std::vector<std::vector<Shape>> outputs;  ///< of each item of each output
  std::vector<int> in_place_of;             ///< for each output: an input, item by item, or -1
  std::size_t scratch_bytes = 0;
  std::size_t slot_scratch_bytes = 0;
};

/// Keeps its tables from frame to frame, so that after the first frames nothing is allocated. One frame at a time; several
/// runners may share a pass.
class NodeRunner {
 public:
  /// `name` stands in messages and in the trace.
  NodeRunner(std::string name, const PassInstance& pass, NodeLayout layout, const HostServices& services, BufferPool& pool);
  ~NodeRunner();
  NodeRunner(NodeRunner&&) noexcept;

  /// Computes `outputs` from `inputs`, whose items are let go in any case; both keep their tables, and `outputs` is given its own
  /// when it has none. An input that nobody else holds may be overwritten by an output planned in place. Throws Error(frame) with
  /// the pass's words when it fails, Cancelled when the pass learned that the run was cancelled, whatever it made of that, and
  /// what the pool throws when memory runs out; the outputs are then empty.
  void run(std::int64_t frame, PortItems& inputs, PortItems& outputs);

 private:
  struct Tables;
  std::unique_ptr<Tables> tables_;
};

}  // namespace quell
