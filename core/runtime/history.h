// What delayed edges carry: results of earlier frames, by frame number.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "quell/graph/plan.h"

namespace quell {

/// A line for each of Plan::histories: the frames that the delays reach back to, and those in flight. Not thread-safe.
class History {
 public:
  /// `frames_in_flight`: how far frames may run ahead of the last call of advance(). `cuts`: frames, ascending, before which all
  /// history ends. `resets`: how many things end it where they choose to.
  History(const Plan& plan, int frames_in_flight, std::vector<std::int64_t> cuts = {}, std::size_t resets = 0)
      : cuts_(std::move(cuts)), resets_(resets) {
    for (const PlannedHistory& kept : plan.histories) {
      Line& line = lines_.emplace_back(Line{kept.frames, {}});
      line.items.reserve(std::min<std::size_t>(static_cast<std::size_t>(kept.frames) + static_cast<std::size_t>(frames_in_flight),
                                               kMostReserved));
      longest_ = std::max(longest_, kept.frames);
    }
  }
  /// Whether no cut lies between two frames, whichever of them is the earlier one.
  bool is_uncut(std::int64_t a, std::int64_t b) const { return !is_any_between(cuts_, a, b); }
  /// Whether something that an earlier frame yielded lasts until a later one, for who heeds these resets.
  bool lasts(std::int64_t earlier, std::int64_t later, const std::vector<int>& resets) const {
    return is_uncut(earlier, later) && std::ranges::none_of(resets, [&](int reset) {
             return is_any_between(resets_[static_cast<std::size_t>(reset)], earlier, later);
           });
  }
  /// From now on nothing lasts from frames before `frame` until that frame, or later ones. Frames may come in any order.
  void reset(int reset, std::int64_t frame) {
    Frames& frames = resets_[static_cast<std::size_t>(reset)];
    frames.insert(std::ranges::lower_bound(frames, frame), frame);
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
  /// Of a line, ascending; all that is there.
  const std::vector<std::pair<std::int64_t, Item>>& items(int line) const { return lines_[static_cast<std::size_t>(line)].items; }
  /// For each reset: the frames that it was given in, ascending.
  const std::vector<std::vector<std::int64_t>>& resets() const { return resets_; }
  /// Lets go of what frames after `frame` cannot reach.
  void advance(std::int64_t frame) {
    for (Line& line : lines_)
      line.items.erase(line.items.begin(), std::ranges::upper_bound(line.items, frame - line.reach, {}, &Kept::first));
    for (Frames& frames : resets_) frames.erase(frames.begin(), std::ranges::upper_bound(frames, frame - longest_));
  }
  /// Lets go of everything.
  void clear() {
    for (Line& line : lines_) line.items.clear();
    for (Frames& frames : resets_) frames.clear();
  }
  /// Puts what the latest frame before `frame` has left in place of what this one has.
  void hold(std::int64_t frame) {
    for (Line& line : lines_) {
      const auto own = std::ranges::lower_bound(line.items, frame, {}, &Kept::first);
      Item before = own == line.items.begin() ? Item() : std::prev(own)->second;
      const auto place = own != line.items.end() && own->first == frame ? line.items.erase(own) : own;
      if (before) line.items.insert(place, {frame, std::move(before)});
    }
  }
  /// Lets go of `frame` and all after it, which will be computed again, or were not finished.
  void forget_from(std::int64_t frame) {
    for (Line& line : lines_) line.items.erase(std::ranges::lower_bound(line.items, frame, {}, &Kept::first), line.items.end());
    for (Frames& frames : resets_) frames.erase(std::ranges::lower_bound(frames, frame), frames.end());
  }

 private:
  static constexpr std::size_t kMostReserved = 64;
  using Kept = std::pair<std::int64_t, Item>;
  using Items = std::vector<Kept>;  // ascending
  struct Line {
    int reach;
    Items items;
  };
  using Frames = std::vector<std::int64_t>;  // ascending
  // Whether one of the frames lies after the earlier one, up to the later one.
  static bool is_any_between(const Frames& frames, std::int64_t a, std::int64_t b) {
    const auto next = std::ranges::upper_bound(frames, std::min(a, b));
    return next != frames.end() && *next <= std::max(a, b);
  }

  std::vector<Line> lines_;
  int longest_ = 0;  // reach of all
  Frames cuts_;
  std::vector<Frames> resets_;  // of each: the frames that it was given in
};

}  // namespace quell
