// Reads what frames need from a source: what the plan uses, cleaned of NaN and infinity, each image once, although a frame may
// look ahead at the inputs of later ones.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "quell/image/stream.h"
#include "quell/runtime/lane.h"
#include "quell/runtime/session.h"

namespace quell {

/// The frames of a run.
struct RunFrames {
  const std::vector<std::int64_t>& computed;
  const RunContext& context;

  /// Of which nothing but the history is wanted.
  bool is_history_only(std::int64_t frame) const { return std::ranges::binary_search(context.history_only, frame); }
};

/// Keeps account of what is wanted, being read, and there. Only read() takes long, and needs no lock; all else wants one.
class InputReader {
 public:
  /// One input in one frame.
  struct Key {
    std::int64_t frame = 0;
    std::size_t input = 0;
    auto operator<=>(const Key&) const = default;
  };
  struct Read {
    Item item;
    std::int64_t replaced = 0;  ///< values that were NaN or infinite
    std::string error;          ///< why there is no item
    double seconds = 0;
  };
  InputReader(const Graph& graph, FrameSource& source, const RunFrames& frames, BufferPool& pool, Trace* trace)
      : graph_(graph), source_(source), frames_(frames.computed.begin(), frames.computed.end()), pool_(pool), trace_(trace) {
    frames_.insert(frames.context.later.begin(), frames.context.later.end());
  }

  /// From now on next() names what the frame needs and nobody has asked for yet.
  void want(std::int64_t frame, const PlanState& state);
  bool has_next() const { return !queue_.empty(); }
  /// What to read next: the earliest frame first.
  std::optional<Key> next();
  /// Reads it; never throws. `executor` cleans large images in parallel.
  Read read(const Key& key, Executor& executor) const;
  void put(const Key& key, Read read) {
    if (const auto wanted = known_.find(key); wanted != known_.end()) wanted->second = std::move(read);
  }
  /// Lets go of `frame` and all after it, until they are wanted again.
  void forget_from(std::int64_t frame) {
    queue_.erase(queue_.lower_bound({frame, 0}), queue_.end());
    known_.erase(known_.lower_bound({frame, 0}), known_.end());
  }
  /// Whether all that the frame wants has been put.
  bool is_ready(std::int64_t frame, const PlanState& state) const;
  /// Why a frame that is ready cannot be computed: the error of its first input that could not be read; "" when there is none.
  std::string error(std::int64_t frame) const;
  /// `planned`, with the shapes of what the frame has in their place.
  InputShapes shapes(std::int64_t frame, InputShapes planned) const;
  /// Hands over a frame that is ready, and tells its report what was read. Frames are taken in order: what is kept of this one
  /// and earlier ones is let go.
  FrameInputs take(FrameReport& report, const PlanState& state);

 private:
  const Read* find(std::int64_t frame, std::size_t input) const;
  std::vector<Key> keys(std::int64_t frame, const PlanState& state) const;

  const Graph& graph_;
  FrameSource& source_;
  std::set<std::int64_t> frames_;  // that there are
  BufferPool& pool_;
  Trace* trace_;
  std::set<Key> queue_;                       // wanted, and not yet being read
  std::map<Key, std::optional<Read>> known_;  // wanted; nothing until it has been read
};

}  // namespace quell
