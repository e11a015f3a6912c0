#include "quell/runtime/session_state.h"

#include <algorithm>
#include <utility>

#include "quell/runtime/failure.h"

namespace quell {
namespace {

bool same_shape(const std::optional<Shape>& a, const std::optional<Shape>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->type == b->type && a->size == b->size && a->value_count == b->value_count);
}

}  // namespace

SessionState::SessionState(std::shared_ptr<const Graph> checked, SessionOptions given)
    : graph(std::move(checked)), options(std::move(given)), executor(options.threads) {
  std::ranges::sort(options.cuts);
  services.executor = &executor;
  services.log = options.log;
  services.cancelled = options.cancelled;
  services.trace = options.trace;
}

bool SessionState::needs_plan(const InputShapes& shapes) const {
  if (!running) return true;
  const auto same = [](const auto& x, const auto& y) { return x.first == y.first && same_shape(x.second, y.second); };
  return !std::ranges::equal(shapes, planned_for, same);
}

void SessionState::plan_for(const InputShapes& shapes) {
  if (!needs_plan(shapes)) return;
  Plan plan = make_plan(graph, shapes, options.dumps, options.fuse);
  const Window chosen =
      choose_window(plan, static_cast<int>(executor.slots()), options.frames_in_flight, options.memory, options.reserved);
  auto next = std::make_unique<PlanState>(std::move(plan), chosen.frames, pool, options.cuts);
  if (running && options.log) options.log(QUELL_LOG_INFO, "the size of the inputs changed: history starts anew");
  pool.set_limit(chosen.memory);
  lanes_.clear();  // they refer to the former plan
  running = std::move(next);
  window = chosen;
  finished.reset();
  planned_for = shapes;
  pool.trim();  // blocks of the former sizes would hardly be asked for again
}

void SessionState::finish(const FrameReport& report) {
  if (!report.computed && options.on_error == OnError::reset) running->history.clear();
  if (!report.computed && options.on_error == OnError::hold) running->history.hold(report.frame);
  running->history.advance(report.frame);
  finished = report.frame;
}

Lane& SessionState::lane(std::size_t index) {
  while (lanes_.size() <= index) lanes_.push_back(std::make_unique<Lane>(*running, services, pool, options.trace));
  return *lanes_[index];
}

void report_nodes(FrameReport& report, const Lane& lane) {
  report.node_seconds = lane.node_seconds();
  const int failed = lane.failed_node();
  if (failed < 0) return;
  report.ok = report.computed = false;
  report.node = lane.name(failed);
  report.error = lane.error();
}

void write_results(FrameReport& report, const Lane& lane, const Wiring& wiring, FrameSink& sink, const BufferPool& pool,
                   Trace* trace) {
  for (std::size_t i = 0; i < wiring.results.size() && report.ok; ++i) {
    const std::string& name = wiring.results[i].first;
    const auto start = Trace::Clock::now();
    try {
      const Item& item = lane.result(i);
      sink.write(name, report.frame, item);
      if (item && is_image(item.type())) report.results.push_back({name, shape_of(item).size});
    } catch (...) {
      report.ok = false;
      report.error = what_failed(pool);
    }
    const auto end = Trace::Clock::now();
    report.write_seconds += std::chrono::duration<double>(end - start).count();
    if (trace) trace->slice(Trace::Kind::write, name, report.frame, start, end);
  }
}

}  // namespace quell
