#include "quell/runtime/lane.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <utility>

#include "quell/runtime/failure.h"

namespace quell {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Whether there is an item, of the type and size that were planned for.
bool fits(const Item& item, const Shape& planned) {
  return item && planned.present && item.type() == planned.type && (!item.image() || item.image()->size() == planned.size);
}

}  // namespace

Lane::Lane(PlanState& state, const HostServices& services, BufferPool& pool, Trace* trace)
    : state_(state), pool_(pool), trace_(trace), values_(state.wiring.readers.size()) {
  const std::size_t nodes = state.plan.nodes.size();
  tables_.inputs.resize(nodes), tables_.outputs.resize(nodes);
  tables_.outcomes.resize(nodes), tables_.errors.resize(nodes), tables_.seconds.resize(nodes);
  for (std::size_t node = 0; node < nodes; ++node)
    for (const std::vector<Fetch>& port : state.wiring.nodes[node].fetches) tables_.inputs[node].emplace_back(port.size());
  for (const PlannedTurn& turn : state.plan.turns) {
    std::string& label = labels_.emplace_back();
    for (const int node : turn.nodes) label += (label.empty() ? "" : " + ") + name(node);
    if (turn.is_fused()) {
      runners_.emplace_back(std::in_place_type<FusedRunner>, label, state.plan, turn, services, pool);
      continue;
    }
    const PlannedNode& planned = state.plan.nodes[at(turn.nodes.front())];
    runners_.emplace_back(std::in_place_type<NodeRunner>, label, *state.plan.graph->nodes[at(planned.node)].instance,
                          NodeLayout{planned.outputs, planned.in_place_of, planned.scratch_bytes, planned.slot_scratch_bytes},
                          services, pool);
  }
}

void Lane::begin(std::int64_t frame, FrameInputs inputs) {
  clear();
  frame_ = frame;
  readers_ = state_.wiring.readers;
  ahead_ = std::move(inputs.ahead);
  std::ranges::fill(tables_.outcomes, Outcome::pending);
  std::ranges::fill(tables_.seconds, 0.0);
  for (std::size_t value = 0; value < inputs.items.size(); ++value) {
    for (const int line : state_.wiring.lines[value]) state_.history.add(line, frame, inputs.items[value]);
    note_reset(static_cast<int>(value), inputs.items[value]);
    if (readers_[value] > 0) values_[value] = std::move(inputs.items[value]);
  }
}

bool Lane::is_lost(int step) {
  const auto is_gone = [&](int node) { return outcome(node) == Outcome::failed || outcome(node) == Outcome::lost; };
  for (const int node : nodes_of(step))
    if (std::ranges::any_of(state_.wiring.nodes[at(node)].needs, is_gone)) outcome(node) = Outcome::lost;
  return std::ranges::all_of(nodes_of(step), is_gone);
}

void Lane::skip(int step) {
  for (const int node : nodes_of(step)) {
    outcome(node) = Outcome::lost;
    take_all(node);
  }
}

void Lane::take_all(int node) {
  for (const std::vector<Fetch>& port : state_.wiring.nodes[at(node)].fetches)
    for (const Fetch& fetch : port) {
      take(fetch.value);
      take(fetch.initial);
    }
}

// The last reader gets the frame's own hold on the value, and may then be its only holder.
Item Lane::take(int value) {
  if (value < 0) return {};
  return --readers_[at(value)] == 0 ? std::exchange(values_[at(value)], {}) : values_[at(value)];
}

Item Lane::fetch_item(const Fetch& fetch, const std::vector<int>& resets) {
  if (fetch.value >= 0) return take(fetch.value);
  Item initial = take(fetch.initial);
  Item item;
  if (fetch.line >= 0 && state_.history.lasts(frame_ - fetch.delay, frame_, resets))
    item = state_.history.find(fetch.line, frame_ - fetch.delay);
  if (fetch.ahead >= 0) item = ahead_[at(fetch.ahead)];
  // History starts anew with another size, but what lies ahead may be of a size that the pass was not asked about.
  if (fits(item, fetch.planned)) return item;
  return fetch.constant >= 0 ? state_.constants[at(fetch.constant)] : initial;
}

