// What a run has to compute, and what it leaves in memory.
#include <algorithm>
#include <utility>

#include "quell/runtime/graph_change.h"
#include "quell/runtime/rerun_turn.h"
#include "quell/runtime/window.h"
#include "quell/text/error.h"

namespace quell {
namespace {

InputShapes shapes_of(const Graph& graph, FrameSource& source) {
  InputShapes shapes;
  for (const GraphInput& input : graph.inputs) shapes[input.name] = source.shape(input.name);
  return shapes;
}

bool same_shape(const std::optional<Shape>& a, const std::optional<Shape>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->type == b->type && a->size == b->size && a->value_count == b->value_count);
}

// What the nodes of a plan yield, the last node first.
std::vector<Endpoint> values_of(const Plan& plan) {
  std::vector<Endpoint> all;
  for (auto node = plan.nodes.rbegin(); node != plan.nodes.rend(); ++node)
    for (std::size_t port = 0; port < node->outputs.size(); ++port)
      for (std::size_t item = 0; item < node->outputs[port].size(); ++item)
        if (node->outputs[port][item].present) all.push_back({node->node, static_cast<int>(port), static_cast<int>(item)});
  return all;
}

// Whether an input is there in every frame, always of one shape.
bool is_steady(FrameSource& source, const std::string& input, const std::vector<std::int64_t>& frames,
               const std::function<bool()>& cancelled) {
  const std::optional<Shape> shape = source.shape(input);
  BufferPool pool;
  const auto fits = [&](std::int64_t frame) {
    if (cancelled && cancelled()) return false;
    const Item item = source.read(input, frame, pool);
    return item && same_shape(shape_of(item), shape);
  };
  try {
    return shape && std::ranges::all_of(frames, fits);
  } catch (const std::exception&) { return false; }  // the run will tell why
}

}  // namespace

std::set<std::string> used_inputs(const Plan& plan) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < plan.input_used.size(); ++i)
    if (plan.input_used[i]) names.insert(plan.graph->inputs[i].name);
  return names;
}

RerunTurn::RerunTurn(RerunState& state, std::shared_ptr<const Graph> graph, const std::vector<std::int64_t>& frames,
                     FrameSource& source, FrameSink& sink)
    : s_(state),
      graph_(std::move(graph)),
      frames_(frames),
      source_(source),
      sink_(sink),
      shapes_(shapes_of(*graph_, source)),
      plan_(make_plan(graph_, shapes_, state.options.dumps)) {
  for (const Node& node : graph_->nodes) stamps_[node.name] = stamp_files(node);
  limit_ = choose_window(plan_, threads(), s_.options.frames_in_flight, s_.options.memory, s_.options.reserved).memory;
}

void RerunTurn::start_anew(const std::string& why) {
  if (s_.graph) report_.all_anew = why;
  s_.forget();
  unchanged_.assign(graph_->nodes.size(), false);
  split();
  if (fits()) return;
  remembers_ = false;
  choose();
}

void RerunTurn::compare() {
  if (!s_.graph) {
    report_.all_anew = s_.why_forgotten;
    return start_anew("");
  }
  if (s_.frames != frames_) return start_anew("other frames are computed");
  if (s_.cuts != s_.options.cuts) return start_anew("history is cut elsewhere");
  for (const auto& [name, shape] : shapes_)
    if (const auto before = s_.shapes.find(name); before != s_.shapes.end() && !same_shape(before->second, shape))
      return start_anew("the input '" + name + "' has another size or type");
  std::vector<bool> touched;
  for (const Node& node : graph_->nodes) touched.push_back(s_.stamps[node.name] != stamps_[node.name]);
  unchanged_ = find_unchanged(*s_.graph, *graph_, touched);
  split();
  if (part_.fed.empty() && report_.results.size() == plan_.results().size()) return;
  for (const std::string& input : used_inputs(plan_)) {
    if (s_.steady.contains(input)) continue;
    if (!is_steady(source_, input, frames_, s_.options.cancelled))
      return start_anew("the input '" + input + "' cannot be read in every frame, or changes its size");
    s_.steady.insert(input);
  }
}

// What a result is, apart from the values that stand at its place.
std::string RerunTurn::meaning(const PlannedResult& result) const {
  const auto label = s_.labels.find(result.name);
  return graph_->describe(result.from) + (label == s_.labels.end() ? "" : "\n" + label->second);
}

