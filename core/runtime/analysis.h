// What bounds the throughput of a graph: however a run is scheduled, it yields no frames faster.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "quell/graph/slowest_cycles.h"
#include "quell/runtime/session.h"

namespace quell {

/// Seconds that the parts of one frame take, each alone.
struct FrameTimes {
  std::size_t frames = 0;              ///< of so many frames the medians
  int threads = 1;                     ///< how many "all threads" are
  std::vector<double> on_one_thread;   ///< of each node, in the order of Plan::nodes
  std::vector<double> on_all_threads;  ///< the same
  double reading = 0;                  ///< of all inputs, one after the other
  double writing = 0;                  ///< of all outputs, one after the other
  bool source_uses_processor = false;  ///< see FrameSource
  bool sink_uses_processor = false;    ///< see FrameSink
};

/// The terms are seconds per frame, and a run can be no faster than the largest of them.
struct Analysis {
  enum class Limit { loop, io, work };

  std::vector<Cycle> cycles;     ///< of each of Plan::loops the slowest
  const Cycle* slowest() const;  ///< of all; null when there is none

  /// Of the slowest cycle, with its nodes as fast as they are alone, be it on one thread or on all.
  double loop = 0;
  /// What keeps a thread busy (nodes on one thread each, and reading and writing where they use the processor), shared evenly by
  /// all threads.
  double work = 0;
  /// Reading and writing, if a run did nothing else: by all threads where they use the processor, so that this is a part of the
  /// work; else by one more at a time, as many as a session calls a source or sink from.
  double io = 0;

  Limit limit = Limit::work;  ///< the largest term, the first of equal ones
  double seconds_per_frame() const;
};

Analysis analyze(const Plan& plan, const FrameTimes& times);

/// Runs the graph over the frames node after node, on one thread and then on all, and takes medians. The first frame, which has
/// no history and finds nothing warm, does not count where there are more than two. Of the options those of the schedule have no
/// meaning; on_frame is called for both runs. Reading is measured in the first run, which may find files that are not in memory
/// yet. Throws Error(frame) with the reason when a frame fails, Cancelled, and what Session::run throws.
FrameTimes measure(const std::shared_ptr<const Graph>& graph, const std::vector<std::int64_t>& frames, FrameSource& source,
                   FrameSink& sink, SessionOptions options = {});

}  // namespace quell
