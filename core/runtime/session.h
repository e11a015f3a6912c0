// Runs a plan over frames. Frames come from a source and go to a sink, or are pushed and taken one by one.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "quell/graph/plan.h"
#include "quell/image/stream.h"
#include "quell/runtime/executor.h"

namespace quell {

/// What became of one frame.
struct FrameReport {
  std::int64_t frame = 0;
  bool ok = true;
  std::string error;    ///< node and reason, when it failed
  std::string warning;  ///< what a person should know although the frame is fine
  double seconds = 0;
  std::vector<double> node_seconds;  ///< in the order of Plan::nodes
};

struct SessionOptions {
  int threads = 0;                                                      ///< 0: as many as this process may use
  std::function<void(int level, const std::string& message)> log = {};  ///< levels QUELL_LOG_*
  std::function<bool()> cancelled = {};                                 ///< asked often, from any thread
  std::function<void(const FrameReport&)> on_frame = {};                ///< after each frame, in order
};

/// Not thread-safe. History lasts as long as the session.
class Session {
 public:
  explicit Session(Plan plan, SessionOptions options = {});
  ~Session();

  /// Computes the frames in order; a frame that fails is reported, and counts as absent for those that follow. Returns the
  /// reports; fewer than frames when cancelled.
  std::vector<FrameReport> run(const std::vector<std::int64_t>& frames, FrameSource& source, FrameSink& sink);

  /// In memory: the inputs of one frame by name, and its outputs. Throws Error(frame) when it fails. Inputs that look ahead
  /// are not available here (Error(usage)).
  std::map<std::string, Item> push(std::int64_t frame, const std::map<std::string, Item>& inputs);

  const Plan& plan() const;
  BufferPool& pool();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace quell