// Whether a result is what was handed out in the run before.
bool RerunTurn::is_complete(const PlannedResult& result) const {
  const auto before = s_.complete.find(result.name);
  if (before == s_.complete.end() || before->second != meaning(result)) return false;
  return result.from.node < 0 || unchanged_[static_cast<std::size_t>(result.from.node)];
}

// Finds the part of the graph that is to be computed, and what is to be remembered.
void RerunTurn::split() {
  changed_.clear();
  report_.results.clear();
  const std::vector<PlannedResult> results = plan_.results();
  const bool is_any_changed = !std::ranges::all_of(results, [&](const PlannedResult& result) { return is_complete(result); });
  for (const PlannedResult& result : results)
    if ((s_.together && is_any_changed) || !is_complete(result))
      changed_.push_back(result), report_.results.push_back(result.name);
  part_ = take_part(*graph_, changed_, [&](const Endpoint& endpoint) { return is_known(endpoint); });
  runs_.clear();
  // What lacks an input is part of it, too, with all that it would read, but does not run.
  for (const PlannedNode& node : make_plan(part_.graph, offered()).nodes)
    runs_.insert(part_.nodes[static_cast<std::size_t>(node.node)]);
  choose();
}

InputShapes RerunTurn::offered() const {
  InputShapes offered = shapes_;
  for (const Endpoint& endpoint : part_.fed) offered[graph_->describe(endpoint)] = plan_.shape(endpoint);
  return offered;
}

// What is remembered after this run, within half of the limit.
void RerunTurn::choose() {
  std::size_t room = remembers_ ? limit_ / 2 : 0;
  chosen_.clear();
  chosen_bytes_ = 0;
  report_.no_room.clear();
  const auto take = [&](const Endpoint& endpoint) {
    const std::string name = graph_->describe(endpoint);
    if (chosen_.contains(name)) return true;
    const std::size_t bytes = plan_.bytes(endpoint), most = room / std::max<std::size_t>(frames_.size(), 1);
    if (bytes > most || room == 0) return false;
    room -= bytes * frames_.size(), chosen_bytes_ += bytes * frames_.size();
    chosen_[name] = endpoint;
    return true;
  };
  for (const Endpoint& endpoint : part_.fed) take(endpoint);
  for (const Endpoint& endpoint : values_of(plan_)) {
    const bool will_be_there = runs_.contains(endpoint.node) || is_known(endpoint);
    const std::string& node = graph_->nodes[static_cast<std::size_t>(endpoint.node)].name;
    if ((!will_be_there || !take(endpoint)) && std::ranges::find(report_.no_room, node) == report_.no_room.end())
      report_.no_room.push_back(node);
  }
  std::ranges::reverse(report_.no_room);
  for (std::size_t i = 0; source_.uses_processor() && i < plan_.input_used.size(); ++i)
    if (plan_.input_used[i]) take({-1, static_cast<int>(i), 0});
}

bool RerunTurn::fits() const {
  const auto is_chosen = [&](const Endpoint& endpoint) { return chosen_.contains(graph_->describe(endpoint)); };
  if (!std::ranges::all_of(part_.fed, is_chosen) || chosen_bytes_ >= limit_) return false;
  try {
    choose_window(make_plan(with_memory(), offered()), threads(), s_.options.frames_in_flight, limit_ - chosen_bytes_);
    return true;
  } catch (const Error& error) {
    if (error.fault() != Fault::memory) throw;
    return false;
  }
}

// The part of the graph, with what is to be remembered of it among its results.
std::shared_ptr<const Graph> RerunTurn::with_memory() const {
  const auto graph = std::make_shared<Graph>(*part_.graph);
  for (std::size_t i = 0; i < part_.nodes.size(); ++i) {
    const auto add = [&](const auto& entry) {
      const auto& [name, endpoint] = entry;
      if (endpoint.node != part_.nodes[i] || !runs_.contains(endpoint.node) || is_known(endpoint)) return;
      graph->outputs.push_back(
          {std::string(RememberingSink::kMark) + name, {static_cast<int>(i), endpoint.port, endpoint.item}, {}});
    };
    std::ranges::for_each(chosen_, add);
  }
  return graph;
}

}  // namespace quell
