// What delayed edges carry: results of earlier frames, by frame number.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "quell/graph/plan.h"

namespace quell {

/// A line for each of Plan::histories: the frames that the delays reach back to, and those in flight. Not thread-safe.
class History {
 public:
  /// `frames_in_flight`: how far frames may run ahead of the last call of advance().
  History(const Plan& plan, int frames_in_flight) {
    for (const PlannedHistory& kept : plan.histories) {
      Line& line = lines_.emplace_back(Line{kept.frames, {}});
      line.items.reserve(std::min<std::size_t>(static_cast<std::size_t>(kept.frames) + static_cast<std::size_t>(frames_in_flight),
                                               kMostReserved));
    }
  }
  /// Nothing when that frame is not part of the run, failed, or is too long ago.
  Item find(int line, std::int64_t frame) const {
    const Items& items = lines_[static_cast<std::size_t>(line)].items;
    const auto place = std::ranges::lower_bound(items, frame, {}, &Kept::first);
    return place != items.end() && place->first == frame ? place->second : Item();
  }
  /// Frames may come in any order, each once.
  void add(int line, std::int64_t frame, Item item) {
    Items& items = lines_[static_cast<std::size_t>(line)].items;
    items.insert(std::ranges::lower_bound(items, frame, {}, &Kept::first), {frame, std::move(item)});
  }
  /// Lets go of what frames after `frame` cannot reach.
  void advance(std::int64_t frame) {
    for (Line& line : lines_)
      line.items.erase(line.items.begin(), std::ranges::upper_bound(line.items, frame - line.reach, {}, &Kept::first));
  }
  /// Lets go of `frame` and all after it, which will be computed again, or were not finished.
  void forget_from(std::int64_t frame) {
    for (Line& line : lines_) line.items.erase(std::ranges::lower_bound(line.items, frame, {}, &Kept::first), line.items.end());
  }

 private:
  static constexpr std::size_t kMostReserved = 64;
  using Kept = std::pair<std::int64_t, Item>;
  using Items = std::vector<Kept>;  // ascending
  struct Line {
    int reach;
    Items items;
  };
  std::vector<Line> lines_;
};

}  // namespace quell
