#include "quell/runtime/rerun.h"

#include <algorithm>
#include <utility>

#include "quell/runtime/rerun_turn.h"
#include "quell/text/error.h"

namespace quell {
namespace {

constexpr const char* kUnsteady = "an input could not be read in every frame, or changed its size";

}  // namespace

void RerunState::forget() {
  graph.reset();
  memory.forget_all();
  steady.clear();
  complete.clear();
  why_forgotten.clear();
}

BufferPool::Usage RerunState::usage() const {
  BufferPool::Usage sum = memory.usage();
  if (!usage_of_running) return sum;
  const BufferPool::Usage running = usage_of_running();
  sum.peak = std::max(peak, running.peak + sum.in_use);
  sum.in_use += running.in_use, sum.idle += running.idle, sum.allocated += running.allocated;
  return sum;
}

RerunReport RerunTurn::run() {
  compare();
  if (!fits()) start_anew("memory has no room for a frame beside what is remembered");
  try {
    std::optional<std::vector<FrameReport>> reports = compute();
    if (!reports) {
      start_anew(kUnsteady);
      if (s_.on_restart) s_.on_restart();
      reports = compute();
    }
    finish(*reports);
  } catch (...) {
    s_.forget();
    throw;
  }
  return std::move(report_);
}

// Nothing when what is remembered turned out not to hold.
std::optional<std::vector<FrameReport>> RerunTurn::compute() {
  report_.nodes.clear();
  for (const PlannedNode& node : plan_.nodes) report_.nodes.push_back(graph_->nodes[static_cast<std::size_t>(node.node)].name);
  report_.computed.assign(report_.nodes.size(), 0);
  s_.peak = 0;
  prepare_memory();
  if (changed_.empty()) return std::vector<FrameReport>();
  std::set<std::string> fed;
  for (const Endpoint& endpoint : part_.fed) fed.insert(graph_->describe(endpoint));
  RememberingSource source(source_, s_.memory, fed);
  RememberingSink sink(sink_, s_.memory);
  const bool is_part = !part_.fed.empty() || changed_.size() < plan_.results().size();
  std::vector<FrameReport> reports;
  try {
    reports = run_session(source, sink, is_part);
  } catch (const Error&) {
    if (!is_part || source.is_steady()) throw;
    return std::nullopt;
  }
  is_steady_ = source.is_steady();
  for (const FrameReport& report : reports)
    is_steady_ = is_steady_ && (report.ok || !report.node.empty() || sink.has_failed(report.frame));
  if (!is_steady_ && is_part) return std::nullopt;
  return reports;
}

// Drops what is not needed any more, so that all that is remembered stays within its share.
void RerunTurn::prepare_memory() {
  std::set<std::string> names;
  for (const auto& [name, endpoint] : chosen_) {
    const bool holds = endpoint.node < 0 || s_.memory.has_all(name, frames_);
    if (!holds || (endpoint.node >= 0 && !unchanged_[static_cast<std::size_t>(endpoint.node)])) s_.memory.forget(name);
    names.insert(name);
  }
  s_.memory.forget_others(names);
  for (const auto& [name, endpoint] : chosen_) s_.memory.expect(name, plan_.shape(endpoint));
}

std::vector<FrameReport> RerunTurn::run_session(RememberingSource& source, RememberingSink& sink, bool is_part) {
  SessionOptions options = s_.options;
  options.dumps.clear();
  options.memory = limit_ - chosen_bytes_;
  options.cancelled = [&, given = s_.options.cancelled] { return (given && given()) || (is_part && !source.is_steady()); };
  options.on_frame = [&](const FrameReport& report) {
    if (s_.options.on_frame && (!is_part || source.is_steady())) s_.options.on_frame(translate(report));
  };
  const std::shared_ptr<const Graph> graph = with_memory();
  steps_.clear();
  for (const PlannedNode& node : make_plan(graph, offered()).nodes)
    steps_.push_back(part_.nodes[static_cast<std::size_t>(node.node)]);
  Session session(graph, std::move(options));
  s_.usage_of_running = [&session] { return session.pool().usage(); };
  std::vector<FrameReport> reports;
  try {
    reports = session.run(frames_, source, sink);
  } catch (...) {
    s_.usage_of_running = nullptr;
    throw;
  }
  s_.peak = s_.usage().peak;
  s_.usage_of_running = nullptr;
  for (FrameReport& report : reports) report = translate(std::move(report));
  for (const FrameReport& report : reports)
    for (std::size_t i = 0; i < report.node_seconds.size(); ++i) report_.computed[i] += report.node_seconds[i] > 0 ? 1 : 0;
  return reports;
}

// The report of the whole graph.
FrameReport RerunTurn::translate(FrameReport report) const {
  const std::vector<PlannedResult> wanted = plan_.results();
  std::erase_if(report.inputs, [&](const ReportedSize& kept) {  // what an earlier run has kept is no input
    return std::ranges::find(graph_->inputs, kept.name, &GraphInput::name) == graph_->inputs.end();
  });
  std::erase_if(report.results, [&](const ReportedSize& kept) {  // neither is what is kept for later ones a result
    return std::ranges::find(wanted, kept.name, &PlannedResult::name) == wanted.end();
  });
  if (report.node_seconds.size() != steps_.size()) return report;  // it could not be read
  std::vector<double> seconds(plan_.nodes.size());
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const auto place = std::ranges::find(plan_.nodes, steps_[i], &PlannedNode::node);
    if (place != plan_.nodes.end()) seconds[static_cast<std::size_t>(place - plan_.nodes.begin())] = report.node_seconds[i];
  }
  report.node_seconds = std::move(seconds);
  return report;
}

void RerunTurn::finish(const std::vector<FrameReport>& reports) {
  const bool is_whole = reports.size() == frames_.size() && std::ranges::all_of(reports, &FrameReport::ok);
  std::map<std::string, std::string> complete;
  for (const PlannedResult& result : plan_.results()) {
    const bool is_changed = std::ranges::find(report_.results, result.name) != report_.results.end();
    if (is_changed ? is_whole : true) complete[result.name] = meaning(result);
  }
  for (const auto& [name, endpoint] : chosen_)
    if (endpoint.node >= 0 && !s_.memory.has_all(name, frames_)) s_.memory.forget(name);
  if (reports.size() == frames_.size()) s_.steady.merge(used_inputs(plan_));
  std::erase_if(s_.steady, [&](const std::string& input) { return !shapes_.contains(input); });  // another one may get the name
  s_.graph = graph_, s_.frames = frames_, s_.cuts = s_.options.cuts, s_.shapes = shapes_;
  s_.stamps = std::move(stamps_), s_.complete = std::move(complete);
  report_.frames = reports;
  if (!is_steady_) s_.forget(), s_.why_forgotten = kUnsteady;
  report_.remembered_bytes = s_.memory.usage().in_use;
  report_.peak_bytes = s_.peak;
}

Rerun::Rerun(bool together) : state_(std::make_unique<RerunState>()) { state_->together = together; }
Rerun::~Rerun() = default;

RerunReport Rerun::run(std::shared_ptr<const Graph> graph, const std::vector<std::int64_t>& frames, FrameSource& source,
                       FrameSink& sink, const SessionOptions& options, std::map<std::string, std::string> labels) {
  state_->options = options;
  state_->labels = std::move(labels);
  return RerunTurn(*state_, std::move(graph), frames, source, sink).run();
}

void Rerun::forget() { state_->forget(); }

void Rerun::on_restart(std::function<void()> told) { state_->on_restart = std::move(told); }

BufferPool::Usage Rerun::usage() const { return state_->usage(); }

}  // namespace quell
