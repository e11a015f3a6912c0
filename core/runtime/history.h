// What delayed edges carry: results of earlier frames, by frame number.
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "quell/graph/plan.h"

namespace quell {

/// Keeps, of each endpoint, the frames that the plan's delays reach back to. A frame that is computed again replaces its former
/// self; going back to an earlier one forgets those after it.
class History {
 public:
  explicit History(const Plan& plan) {
    for (const PlannedHistory& kept : plan.histories) lines_[kept.from].reach = kept.frames;
  }
  /// Nothing when that frame was not computed, failed, or is too long ago.
  Item find(const Endpoint& from, std::int64_t frame) const {
    const auto line = lines_.find(from);
    if (line == lines_.end()) return {};
    const auto item = line->second.items.find(frame);
    return item == line->second.items.end() ? Item() : item->second;
  }
  void add(const Endpoint& from, std::int64_t frame, Item item) { lines_[from].items.insert_or_assign(frame, std::move(item)); }
  /// Lets go of what the frame after `frame` cannot reach.
  void advance(std::int64_t frame) {
    for (auto& [from, line] : lines_)
      std::erase_if(line.items,
                    [&, reach = line.reach](const auto& kept) { return kept.first + reach <= frame || kept.first > frame; });
  }

 private:
  struct Line {
    int reach = 0;
    std::map<std::int64_t, Item> items;  // by frame
  };
  std::map<Endpoint, Line> lines_;
};

}  // namespace quell
