// One of the runs that follow each other: what is to be computed, and what is to be remembered of it. Private to this box.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "quell/runtime/file_stamps.h"
#include "quell/runtime/graph_part.h"
#include "quell/runtime/remembered.h"
#include "quell/runtime/rerun.h"

namespace quell {

/// What lasts from run to run.
struct RerunState {
  bool together = false;
  SessionOptions options;
  std::function<void()> on_restart;           // may be null
  std::map<std::string, std::string> labels;  // of results
  Remembered memory;
  // Of the run before; no graph: there was none, or it is forgotten.
  std::shared_ptr<const Graph> graph;
  std::vector<std::int64_t> frames, cuts;
  InputShapes shapes;
  std::map<std::string, FileStamps> stamps;             // of the files that each node's parameters name
  std::set<std::string> steady;                         // inputs known to be there in every frame, in one shape
  std::map<std::string, std::string> complete;          // results that were handed out for every frame, and their meaning
  std::string why_forgotten;                            // "" when there was no run before
  std::function<BufferPool::Usage()> usage_of_running;  // null while nothing runs
  std::size_t peak = 0;

  void forget();
  BufferPool::Usage usage() const;
};

/// The names of the inputs that a plan reads.
std::set<std::string> used_inputs(const Plan& plan);

class RerunTurn {
 public:
  /// Plans the whole graph: throws what that throws, and changes nothing.
  RerunTurn(RerunState& state, std::shared_ptr<const Graph> graph, const std::vector<std::int64_t>& frames, FrameSource& source,
            FrameSink& sink);
  /// Once.
  RerunReport run();

 private:
  int threads() const { return s_.options.threads > 0 ? s_.options.threads : available_threads(); }
  bool is_known(const Endpoint& endpoint) const {
    return unchanged_[static_cast<std::size_t>(endpoint.node)] && s_.memory.has_all(graph_->describe(endpoint), frames_);
  }
  void start_anew(const std::string& why);
  void compare();
  std::string meaning(const PlannedResult& result) const;
  bool is_complete(const PlannedResult& result) const;
  void split();
  InputShapes offered() const;
  void choose();
  bool fits() const;
  std::shared_ptr<const Graph> with_memory() const;

  std::optional<std::vector<FrameReport>> compute();
  void prepare_memory();
  std::vector<FrameReport> run_session(RememberingSource& source, RememberingSink& sink, bool is_part);
  FrameReport translate(FrameReport report) const;
  void finish(const std::vector<FrameReport>& reports);

  RerunState& s_;
  const std::shared_ptr<const Graph> graph_;
  const std::vector<std::int64_t>& frames_;
  FrameSource& source_;
  FrameSink& sink_;
  const InputShapes shapes_;
  const Plan plan_;  // of the whole graph
  std::map<std::string, FileStamps> stamps_;
  std::size_t limit_ = 0;
  bool remembers_ = true;
  bool is_steady_ = true;

  std::set<int> runs_;                      // nodes that are computed
  std::vector<int> steps_;                  // the same, in the order of the session's reports
  std::vector<bool> unchanged_;             // each node: yields what it did in the run before
  std::vector<PlannedResult> changed_;      // what is handed out
  GraphPart part_;                          // what is computed
  std::map<std::string, Endpoint> chosen_;  // what is remembered
  std::size_t chosen_bytes_ = 0;
  RerunReport report_;
};

}  // namespace quell
