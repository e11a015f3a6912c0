// What delayed edges carry: results of earlier frames, by frame number.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <utility>

#include "quell/graph/plan.h"

namespace quell {

/// Keeps as many frames of each endpoint as the plan's delays reach back.
class History {
 public:
  explicit History(const Plan& plan) {
    for (const PlannedHistory& kept : plan.histories) lines_[kept.from].reach = kept.frames;
  }
  /// Nothing when that frame was not computed, failed, or is too long ago.
  Item find(const Endpoint& from, std::int64_t frame) const {
    const auto line = lines_.find(from);
    if (line == lines_.end()) return {};
    for (const auto& [number, item] : line->second.items)
      if (number == frame) return item;
    return {};
  }
  bool keeps(const Endpoint& from) const {
    const auto line = lines_.find(from);
    return line != lines_.end() && line->second.reach > 0;
  }
  void add(const Endpoint& from, std::int64_t frame, Item item) { lines_[from].items.emplace_back(frame, std::move(item)); }
  /// Lets go of what no frame after `frame` can reach.
  void advance(std::int64_t frame) {
    for (auto& [from, line] : lines_)
      std::erase_if(line.items, [&, reach = line.reach](const auto& kept) { return kept.first + reach <= frame; });
  }

 private:
  struct Line {
    int reach = 0;
    std::deque<std::pair<std::int64_t, Item>> items;
  };
  std::map<Endpoint, Line> lines_;
};

}  // namespace quell
