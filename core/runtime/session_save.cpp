// History out of a session, and into one.
#include <algorithm>

#include "quell/runtime/session.h"
#include "quell/runtime/session_state.h"
#include "quell/text/error.h"

namespace quell {
namespace {

[[noreturn]] void refuse(const Graph& graph, const std::string& what) {
  throw Error(Fault::usage, graph.name, "the saved history is not of this graph: " + what);
}

std::size_t find_line(const Plan& plan, const std::string& from) {
  for (std::size_t line = 0; line < plan.histories.size(); ++line)
    if (plan.graph->describe(plan.histories[line].from) == from) return line;
  refuse(*plan.graph, "'" + from + "' is not kept from frame to frame");
}

void require_fitting(const Plan& plan, std::size_t line, const SavedHistory::Kept& kept) {
  const Shape planned = plan.shape(plan.histories[line].from);
  if (!kept.item) return refuse(*plan.graph, "'" + kept.from + "' has nothing in frame " + std::to_string(kept.frame));
  const Shape shape = shape_of(kept.item);
  if (shape.type != planned.type || shape.size != planned.size)
    refuse(*plan.graph, "'" + kept.from + "' has another type or size in frame " + std::to_string(kept.frame));
}

}  // namespace

std::optional<SavedHistory> Session::save() const {
  const SessionState& s = *state_;
  if (!s.running || !s.finished) return std::nullopt;
  SavedHistory saved{*s.finished, s.planned_for, {}, s.running->history.resets()};
  const std::vector<PlannedHistory>& lines = s.running->plan.histories;
  for (std::size_t line = 0; line < lines.size(); ++line)
    for (const auto& [frame, item] : s.running->history.items(static_cast<int>(line)))
      saved.items.push_back({s.graph->describe(lines[line].from), frame, item});
  return saved;
}

void Session::restore(const SavedHistory& saved) {
  SessionState& s = *state_;
  if (s.running) throw Error(Fault::usage, s.graph->name, "history is restored before the first frame, or not at all");
  s.plan_for(saved.shapes);
  History& history = s.running->history;
  if (saved.resets.size() != history.resets().size()) refuse(*s.graph, "it has other resets");
  for (const SavedHistory::Kept& kept : saved.items) {
    const std::size_t line = find_line(s.running->plan, kept.from);
    require_fitting(s.running->plan, line, kept);
    if (kept.frame > saved.frame || history.find(static_cast<int>(line), kept.frame))
      refuse(*s.graph, "frame " + std::to_string(kept.frame) + " of '" + kept.from + "' is there twice, or lies ahead");
    history.add(static_cast<int>(line), kept.frame, kept.item);
  }
  for (std::size_t reset = 0; reset < saved.resets.size(); ++reset)
    for (const std::int64_t frame : saved.resets[reset]) history.reset(static_cast<int>(reset), frame);
  s.finished = saved.frame;
}

}  // namespace quell
