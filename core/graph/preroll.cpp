#include "quell/graph/preroll.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "quell/graph/plan_presence.h"

namespace quell {
namespace {

constexpr int kMostFrames = 1'000'000;
constexpr int kNowhere = -1;  // a graph input

std::size_t at(int index) { return static_cast<std::size_t>(index); }

struct Arc {
  int from = kNowhere;  // position in Plan::nodes
  int to = 0;
  std::int64_t delay = 0;
};

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.2g", value);
  return text;
}

std::string frames_text(std::int64_t frames) { return std::to_string(frames) + " frame" + (frames == 1 ? "" : "s"); }

// What decides so far.
struct Depth {
  std::int64_t frames = 0;
  std::string reason;
};

class Finder {
 public:
  Finder(const Plan& plan, double tolerance) : plan_(plan), tolerance_(tolerance) {
    const planning::Presence presence(*plan.graph, plan.inputs);
    std::vector<int> positions(plan.graph->nodes.size(), kNowhere);
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) positions[at(plan.nodes[i].node)] = static_cast<int>(i);
    for (std::size_t i = 0; i < plan.nodes.size(); ++i)
      for (const planning::Read& read : planning::reads(plan.graph->nodes[at(plan.nodes[i].node)], presence))
        arcs_.push_back({read.from.node < 0 ? kNowhere : positions[at(read.from.node)], static_cast<int>(i),
                         std::max<std::int64_t>(read.delay, 0)});
    part_of_.assign(plan.nodes.size(), 0);
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) part_of_[i] = static_cast<int>(plan.loops.size() + i);
    for (std::size_t loop = 0; loop < plan.loops.size(); ++loop)
      for (const int node : plan.loops[loop].nodes) part_of_[at(positions[at(node)])] = static_cast<int>(loop);
    results_.assign(plan.nodes.size(), false);
    for (const PlannedResult& result : plan.results())
      if (result.from.node >= 0) results_[at(positions[at(result.from.node)])] = true;
  }

  Preroll find() const {
    std::vector<Depth> own(plan_.loops.size() + plan_.nodes.size());  // of each part: a loop, or a node that is in none
    for (std::size_t loop = 0; loop < plan_.loops.size(); ++loop) {
      const std::string endless = find_memory(static_cast<int>(loop), own[loop]);
      if (!endless.empty()) return {std::nullopt, endless};
    }
    std::vector<Depth> depths = own;
    // Parts depend on each other in no circle, so that as many rounds as there are parts settle all; mostly one or two do.
    for (bool changed = true; changed;) {
      changed = false;
      for (const Arc& arc : arcs_) {
        const auto to = at(part_of_[at(arc.to)]);
        if (arc.from != kNowhere && at(part_of_[at(arc.from)]) == to) continue;
        const Depth before = arc.from == kNowhere ? Depth() : depths[at(part_of_[at(arc.from)])];
        const std::int64_t frames = std::min<std::int64_t>(before.frames + arc.delay + own[to].frames, kMostFrames + 1);
        if (frames <= depths[to].frames) continue;
        changed = true;
        depths[to] = {frames, join(before.reason, join(looks_back(arc), own[to].reason))};
      }
    }
    Depth deepest;
    for (std::size_t node = 0; node < results_.size(); ++node)
      if (const Depth& depth = depths[at(part_of_[node])]; results_[node] && depth.frames > deepest.frames) deepest = depth;
    if (deepest.frames > kMostFrames)
      return {std::nullopt, "more than " + std::to_string(kMostFrames) + " frames: " + deepest.reason};
    return {static_cast<int>(deepest.frames), deepest.frames == 0 ? "every frame is computed by itself" : deepest.reason};
  }

 private:
  const std::string& name(int position) const { return plan_.graph->nodes[at(plan_.nodes[at(position)].node)].name; }
  static std::string join(const std::string& a, const std::string& b) { return a.empty() || b.empty() ? a + b : a + "; " + b; }
  std::string looks_back(const Arc& arc) const {
    return arc.delay == 0 ? "" : "'" + name(arc.to) + "' looks " + frames_text(arc.delay) + " back";
  }
  bool fades(int position) const { return plan_.nodes[at(position)].kept < 1; }

  // Frames until one node has forgotten what comes back to it once a frame; and why so many.
  Depth find_memory(int position) const {
    const PlannedNode& node = plan_.nodes[at(position)];
    Depth depth{1, "'" + name(position) + "' keeps nothing of its history"};
    if (node.kept > 0) {
      // Shares are products of doubles: a hair more than the tolerance still is the tolerance.
      const double frames = tolerance_ > 0 ? std::ceil(std::log(tolerance_) / std::log(node.kept) - 1e-9) : kMostFrames + 1.0;
      depth.frames = static_cast<std::int64_t>(std::clamp(frames, 1.0, kMostFrames + 1.0));
      depth.reason = "'" + name(position) + "' keeps " + digits(node.kept) + " of its history, of which " +
                     frames_text(depth.frames) + " leave " + digits(std::pow(node.kept, static_cast<double>(depth.frames)));
    }
    if (node.settles > depth.frames) depth = {node.settles, "'" + name(position) + "' counts up to " + frames_text(node.settles)};
    return depth;
  }

  // "" or why there is none.
  std::string find_memory(int loop, Depth& depth) const {
    std::vector<Arc> inner;
    for (const Arc& arc : arcs_)
      if (arc.from != kNowhere && part_of_[at(arc.from)] == loop && part_of_[at(arc.to)] == loop) inner.push_back(arc);
    // From each node on: the longest way in frames to one that forgets. Ways that never meet one would grow for ever.
    std::vector<std::int64_t> ways(plan_.nodes.size(), 0);
    const std::size_t most_rounds = plan_.loops[at(loop)].nodes.size() + 1;
    int growing = kNowhere;
    for (std::size_t round = 0; round <= most_rounds; ++round) {
      growing = kNowhere;
      for (const Arc& arc : inner) {
        const std::int64_t way = arc.delay + (fades(arc.to) ? 0 : ways[at(arc.to)]);
        if (way > ways[at(arc.from)]) ways[at(arc.from)] = way, growing = arc.from;
      }
      if (growing == kNowhere) break;
    }
    if (growing != kNowhere)
      return "results of '" + name(growing) + "' come back to it for ever, and no pass on their way says how fast they fade";
    std::int64_t longest = 1;
    for (std::size_t node = 0; node < ways.size(); ++node)
      if (part_of_[node] == loop && fades(static_cast<int>(node))) longest = std::max(longest, ways[node]);
    for (std::size_t node = 0; node < ways.size(); ++node) {
      if (part_of_[node] != loop || !fades(static_cast<int>(node))) continue;
      Depth own = find_memory(static_cast<int>(node));
      if (longest > 1) own.reason += ", " + std::to_string(longest) + " frames a turn";
      own.frames = std::min<std::int64_t>(own.frames * longest, kMostFrames + 1);
      if (own.frames > kMostFrames) return "'" + name(static_cast<int>(node)) + "' keeps its history for ever";
      if (own.frames > depth.frames) depth = own;
    }
    return {};
  }

  const Plan& plan_;
  double tolerance_;
  std::vector<Arc> arcs_;
  std::vector<int> part_of_;  // of each node: the loop that it is in, or a number of its own
  std::vector<bool> results_;
};

}  // namespace

Preroll find_preroll(const Plan& plan, double tolerance) { return Finder(plan, tolerance).find(); }

}  // namespace quell
