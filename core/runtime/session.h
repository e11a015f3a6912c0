// Runs a graph over frames. Frames come from a source and go to a sink, or are pushed and taken one by one.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quell/graph/plan.h"
#include "quell/image/stream.h"
#include "quell/runtime/executor.h"
#include "quell/runtime/sanitize.h"
#include "quell/runtime/saved_history.h"
#include "quell/runtime/trace.h"

namespace quell {

/// The size of what a frame read or handed out: an image.
struct ReportedSize {
  std::string name;
  Size size;
};

/// What became of one frame.
struct FrameReport {
  std::int64_t frame = 0;
  bool ok = true;
  bool history_only = false;             ///< see RunContext
  bool computed = true;                  ///< false when it could not be read, or a node failed; it may fail to be written, too
  std::string error;                     ///< where and why, when it failed
  std::string node;                      ///< the node that failed; empty when the frame could not be read or written
  std::vector<ReplacedValues> replaced;  ///< of each input that had such values
  double seconds = 0;                    ///< from the first input until the last output, with what it waited for
  double read_seconds = 0;               ///< sum over its inputs
  double write_seconds = 0;              ///< sum over its outputs
  std::vector<double> node_seconds;      ///< in the order of Plan::nodes; 0 for a node that did not run
  std::vector<ReportedSize> inputs;      ///< of each image that was read, also when the frame failed later
  std::vector<ReportedSize> results;     ///< of each image that was written
};

/// How run() goes through nodes and frames. The results are the same.
enum class Schedule {
  concurrent,  ///< whatever is ready: nodes of several frames at a time, reading ahead and writing behind
  serial,      ///< one node after the other, each parallel inside: the reference that the other must equal bit for bit
};

/// What happens when a frame fails.
enum class OnError {
  go_on,  ///< what the frame lacks counts as absent for those that look back at it
  stop,   ///< no frame after it is computed
  reset,  ///< where it could not be computed, all history ends with it, as at a cut
  hold,   ///< where it could not be computed, the history of the frame before stands in for all of its own
};

struct SessionOptions {
  int threads = 0;  ///< that compute, decode and encode at a time; 0: as many as this process may use
  Schedule schedule = Schedule::concurrent;
  int frames_in_flight = 0;  ///< most frames at a time, from reading to writing; 0: see choose_window()
  std::size_t memory = 0;    ///< most bytes for images and what is reserved; 0: half of what this process may have
  std::size_t reserved = 0;  ///< of `memory`, where that is given: what this process needs beside the images of the pool
  OnError on_error = OnError::go_on;
  /// Frames before which all history ends, as at a cut of the film: no edge reaches from one side to the other, whatever its
  /// delay, and an edge that would yields its initial value. In any order.
  std::vector<std::int64_t> cuts = {};
  std::vector<std::string> dumps = {};  ///< inner images ("node.port", or a graph input) handed out beside the outputs
  std::function<void(int level, const std::string& message)> log = {};  ///< levels QUELL_LOG_*; from any thread
  std::function<bool()> cancelled = {};                                 ///< asked often, from any thread
  std::function<void(const FrameReport&)> on_frame = {};  ///< after each frame of run(), in order, on the caller's thread
  Trace* trace = nullptr;                                 ///< told what ran when; may be null
  bool fuse = true;  ///< nodes that work row by row run together where that saves memory traffic; the results are the same
};

/// What Session::run() has to know beside its frames.
struct RunContext {
  /// Frames that another run will compute. Edges that look ahead see them; without, they end with the last frame.
  std::vector<std::int64_t> later = {};
  /// Of the frames of the run, in ascending order, those of which nothing but the history is wanted: they are read, but not
  /// handed out, and nodes that no history needs are left out.
  std::vector<std::int64_t> history_only = {};
};

struct SessionState;

/// Not thread-safe. History lasts as long as the session, and starts anew when the size of the images changes.
class Session {
 public:
  explicit Session(std::shared_ptr<const Graph> graph, SessionOptions options = {});
  ~Session();
  Session(Session&&) noexcept;

  /// Computes the frames, whose numbers ascend. A frame that cannot be read, computed or written is reported and harms no other:
  /// what its nodes yielded is history for those that follow, what a failed node, or one that needs it, should have yielded
  /// counts as absent, unless OnError says otherwise. Returns a report for each frame, in order; when stopped, up to the one that
  /// failed; when cancelled, for those that were finished, which may leave gaps. Not from within a oneTBB task, whose threads it
  /// waits for. Throws Error(usage) when the graph cannot run on what the source has or the numbers do not ascend, Error(memory)
  /// when not even one frame fits the limit.
  std::vector<FrameReport> run(const std::vector<std::int64_t>& frames, FrameSource& source, FrameSink& sink,
                               const RunContext& context = {});

  /// In memory: computes one frame from its inputs by name, and returns the outputs and dumps by name. Throws Error(usage) when
  /// the inputs do not fit the graph, Error(frame) when a pass fails, Cancelled when cancelled. Inputs that look ahead need
  /// run().
  std::map<std::string, Item> push(std::int64_t frame, const std::map<std::string, Item>& inputs);

  /// What another session needs in order to go on after the frames of run() that are through, those before the first one that
  /// was not finished. Nothing when none is, or none since the size of the images changed.
  std::optional<SavedHistory> save() const;
  /// Before the first frame: goes on with what another session has saved. Throws Error(usage) when that is of another graph or
  /// comes too late, and what making a plan throws.
  void restore(const SavedHistory& saved);

  /// Null until the first frame told the sizes. Not while run() is at work.
  const Plan* plan() const;
  BufferPool& pool();

 private:
  std::unique_ptr<SessionState> state_;
};

}  // namespace quell