void Lane::fetch(int step) {
  for (const int node : nodes_of(step)) {
    if (outcome(node) == Outcome::lost) {
      take_all(node);
      continue;
    }
    const std::vector<int>& resets = state_.wiring.nodes[at(node)].resets;
    const std::vector<std::vector<Fetch>>& fetches = state_.wiring.nodes[at(node)].fetches;
    for (std::size_t port = 0; port < fetches.size(); ++port)
      for (std::size_t i = 0; i < fetches[port].size(); ++i)
        tables_.inputs[at(node)][port][i] = fetch_item(fetches[port][i], resets);
  }
}

void Lane::run(int step) {
  const auto start = Trace::Clock::now();
  try {
    compute(step);
  } catch (const Cancelled&) {
    for (const int node : nodes_of(step)) drop_inputs(node), drop_outputs(node);
    throw;
  } catch (const std::bad_alloc&) { fail(step, labels_[at(step)] + ": " + out_of_memory(pool_)); } catch (...) {
    fail(step, what_failed(pool_));
  }
  for (const int node : nodes_of(step)) {
    drop_inputs(node);
    if (outcome(node) != Outcome::done) drop_outputs(node);
  }
  if (!trace_) return;
  trace_->slice(Trace::Kind::node, labels_[at(step)], frame_, start, Trace::Clock::now());
  trace_->memory(pool_.usage());
}

void Lane::compute(int step) {
  if (auto* fused = std::get_if<FusedRunner>(&runners_[at(step)])) return fused->run(frame_, tables_);
  const std::size_t node = at(nodes_of(step).front());
  const auto start = Trace::Clock::now();
  std::get<NodeRunner>(runners_[at(step)]).run(frame_, tables_.inputs[node], tables_.outputs[node]);
  tables_.seconds[node] = std::chrono::duration<double>(Trace::Clock::now() - start).count();
  tables_.outcomes[node] = Outcome::done;
}

void Lane::fail(int step, const std::string& error) {
  for (const int node : nodes_of(step)) {
    if (outcome(node) == Outcome::lost) continue;
    outcome(node) = Outcome::failed;
    tables_.errors[at(node)] = error;
  }
}

void Lane::drop_inputs(int node) {
  for (std::vector<Item>& port : tables_.inputs[at(node)]) std::ranges::fill(port, Item());
}
void Lane::drop_outputs(int node) {
  for (std::vector<Item>& port : tables_.outputs[at(node)]) std::ranges::fill(port, Item());
}

void Lane::publish(int step) {
  for (const int node : nodes_of(step)) {
    if (outcome(node) != Outcome::done) continue;
    int value = state_.wiring.nodes[at(node)].first_output;
    for (std::size_t port = 0; port < state_.plan.nodes[at(node)].outputs.size(); ++port) {
      std::vector<Item>& items = tables_.outputs[at(node)][port];
      for (std::size_t i = 0; i < state_.plan.nodes[at(node)].outputs[port].size(); ++i, ++value) {
        Item item = std::exchange(items[i], {});
        for (const int line : state_.wiring.lines[at(value)]) state_.history.add(line, frame_, item);
        note_reset(value, item);
        if (readers_[at(value)] > 0) values_[at(value)] = std::move(item);
      }
    }
  }
}

void Lane::note_reset(int value, const Item& item) {
  const Values* numbers = item.values();
  if (!numbers || numbers->size() == 0 || *numbers->begin() == 0) return;
  for (std::size_t reset = 0; reset < state_.wiring.resets.size(); ++reset)
    if (state_.wiring.resets[reset].value == value) state_.history.reset(static_cast<int>(reset), frame_);
}

int Lane::failed_node() const {
  const auto failed = std::ranges::find(tables_.outcomes, Outcome::failed);
  return failed == tables_.outcomes.end() ? -1 : static_cast<int>(failed - tables_.outcomes.begin());
}

const std::string& Lane::name(int node) const { return state_.plan.graph->nodes[at(state_.plan.nodes[at(node)].node)].name; }

void Lane::drop_ahead() { std::ranges::fill(ahead_, Item()); }

void Lane::clear() {
  std::ranges::fill(values_, Item());
  drop_ahead();
  for (int node = 0; node < static_cast<int>(tables_.inputs.size()); ++node) drop_inputs(node), drop_outputs(node);
}

}  // namespace quell
