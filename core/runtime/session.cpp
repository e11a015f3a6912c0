#include "quell/runtime/session.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <utility>

#include "quell/runtime/frame_run.h"
#include "quell/runtime/input_reader.h"
#include "quell/text/diagnostic.h"

namespace quell {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

InputShapes shapes_of(const std::map<std::string, Item>& inputs) {
  InputShapes shapes;
  for (const auto& [name, item] : inputs)
    if (item) shapes[name] = shape_of(item);
  return shapes;
}

}  // namespace

struct Session::State {
  std::shared_ptr<const Graph> graph;
  SessionOptions options;
  BufferPool pool;
  std::unique_ptr<Executor> executor;
  HostServices services;
  InputShapes planned_for;
  std::unique_ptr<FrameRun> frame_run;

  State(std::shared_ptr<const Graph> checked, SessionOptions given)
      : graph(std::move(checked)), options(std::move(given)), executor(make_executor(options.threads)) {
    services = {executor.get(), options.log, options.cancelled};
  }

  bool cancelled() const { return options.cancelled && options.cancelled(); }

  // A new size or a missing input is a new plan, and nothing older can be compared with it.
  void plan_for(const InputShapes& shapes) {
    if (frame_run && same_shapes(shapes, planned_for)) return;
    Plan plan = make_plan(graph, shapes, options.dumps);
    if (frame_run && options.log) options.log(QUELL_LOG_INFO, "the size of the inputs changed: history starts anew");
    frame_run = std::make_unique<FrameRun>(std::move(plan), services, pool);
    pool.trim();  // blocks of the former sizes would hardly be asked for again
    planned_for = shapes;
  }

  // Sizes are those of the frame; what it does not read is as the source offered it.
  void run_frame(FrameReport& report, InputReader& reader, InputShapes shapes, FrameSink& sink) {
    std::vector<Item> inputs = reader.read(report.frame, frame_run->plan(), report.replaced);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      if (inputs[i]) shapes[graph->inputs[i].name] = shape_of(inputs[i]);
    plan_for(shapes);
    const auto ahead = [&](int input, int frames) {
      return reader.read_ahead(static_cast<std::size_t>(input), report.frame + frames, frame_run->plan());
    };
    FrameResult result = frame_run->compute(report.frame, std::move(inputs), ahead);
    report.node_seconds = std::move(result.node_seconds);
    for (const auto& [name, item] : result.outputs) sink.write(name, report.frame, item);
  }

  static bool same_shapes(const InputShapes& a, const InputShapes& b) {
    const auto same = [](const auto& x, const auto& y) {
      if (x.first != y.first || x.second.has_value() != y.second.has_value()) return false;
      return !x.second || (x.second->type == y.second->type && x.second->size == y.second->size &&
                           x.second->value_count == y.second->value_count);
    };
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), same);
  }
};

Session::Session(std::shared_ptr<const Graph> graph, SessionOptions options)
    : state_(std::make_unique<State>(std::move(graph), std::move(options))) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;

const Plan* Session::plan() const { return state_->frame_run ? &state_->frame_run->plan() : nullptr; }
BufferPool& Session::pool() { return state_->pool; }

std::vector<FrameReport> Session::run(const std::vector<std::int64_t>& frames, FrameSource& source, FrameSink& sink) {
  State& s = *state_;
  InputShapes offered;
  for (const GraphInput& input : s.graph->inputs) offered[input.name] = source.shape(input.name);
  s.plan_for(offered);

  InputReader reader(source, frames, *s.executor, s.pool);
  std::vector<FrameReport> reports;
  for (const std::int64_t frame : frames) {
    if (s.cancelled()) break;
    FrameReport report;
    report.frame = frame;
    const auto start = std::chrono::steady_clock::now();
    try {
      s.run_frame(report, reader, offered, sink);
    } catch (const Cancelled&) { break; } catch (const std::bad_alloc&) {
      report.ok = false;
      report.error = "out of memory, with " + std::to_string(s.pool.usage().in_use >> 20) + " MiB of images held";
    } catch (const std::exception& error) {
      report.ok = false;
      report.error = error.what();
    }
    reader.advance(frame);
    report.seconds = seconds_since(start);
    if (s.options.on_frame) s.options.on_frame(report);
    reports.push_back(std::move(report));
  }
  return reports;
}

std::map<std::string, Item> Session::push(std::int64_t frame, const std::map<std::string, Item>& inputs) {
  State& s = *state_;
  std::vector<Item> items(s.graph->inputs.size());
  std::vector<std::string> known;
  for (const GraphInput& input : s.graph->inputs) known.push_back(input.name);
  for (const auto& [name, item] : inputs) {
    const auto place = std::ranges::find(known, name);
    if (place == known.end())
      throw Error(Fault::usage, s.graph->name,
                  "the graph has no input '" + name + "'" + did_you_mean(name, known) + "; it has " + list_names(known, "and"));
    Item& clean = items[static_cast<std::size_t>(place - known.begin())] = item;
    const std::int64_t replaced = clean ? sanitize(clean, *s.executor, s.pool) : 0;
    if (replaced > 0 && s.options.log)
      s.options.log(QUELL_LOG_WARNING, "frame " + std::to_string(frame) + ": " + describe({name, clean.type(), replaced}));
  }
  s.plan_for(shapes_of(inputs));
  const auto no_frames_ahead = [&](int input, int) -> Item {
    throw Error(Fault::usage, known[static_cast<std::size_t>(input)],
                "the graph looks ahead on this input, which needs a whole sequence: use Session::run");
  };
  std::map<std::string, Item> outputs;
  for (auto& [name, item] : s.frame_run->compute(frame, std::move(items), no_frames_ahead).outputs)
    outputs[name] = std::move(item);
  return outputs;
}

}  // namespace quell
