#include "quell/graph/plan_buffers.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace quell::planning {
namespace {

// Sums of sizes stop at the largest number: a graph that asks for more is refused by whoever compares it with a limit.
std::size_t add(std::size_t a, std::size_t b) { return a > std::numeric_limits<std::size_t>::max() - b ? SIZE_MAX : a + b; }
std::size_t times(std::size_t bytes, std::size_t count) {
  return count != 0 && bytes > std::numeric_limits<std::size_t>::max() / count ? SIZE_MAX : bytes * count;
}

const Node& node_of(const Plan& plan, const PlannedNode& planned) {
  return plan.graph->nodes[static_cast<std::size_t>(planned.node)];
}

struct Uses {
  std::map<Endpoint, std::size_t> last_reader;  // in the same frame; position in Plan::nodes
  std::set<Endpoint> kept;                      // handed out, or part of a history
};

Uses find_uses(const Plan& plan, const Presence& presence) {
  Uses uses;
  for (const int output : plan.outputs) uses.kept.insert(plan.graph->outputs[static_cast<std::size_t>(output)].from);
  uses.kept.insert(plan.dumps.begin(), plan.dumps.end());
  for (const PlannedHistory& history : plan.histories) uses.kept.insert(history.from);
  for (std::size_t i = 0; i < plan.nodes.size(); ++i)
    for (const Read& read : reads(node_of(plan, plan.nodes[i]), presence))
      if (read.delay == 0) uses.last_reader[read.from] = i;
  return uses;
}

// Whether the node at `position` may write over what the items of its input hold.
bool may_overwrite(const Plan& plan, const Presence& presence, const Uses& uses, std::size_t position, std::size_t input) {
  const Node& node = node_of(plan, plan.nodes[position]);
  const std::vector<Read> all = reads(node, presence);
  bool any = false;
  for (const Edge& edge : node.inputs[input]) {
    if (!presence.has(edge)) continue;  // so is the item of the output
    any = true;
    const auto of_this = [&](const Read& read) { return read.from == edge.from; };
    if (edge.delay != 0 || uses.kept.contains(edge.from) || uses.last_reader.at(edge.from) != position ||
        std::count_if(all.begin(), all.end(), of_this) != 1)
      return false;
  }
  return any;
}

// What the node at `position` reads or writes and nobody needs afterwards.
std::vector<Endpoint> find_last_uses(const Plan& plan, const Presence& presence, const Uses& uses, std::size_t position) {
  const PlannedNode& planned = plan.nodes[position];
  std::set<Endpoint> last;
  for (const Read& read : reads(node_of(plan, planned), presence))
    if (read.delay == 0 && uses.last_reader.at(read.from) == position) last.insert(read.from);
  for (std::size_t port = 0; port < planned.outputs.size(); ++port)
    for (std::size_t item = 0; item < planned.outputs[port].size(); ++item) {
      const Endpoint endpoint{planned.node, static_cast<int>(port), static_cast<int>(item)};
      if (planned.outputs[port][item].present && !uses.last_reader.contains(endpoint)) last.insert(endpoint);
    }
  std::erase_if(last, [&](const Endpoint& endpoint) { return uses.kept.contains(endpoint); });
  return {last.begin(), last.end()};
}

std::size_t input_bytes(const Plan& plan) {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < plan.inputs.size(); ++i)
    if (plan.input_used[i]) bytes = add(bytes, bytes_of(plan.inputs[i]));
  return bytes;
}

std::size_t output_bytes(const PlannedNode& planned, bool in_place_too) {
  std::size_t bytes = 0;
  for (std::size_t port = 0; port < planned.outputs.size(); ++port)
    if (in_place_too || planned.in_place_of[port] < 0)
      for (const Shape& shape : planned.outputs[port]) bytes = add(bytes, bytes_of(shape));
  return bytes;
}

// What is given back after the node: not the buffers that its outputs took over.
std::size_t released_bytes(const Plan& plan, const PlannedNode& planned) {
  const Node& node = node_of(plan, planned);
  std::set<Endpoint> taken;
  for (const int input : planned.in_place_of)
    if (input >= 0)
      for (const Edge& edge : node.inputs[static_cast<std::size_t>(input)]) taken.insert(edge.from);
  std::size_t bytes = 0;
  for (const Endpoint& endpoint : planned.last_uses)
    if (!taken.contains(endpoint)) bytes = add(bytes, bytes_of(plan.shape(endpoint)));
  return bytes;
}

std::vector<std::size_t> count_alive_bytes(const Plan& plan) {
  std::vector<std::size_t> counts;
  std::size_t alive = input_bytes(plan);
  for (const PlannedNode& planned : plan.nodes) {
    alive = add(alive, output_bytes(planned, false));
    counts.push_back(add(alive, planned.scratch_bytes));
    alive -= std::min(alive, released_bytes(plan, planned));
  }
  return counts;
}

}  // namespace

std::size_t bytes_of(const Shape& shape) {
  if (!shape.present) return 0;
  if (is_image(shape.type)) return Image::bytes_needed(shape.type, shape.size);
  return shape.value_count * sizeof(double);
}

std::size_t bytes_of(const PlannedHistory& history) {
  return times(history.bytes_per_frame,
               static_cast<std::size_t>(history.frames) + static_cast<std::size_t>(history.frames_ahead));
}

void plan_histories(Plan& plan, const Presence& presence) {
  std::map<Endpoint, PlannedHistory> histories;
  for (const PlannedNode& planned : plan.nodes)
    for (const Read& read : reads(node_of(plan, planned), presence)) {
      if (read.delay == 0) continue;
      PlannedHistory& history = histories[read.from];
      history.from = read.from;
      history.frames = std::max(history.frames, read.delay);
      history.frames_ahead = std::max(history.frames_ahead, -read.delay);
      history.bytes_per_frame = bytes_of(plan.shape(read.from));
    }
  for (const auto& [endpoint, history] : histories) plan.histories.push_back(history);
}

void plan_buffers(Plan& plan, const Presence& presence) {
  const Uses uses = find_uses(plan, presence);
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    PlannedNode& planned = plan.nodes[i];
    for (int& input : planned.in_place_of)
      if (input >= 0 && !may_overwrite(plan, presence, uses, i, static_cast<std::size_t>(input))) input = -1;
    planned.last_uses = find_last_uses(plan, presence, uses, i);
  }
  plan.frame_bytes = plan.unshared_bytes = input_bytes(plan);
  plan.alive_bytes = count_alive_bytes(plan);
  for (const std::size_t alive : plan.alive_bytes) plan.frame_bytes = std::max(plan.frame_bytes, alive);
  for (const PlannedNode& planned : plan.nodes)
    plan.unshared_bytes = add(plan.unshared_bytes, add(output_bytes(planned, true), planned.scratch_bytes));
  for (const PlannedHistory& history : plan.histories) plan.history_bytes = add(plan.history_bytes, bytes_of(history));
}

}  // namespace quell::planning
