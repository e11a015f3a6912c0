// How a graph runs on images of known sizes: which nodes, in what order, with what memory, and what survives a frame.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quell/graph/graph.h"
#include "quell/image/item.h"

namespace quell {

/// A node as it runs. Indices into the arrays are those of the pass's ports.
struct PlannedNode {
  int node = 0;                             ///< index into Graph::nodes
  std::vector<std::vector<Shape>> outputs;  ///< shape of each item of each output
  std::vector<int> radius;                  ///< for each input; QUELL_RADIUS_UNBOUNDED
  std::vector<int> in_place_of;             ///< for each output: the input whose buffer it takes over (item by item); -1: its own
  std::size_t scratch_bytes = 0;
  std::size_t slot_scratch_bytes = 0;
  bool by_rows = false;             ///< it may be run on some rows at a time
  double kept = 1;                  ///< share of its history that a frame leaves, at most
  int settles = 0;                  ///< frames until what it counts is the same, whatever it was
  std::vector<Endpoint> last_uses;  ///< same-frame values that nobody needs after this node; of fused nodes the last one has all
};

/// A value of which each thread keeps some rows while a fused turn runs.
struct PlannedWindow {
  Endpoint of;
  int rows = 0;        ///< at most, that are there at a time
  bool whole = false;  ///< somebody else needs it whole, so that its rows are copied, too
};

/// What runs at once: a node, or several that are fused. These compute some rows each, in turns, so that what passes between them
/// is still in the cache when it is read, and need not be written to memory where nobody else reads it.
struct PlannedTurn {
  std::vector<int> nodes;  ///< positions in Plan::nodes, ascending
  // Of fused nodes:
  std::vector<int> ahead;              ///< of each: rows that it is ahead of the last nodes, which read around a pixel
  std::vector<PlannedWindow> windows;  ///< ascending; what is missing here is computed in place, each row once
  int rows = 0;                        ///< that a node computes before the next one has its turn
  int band = 0;                        ///< that a thread computes by itself, from the top; what lies around it is computed twice
  std::size_t window_bytes = 0;        ///< of all windows of a thread

  bool is_fused() const { return rows > 0; }
};

/// What earlier (or later) frames of an endpoint are kept.
struct PlannedHistory {
  Endpoint from;
  int frames = 0;        ///< how many frames back are needed (largest delay); 0 when only ahead
  int frames_ahead = 0;  ///< how many frames ahead are needed
  std::size_t bytes_per_frame = 0;
};

/// Nodes that depend on their own earlier results. Frames cannot overlap inside a loop.
struct PlannedLoop {
  std::vector<int> nodes;  ///< indices into Graph::nodes, in order
  int delay = 0;           ///< smallest sum of delays around a cycle through the loop
};

/// Something that is handed to the sink, and the name under which it is.
struct PlannedResult {
  std::string name;  ///< of the graph output; of a dump "node.port", or "input.color" for the graph input `color`
  Endpoint from;
};

struct Plan {
  std::shared_ptr<const Graph> graph;
  std::vector<Shape> inputs;       ///< of each graph input; present is false for an optional one that the source lacks
  std::vector<bool> input_used;    ///< whether anything that runs reads it, in any frame
  std::vector<PlannedNode> nodes;  ///< each after those that it reads; what feeds nothing, or lacks its input, is left out
  std::vector<PlannedTurn> turns;  ///< in order of execution; each of `nodes` once
  std::vector<int> pruned;         ///< indices into Graph::nodes of what was left out
  std::vector<int> outputs;        ///< indices into Graph::outputs of those that are computed
  std::vector<Endpoint> dumps;     ///< inner endpoints that are handed to the sink, too
  std::vector<PlannedHistory> histories;
  std::vector<PlannedLoop> loops;
  std::vector<Endpoint> inner;  ///< ascending: values that are never whole, but pass between fused nodes row by row
  /// Largest sum of buffers alive at a time in one frame: inputs and scratch memory included; history, and the scratch memory of
  /// single threads, not. All sums stop at SIZE_MAX.
  std::size_t frame_bytes = 0;
  std::vector<std::size_t> alive_bytes;  ///< the same sum while each of `nodes` runs, and those that it is fused with
  std::size_t history_bytes = 0;
  std::size_t unshared_bytes = 0;  ///< what a frame would need if no buffer were reused

  /// Bytes of the pool that an endpoint's item takes.
  std::size_t bytes(const Endpoint& endpoint) const;
  bool is_inner(const Endpoint& endpoint) const;
  /// Shape of what an endpoint carries; present is false when it is never there.
  Shape shape(const Endpoint& endpoint) const;
  /// The outputs, then the dumps.
  std::vector<PlannedResult> results() const;
};

using InputShapes = std::map<std::string, std::optional<Shape>, std::less<>>;

/// Plans a graph for the inputs that a source has; `dumps` are names for Graph::find. What lacks an absent input is left out
/// where its consumers can do without. Throws Error(usage) when a required input is absent, an output or dump cannot be computed,
/// sizes do not agree, or a pass refuses its inputs, and Error(plugin) when a pass's answer cannot be; every mistake at once, at
/// its place in the file. Without `fuse` each node has a turn of its own; the results are the same.
Plan make_plan(std::shared_ptr<const Graph> graph, const InputShapes& inputs, const std::vector<std::string>& dumps = {},
               bool fuse = true);

/// The plan for people: nodes in order, what each reads and writes, memory, loops.
std::string describe(const Plan& plan);

}  // namespace quell
