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
  std::map<Endpoint, std::size_t> last_reader;  // in the same frame; position in Plan::turns
  std::set<Endpoint> kept;                      // handed out, or part of a history
};

// Everything that the nodes of a turn read.
std::vector<Read> reads(const Plan& plan, const PlannedTurn& turn, const Presence& presence) {
  std::vector<Read> all;
  for (const int position : turn.nodes)
    for (const Read& read : reads(node_of(plan, plan.nodes[static_cast<std::size_t>(position)]), presence)) all.push_back(read);
  return all;
}

Uses find_uses(const Plan& plan, const Presence& presence) {
  Uses uses;
  for (const int output : plan.outputs) uses.kept.insert(plan.graph->outputs[static_cast<std::size_t>(output)].from);
  uses.kept.insert(plan.dumps.begin(), plan.dumps.end());
  for (const PlannedHistory& history : plan.histories) uses.kept.insert(history.from);
  for (std::size_t turn = 0; turn < plan.turns.size(); ++turn)
    for (const Read& read : reads(plan, plan.turns[turn], presence))
      if (read.delay == 0) uses.last_reader[read.from] = turn;
  return uses;
}

bool is_yielded_by(const Plan& plan, const PlannedTurn& turn, const Endpoint& endpoint) {
  return std::ranges::any_of(turn.nodes,
                             [&](int position) { return plan.nodes[static_cast<std::size_t>(position)].node == endpoint.node; });
}

// Whether a node of the turn may write over what the items of its input hold. Of fused nodes only one may read that, and never
// what it has written.
bool may_overwrite(const Plan& plan, const Presence& presence, const Uses& uses, std::size_t index, std::size_t member,
                   std::size_t input) {
  const PlannedTurn& turn = plan.turns[index];
  if (turn.is_fused() && turn.ahead[member] > 0) return false;
  const std::vector<Read> all = reads(plan, turn, presence);
  bool any = false;
  for (const Edge& edge : node_of(plan, plan.nodes[static_cast<std::size_t>(turn.nodes[member])]).inputs[input]) {
    if (!presence.has(edge)) continue;  // so is the item of the output
    any = true;
    const auto of_this = [&](const Read& read) { return read.from == edge.from; };
    if (edge.delay != 0 || uses.kept.contains(edge.from) || uses.last_reader.at(edge.from) != index ||
        std::count_if(all.begin(), all.end(), of_this) != 1 || is_yielded_by(plan, turn, edge.from))
      return false;
  }
  return any;
}

// What the turn reads or writes and nobody needs afterwards.
std::vector<Endpoint> find_last_uses(const Plan& plan, const Presence& presence, const Uses& uses, std::size_t index) {
  const PlannedTurn& turn = plan.turns[index];
  std::set<Endpoint> last;
  for (const Read& read : reads(plan, turn, presence))
    if (read.delay == 0 && uses.last_reader.at(read.from) == index) last.insert(read.from);
  for (const int position : turn.nodes) {
    const PlannedNode& planned = plan.nodes[static_cast<std::size_t>(position)];
    for (std::size_t port = 0; port < planned.outputs.size(); ++port)
      for (std::size_t item = 0; item < planned.outputs[port].size(); ++item) {
        const Endpoint endpoint{planned.node, static_cast<int>(port), static_cast<int>(item)};
        if (planned.outputs[port][item].present && !uses.last_reader.contains(endpoint)) last.insert(endpoint);
      }
  }
  std::erase_if(last, [&](const Endpoint& endpoint) { return uses.kept.contains(endpoint) || plan.is_inner(endpoint); });
  return {last.begin(), last.end()};
}

std::size_t input_bytes(const Plan& plan) {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < plan.inputs.size(); ++i)
    if (plan.input_used[i]) bytes = add(bytes, bytes_of(plan.inputs[i]));
  return bytes;
}

// Of what a node writes whole.
std::size_t output_bytes(const Plan& plan, const PlannedNode& planned) {
  std::size_t bytes = 0;
  for (std::size_t port = 0; port < planned.outputs.size(); ++port)
    for (std::size_t item = 0; planned.in_place_of[port] < 0 && item < planned.outputs[port].size(); ++item)
      if (!plan.is_inner({planned.node, static_cast<int>(port), static_cast<int>(item)}))
        bytes = add(bytes, bytes_of(planned.outputs[port][item]));
  return bytes;
}

std::size_t unshared_bytes(const PlannedNode& planned) {
  std::size_t bytes = planned.scratch_bytes;
  for (const std::vector<Shape>& port : planned.outputs)
    for (const Shape& shape : port) bytes = add(bytes, bytes_of(shape));
  return bytes;
}

// What is given back after the turn: not the buffers that its outputs took over.
std::size_t released_bytes(const Plan& plan, const PlannedTurn& turn) {
  std::set<Endpoint> taken;
  std::size_t bytes = 0;
  for (const int position : turn.nodes) {
    const PlannedNode& planned = plan.nodes[static_cast<std::size_t>(position)];
    for (std::size_t port = 0; port < planned.in_place_of.size(); ++port) {
      if (planned.in_place_of[port] < 0) continue;
      const std::vector<Edge>& edges = node_of(plan, planned).inputs[static_cast<std::size_t>(planned.in_place_of[port])];
      for (std::size_t item = 0; item < edges.size(); ++item)  // inner outputs have no buffer, and take over none
        if (!plan.is_inner({planned.node, static_cast<int>(port), static_cast<int>(item)})) taken.insert(edges[item].from);
    }
  }
  for (const int position : turn.nodes)
    for (const Endpoint& endpoint : plan.nodes[static_cast<std::size_t>(position)].last_uses)
      if (!taken.contains(endpoint)) bytes = add(bytes, bytes_of(plan.shape(endpoint)));
  return bytes;
}

std::vector<std::size_t> count_alive_bytes(const Plan& plan) {
  std::vector<std::size_t> counts(plan.nodes.size());
  std::size_t alive = input_bytes(plan);
  for (const PlannedTurn& turn : plan.turns) {
    std::size_t scratch = 0;
    for (const int position : turn.nodes) {
      const PlannedNode& planned = plan.nodes[static_cast<std::size_t>(position)];
      alive = add(alive, output_bytes(plan, planned));
      scratch = add(scratch, planned.scratch_bytes);
    }
    for (const int position : turn.nodes) counts[static_cast<std::size_t>(position)] = add(alive, scratch);
    alive -= std::min(alive, released_bytes(plan, turn));
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
  for (std::size_t i = 0; i < plan.turns.size(); ++i) {
    const PlannedTurn& turn = plan.turns[i];
    for (std::size_t member = 0; member < turn.nodes.size(); ++member)
      for (int& input : plan.nodes[static_cast<std::size_t>(turn.nodes[member])].in_place_of)
        if (input >= 0 && !may_overwrite(plan, presence, uses, i, member, static_cast<std::size_t>(input))) input = -1;
    plan.nodes[static_cast<std::size_t>(turn.nodes.back())].last_uses = find_last_uses(plan, presence, uses, i);
  }
  plan.frame_bytes = plan.unshared_bytes = input_bytes(plan);
  plan.alive_bytes = count_alive_bytes(plan);
  for (const std::size_t alive : plan.alive_bytes) plan.frame_bytes = std::max(plan.frame_bytes, alive);
  for (const PlannedNode& planned : plan.nodes) plan.unshared_bytes = add(plan.unshared_bytes, unshared_bytes(planned));
  for (const PlannedHistory& history : plan.histories) plan.history_bytes = add(plan.history_bytes, bytes_of(history));
}

}  // namespace quell::planning
