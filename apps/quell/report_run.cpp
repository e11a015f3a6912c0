#include "report_run.h"

#include <algorithm>
#include <cassert>
#include <chrono>

#include "graphviz.h"
#include "interrupt.h"
#include "quell/graph/plan_dot.h"
#include "quell/runtime/sanitize.h"
#include "quell/text/error.h"
#include "quell/text/json.h"
#include "report_page.h"

namespace quell::app {
namespace {

Names names_of_results(const Plan& plan) {
  Names names;
  for (const int output : plan.outputs) names.insert(plan.graph->outputs[static_cast<std::size_t>(output)].name);
  return names;
}

/// Passes whose weights the page tells.
const Names& means() {
  static const Names names = [] {
    Diagnostics errors;
    const auto text = std::make_shared<SourceText>(SourceText{"means.json", std::string(kReportMeans)});
    const std::optional<Json> list = parse_json(text, errors);
    assert(list && errors.empty());
    Names found;
    for (const JsonMember& pass : list->members) found.insert(pass.key);
    return found;
  }();
  return names;
}

/// Inputs that are read by some graph, each from the first graph that reads it.
std::map<std::string, const ReportedGraph*> find_inputs(const std::vector<ReportedGraph>& graphs) {
  std::map<std::string, const ReportedGraph*> inputs;
  for (const ReportedGraph& graph : graphs)
    for (const InputFiles& input : graph.job.inputs) inputs.emplace(input.input, &graph);
  return inputs;
}

Weighed weighed_by_any(const std::vector<ReportedGraph>& graphs) {
  Weighed all;
  for (const ReportedGraph& graph : graphs) {
    all.now.insert(graph.weighed.now.begin(), graph.weighed.now.end());
    all.before.insert(graph.weighed.before.begin(), graph.weighed.before.end());
  }
  return all;
}

/// As the graph reads it: without NaN and infinity. Nothing where it cannot be read: the run has told why.
Item read_input(const ReportedGraph& graph, const std::string& input, std::int64_t frame, Executor& executor, BufferPool& pool) {
  try {
    Item item = graph.job.sequence->read(input, frame, pool);
    sanitize(item, executor, pool);
    return item;
  } catch (const Error&) { return {}; }
}

ReportImage read_reference(const ReportFrames& frames, const MeasuringOptions& measuring, BufferPool& pool,
                           PackedImages& packed) {
  ReportImage reference{"reference", ReportImage::Kind::reference, -1, QUELL_TYPE_COLOR, {}};
  for (const std::int64_t frame : frames.kept) try {
      if (interrupted()) throw Interrupted{};
      if (measuring.has_reference(frame)) reference.frames[frame] = packed.add(pack(measuring.reference.read(frame, pool)));
    } catch (const Error& error) { spdlog::warn("frame {}: the report has no reference: {}", frame, error.what()); }
  return reference;
}

void read_noisy(const ReportedGraph& graph, const ReportFrames& frames, const Weighed& weighed,
                const std::optional<MeasuringOptions>& measuring, Executor& executor, PackedImages& packed,
                ReportedInputs& read) {
  BufferPool pool;
  ReportSink sink(frames, {kNoisyInput}, weighed, packed);
  std::optional<MeasuringSink> measure;
  if (measuring) {
    MeasuringOptions options = *measuring;
    options.outputs = {kNoisyInput};
    measure.emplace(sink, std::move(options));
  }
  FrameSink& to = measure ? static_cast<FrameSink&>(*measure) : sink;
  for (const std::int64_t frame : frames.all) {
    if (interrupted()) throw Interrupted{};
    const Item item = read_input(graph, kNoisyInput, frame, executor, pool);
    if (!item) continue;
    to.write(kNoisyInput, frame, item);
    if (measure) read.measured[frame] = measure->take(frame);
  }
  if (measure) read.totals = measure->totals();
  const auto found = sink.images().find(kNoisyInput);
  if (found == sink.images().end()) return;
  read.images.push_back(found->second);
  read.images.back().kind = ReportImage::Kind::noisy;
}

}  // namespace

std::vector<std::string> list_inner_images(const Plan& plan) {
  std::vector<std::string> names;
  const std::vector<PlannedResult> results = plan.results();
  for (const PlannedNode& planned : plan.nodes)
    for (std::size_t port = 0; port < planned.outputs.size(); ++port)
      for (std::size_t item = 0; item < planned.outputs[port].size(); ++item) {
        const Shape& shape = planned.outputs[port][item];
        const Endpoint endpoint{planned.node, static_cast<int>(port), static_cast<int>(item)};
        const bool is_result = std::ranges::any_of(results, [&](const PlannedResult& result) { return result.from == endpoint; });
        if (shape.present && is_image(shape.type) && !is_result) names.push_back(plan.graph->describe(endpoint));
      }
  return names;
}

Weighed find_weighed(const Plan& plan) {
  Weighed found;
  const std::vector<PlannedResult> results = plan.results();
  // A result goes by its own name; what the sequence gives goes by that of the input, even where it is a result, too.
  const auto add = [&](Names& names, const Endpoint& endpoint) {
    const auto result = std::ranges::find(results, endpoint, &PlannedResult::from);
    if (result != results.end()) names.insert(result->name);
    names.insert(plan.graph->describe(endpoint));
  };
  for (const PlannedNode& planned : plan.nodes) {
    const Node& node = plan.graph->nodes[static_cast<std::size_t>(planned.node)];
    if (!means().contains(node.pass->id)) continue;
    for (const std::vector<Edge>& edges : node.inputs)
      for (const Edge& edge : edges)
        if (!edge.from.is_nothing() && edge.delay >= 0 && edge.delay <= 1)
          add(edge.delay == 0 ? found.now : found.before, edge.from);
    for (std::size_t port = 0; port < planned.outputs.size(); ++port)
      for (std::size_t item = 0; item < planned.outputs[port].size(); ++item)
        add(found.now, {planned.node, static_cast<int>(port), static_cast<int>(item)});
  }
  return found;
}

void run_for_report(ReportedGraph& graph, const ReportFrames& frames, const std::optional<MeasuringOptions>& measuring,
                    const SessionOptions& session, PackedImages& packed) {
  ReportSink sink(frames, names_of_results(graph.job.plan), graph.weighed, packed);
  std::optional<MeasuringSink> measure;
  if (measuring) measure.emplace(sink, *measuring);
  SessionOptions options = session;
  options.schedule = Schedule::serial;
  options.cancelled = interrupted;
  if (!frames.inner.empty()) options.dumps = graph.inner;
  options.on_frame = [&](const FrameReport& report) {
    if (!report.ok) {
      spdlog::warn("{}: frame {} failed: {}", graph.label, report.frame, report.error);
      sink.forget(report.frame);
      if (measure) measure->forget(report.frame);
    } else if (measure) {
      graph.measured[report.frame] = measure->take(report.frame);
    }
  };
  const auto start = std::chrono::steady_clock::now();
  graph.frames =
      Session(graph.job.graph, options).run(frames.all, *graph.job.sequence, measure ? static_cast<FrameSink&>(*measure) : sink);
  graph.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (interrupted()) throw Interrupted{};
  graph.images = sink.images();
  if (measure) graph.totals = measure->totals();
}

void draw_for_report(ReportedGraph& graph) {
  try {
    graph.drawing = draw_svg(to_dot(graph.job.plan));
  } catch (const Error& error) {
    graph.no_drawing = error.what();
    spdlog::warn("{}: the report will have no drawing of the graph: {}", graph.label, error.what());
  }
}

ReportedInputs read_inputs(const std::vector<ReportedGraph>& graphs, const ReportFrames& frames,
                           const std::optional<MeasuringOptions>& measuring, PackedImages& packed) {
  ReportedInputs read;
  BufferPool pool;
  Executor executor;
  const std::map<std::string, const ReportedGraph*> inputs = find_inputs(graphs);
  const Weighed weighed = weighed_by_any(graphs);
  if (const auto noisy = inputs.find(kNoisyInput); noisy != inputs.end())
    read_noisy(*noisy->second, frames, weighed, measuring, executor, packed, read);
  if (measuring) read.images.push_back(read_reference(frames, *measuring, pool, packed));
  for (const auto& [name, graph] : inputs) {
    ReportImage image{name, ReportImage::Kind::input, -1, QUELL_TYPE_COLOR, {}};
    if (name == kNoisyInput) continue;
    std::set<std::int64_t> wanted = frames.inner;
    if (weighed.before.contains(name)) wanted.insert(frames.before.begin(), frames.before.end());
    for (const std::int64_t frame : wanted) {
      if (interrupted()) throw Interrupted{};
      const Item item = read_input(*graph, name, frame, executor, pool);
      if (!item.image()) continue;
      image.type = item.image()->type();
      image.frames[frame] = packed.add(pack(*item.image(), Precision::exact));
    }
    if (!image.frames.empty()) read.images.push_back(std::move(image));
  }
  return read;
}

}  // namespace quell::app
