#include "quell/runtime/session.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "quell/runtime/scheduler.h"
#include "quell/runtime/serial_run.h"
#include "quell/runtime/single_frame.h"
#include "quell/text/diagnostic.h"

namespace quell {
namespace {

// So that a delay never leads past the ends of 64 bits.
void require_possible(const Graph& graph, std::int64_t frame) {
  constexpr std::int64_t kFarthest = std::int64_t{1} << 62;
  if (frame < -kFarthest || frame > kFarthest)
    throw Error(Fault::usage, graph.name, "frame " + std::to_string(frame) + " is too far off; numbers reach to 2^62 either way");
}

void require_ascending(const Graph& graph, const std::vector<std::int64_t>& frames) {
  for (const std::int64_t frame : frames) require_possible(graph, frame);
  const auto turn = std::ranges::adjacent_find(frames, std::greater_equal<>());
  if (turn == frames.end()) return;
  throw Error(Fault::usage, graph.name,
              "frame " + std::to_string(*(turn + 1)) + " comes after frame " + std::to_string(*turn) +
                  "; frames of a run have ascending numbers, each once");
}

InputShapes shapes_of(const Graph& graph, const std::vector<Item>& items) {
  InputShapes shapes;
  for (std::size_t i = 0; i < items.size(); ++i)
    shapes[graph.inputs[i].name] = items[i] ? std::optional(shape_of(items[i])) : std::nullopt;
  return shapes;
}

std::vector<FrameReport> run_through(SessionState& session, const RunFrames& frames, FrameSource& source, FrameSink& sink) {
  if (session.options.schedule == Schedule::serial) return run_serially(session, frames, source, sink);
  return Scheduler(session, frames, source, sink).run();
}

// Frames tell their sizes themselves. A plan for the usual size would end the history of frames that have another one.
bool are_same_there(const InputShapes& a, const InputShapes& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.first == y.first && x.second.has_value() == y.second.has_value();
  };
  return std::ranges::equal(a, b, same);
}

}  // namespace

Session::Session(std::shared_ptr<const Graph> graph, SessionOptions options)
    : state_(std::make_unique<SessionState>(std::move(graph), std::move(options))) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;

const Plan* Session::plan() const { return state_->running ? &state_->running->plan : nullptr; }
BufferPool& Session::pool() { return state_->pool; }

std::vector<FrameReport> Session::run(const std::vector<std::int64_t>& frames, FrameSource& source, FrameSink& sink,
                                      const RunContext& context) {
  SessionState& s = *state_;
  require_ascending(*s.graph, frames);
  InputShapes offered;
  for (const GraphInput& input : s.graph->inputs) offered[input.name] = source.shape(input.name);
  if (!s.running || !are_same_there(offered, s.planned_for)) s.plan_for(offered);
  if (frames.empty()) return {};
  s.running->history.forget_from(frames.front());  // left from an earlier time that these frames were computed
  std::vector<FrameReport> reports = run_through(s, {frames, context}, source, sink);
  if (s.options.on_error == OnError::go_on || s.options.on_error == OnError::stop) return reports;
  // The history of a frame that failed is put right before the next one begins.
  std::vector<std::int64_t> left = frames;
  while (!reports.empty() && !reports.back().ok && reports.back().frame != frames.back() && !s.cancelled()) {
    left.erase(left.begin(), std::ranges::upper_bound(left, reports.back().frame));
    std::vector<FrameReport> more = run_through(s, {left, context}, source, sink);
    std::ranges::move(more, std::back_inserter(reports));
  }
  return reports;
}

std::map<std::string, Item> Session::push(std::int64_t frame, const std::map<std::string, Item>& inputs) {
  SessionState& s = *state_;
  require_possible(*s.graph, frame);
  std::vector<Item> items(s.graph->inputs.size());
  std::vector<std::string> known;
  for (const GraphInput& input : s.graph->inputs) known.push_back(input.name);
  for (const auto& [name, item] : inputs) {
    const auto place = std::ranges::find(known, name);
    if (place == known.end())
      throw Error(Fault::usage, s.graph->name,
                  "the graph has no input '" + name + "'" + did_you_mean(name, known) + "; it has " + list_names(known, "and"));
    Item& clean = items[static_cast<std::size_t>(place - known.begin())] = item;
    const std::int64_t replaced = clean ? sanitize(clean, s.executor, s.pool) : 0;
    if (replaced > 0 && s.options.log)
      s.options.log(QUELL_LOG_WARNING, "frame " + std::to_string(frame) + ": " + describe({name, clean.type(), replaced}));
  }
  s.plan_for(shapes_of(*s.graph, items));
  if (!s.running->wiring.ahead.empty())
    throw Error(Fault::usage, known[static_cast<std::size_t>(s.running->wiring.ahead.front().input)],
                "the graph looks ahead on this input, which needs a whole sequence: use Session::run");
  std::map<std::string, Item> outputs;
  for (auto& [name, item] : compute_frame(s.lane(0), *s.running, frame, std::move(items))) outputs[name] = std::move(item);
  return outputs;
}

}  // namespace quell
