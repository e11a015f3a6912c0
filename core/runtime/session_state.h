// What a session keeps from frame to frame. Private to this box.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "quell/runtime/lane.h"
#include "quell/runtime/session.h"
#include "quell/runtime/window.h"

namespace quell {

struct SessionState {
  std::shared_ptr<const Graph> graph;
  SessionOptions options;
  BufferPool pool;
  Executor executor;
  HostServices services;
  InputShapes planned_for;
  Window window;
  std::optional<std::int64_t> finished;  ///< up to this frame, all of run() that `running` had to do are through
  std::unique_ptr<PlanState> running;    ///< null until the first frame told the sizes

  SessionState(std::shared_ptr<const Graph> checked, SessionOptions given);

  bool cancelled() const { return options.cancelled && options.cancelled(); }
  /// Whether inputs of these shapes need another plan.
  bool needs_plan(const InputShapes& shapes) const;
  /// Of a frame that is through, as all before it are: does to the history what OnError says, and lets go of what later frames
  /// cannot reach.
  void finish(const FrameReport& report);
  /// Whether no frame after one that failed may be begun before its history is put right.
  bool ends_with_failure() const { return options.on_error != OnError::go_on; }
  /// Makes another plan when needed, before which nothing may be left running. A new size or a missing input is a new plan, and
  /// nothing older can be compared with it: history starts anew. Throws what make_plan and choose_window throw; the former plan
  /// then stays.
  void plan_for(const InputShapes& shapes);
  /// For the frame number `index` of those in flight.
  Lane& lane(std::size_t index);

 private:
  std::vector<std::unique_ptr<Lane>> lanes_;
};

/// What a frame that has come to its end tells of its nodes.
void report_nodes(FrameReport& report, const Lane& lane);

/// Hands the results of a computed frame to the sink. An exception becomes the report's error.
void write_results(FrameReport& report, const Lane& lane, const Wiring& wiring, FrameSink& sink, const BufferPool& pool,
                   Trace* trace);

}  // namespace quell
