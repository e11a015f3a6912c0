// Runs a graph over a sequence again and again while somebody changes the graph, and computes only what a change can affect.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "quell/runtime/session.h"

namespace quell {

/// What one run did. Nodes are those of the plan of the whole graph.
struct RerunReport {
  std::vector<FrameReport> frames;   ///< as Session::run returns them
  std::vector<std::string> nodes;    ///< that the results need, in the plan's order
  std::vector<int> computed;         ///< of each node: in how many frames it ran; 0 where the change cannot affect it
  std::vector<std::string> results;  ///< what was handed out: the results that the change can affect
  std::vector<std::string> no_room;  ///< nodes whose values memory has no room for, so that they are computed when needed
  std::string all_anew;              ///< why nothing of the run before could be used; "" when it could, or there was none
  std::size_t remembered_bytes = 0;  ///< held for the next run
  std::size_t peak_bytes = 0;        ///< of all images, those remembered included
};

struct RerunState;

/// After a run, the values of nodes stay in memory for all frames, and so do inputs that take time to read. The next run compares
/// its graph with the one before, node by node (by name): pass, parameters, sources, delays, initial values and resets. What
/// differs, and all that depends on it, also through delayed edges, is computed; it reads the rest from memory. Handed out are
/// the results that this may change; they are, bit for bit, those of a run of the whole graph.
///
/// At most half of the memory limit is for what is remembered: nodes nearest to the outputs first, then inputs; the runs have
/// what is left. Where one frame needs more than that, nothing is remembered. Values are not remembered, but computed again, of a
/// node that failed in some frame, or yields NaN, infinity or lists of varying length, and of all nodes when an input cannot be
/// read in some frame or changes its size. Files that passes read count as changed when their time or size does.
///
/// Not thread-safe.
class Rerun {
 public:
  /// `together`: the sink wants all results of a frame, or none, because it puts them into one file. Then all are handed out when
  /// one of them may have changed.
  explicit Rerun(bool together = false);
  ~Rerun();
  Rerun(const Rerun&) = delete;
  Rerun& operator=(const Rerun&) = delete;

  /// As Session::run, but for what need not be computed. What a source serves under a name must not change from run to run, until
  /// forget() is called; other frames, or another shape of an input, are noticed. Throws what Session::run throws; a graph that
  /// cannot be planned leaves what is remembered as it is. `dumps` are results like the graph's outputs. `labels` says of
  /// results, by name, what the sink writes beside their values: one with another label than in the run before is handed out
  /// again.
  RerunReport run(std::shared_ptr<const Graph> graph, const std::vector<std::int64_t>& frames, FrameSource& source,
                  FrameSink& sink, const SessionOptions& options = {}, std::map<std::string, std::string> labels = {});
  /// Everything counts as changed.
  void forget();
  /// From now on this is called, on the caller's thread, when a run begins anew: what it had from the run before turned out not
  /// to hold, so that the frames which it told and handed out until then are told and handed out again.
  void on_restart(std::function<void()> told);
  /// Of all images, those remembered included. From on_frame, too.
  BufferPool::Usage usage() const;

 private:
  std::unique_ptr<RerunState> state_;
};

}  // namespace quell
