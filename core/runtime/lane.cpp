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
    : state_(state),
      pool_(pool),
      trace_(trace),
      values_(state.wiring.readers.size()),
      inputs_(state.plan.nodes.size()),
      outputs_(state.plan.nodes.size()),
      outcomes_(state.plan.turns.size()),
      failures_(state.plan.turns.size()),
      seconds_(state.plan.nodes.size()) {
  for (std::size_t node = 0; node < state.plan.nodes.size(); ++node)
    for (const std::vector<Fetch>& port : state.wiring.nodes[node].fetches) inputs_[node].emplace_back(port.size());
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
  std::ranges::fill(outcomes_, Outcome::pending);
  std::ranges::fill(seconds_, 0.0);
  for (std::size_t value = 0; value < inputs.items.size(); ++value) {
    for (const int line : state_.wiring.lines[value]) state_.history.add(line, frame, inputs.items[value]);
    note_reset(static_cast<int>(value), inputs.items[value]);
    if (readers_[value] > 0) values_[value] = std::move(inputs.items[value]);
  }
}

bool Lane::is_lost(int step) const {
  return std::ranges::any_of(state_.wiring.steps[at(step)].needs, [&](int needed) {
    return outcomes_[at(needed)] == Outcome::failed || outcomes_[at(needed)] == Outcome::lost;
  });
}

void Lane::skip(int step) {
  outcomes_[at(step)] = Outcome::lost;
  for (const int node : state_.plan.turns[at(step)].nodes)
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
  for (const int node : state_.plan.turns[at(step)].nodes) {
    const std::vector<int>& resets = state_.wiring.nodes[at(node)].resets;
    const std::vector<std::vector<Fetch>>& fetches = state_.wiring.nodes[at(node)].fetches;
    for (std::size_t port = 0; port < fetches.size(); ++port)
      for (std::size_t i = 0; i < fetches[port].size(); ++i) inputs_[at(node)][port][i] = fetch_item(fetches[port][i], resets);
  }
}

void Lane::run(int step) {
  const auto start = Trace::Clock::now();
  try {
    compute(step);
    outcomes_[at(step)] = Outcome::done;
  } catch (const Cancelled&) {
    drop_items(step);
    throw;
  } catch (const std::bad_alloc&) {
    fail(step, labels_[at(step)] + ": " + out_of_memory(pool_));
  } catch (...) { fail(step, what_failed(pool_)); }
  const auto end = Trace::Clock::now();
  if (const std::vector<int>& nodes = state_.plan.turns[at(step)].nodes; nodes.size() == 1)
    seconds_[at(nodes.front())] = std::chrono::duration<double>(end - start).count();
  if (outcomes_[at(step)] == Outcome::failed) drop_items(step);
  if (!trace_) return;
  trace_->slice(Trace::Kind::node, labels_[at(step)], frame_, start, end);
  trace_->memory(pool_.usage());
}

void Lane::compute(int step) {
  const std::vector<int>& nodes = state_.plan.turns[at(step)].nodes;
  if (auto* fused = std::get_if<FusedRunner>(&runners_[at(step)])) {
    fused->run(frame_, inputs_, outputs_, seconds_);
    for (const int node : nodes)
      for (std::vector<Item>& port : inputs_[at(node)]) std::ranges::fill(port, Item());
  } else {
    std::get<NodeRunner>(runners_[at(step)]).run(frame_, inputs_[at(nodes.front())], outputs_[at(nodes.front())]);
  }
}

void Lane::fail(int step, const std::string& error) {
  const auto* fused = std::get_if<FusedRunner>(&runners_[at(step)]);
  const int failed = fused ? fused->failed_node() : -1;
  const int node = failed >= 0 ? failed : state_.plan.turns[at(step)].nodes.front();
  failures_[at(step)] = {node, error};
  outcomes_[at(step)] = Outcome::failed;
}

void Lane::drop_items(int step) {
  for (const int node : state_.plan.turns[at(step)].nodes)
    for (PortItems* items : {&inputs_[at(node)], &outputs_[at(node)]})
      for (std::vector<Item>& port : *items) std::ranges::fill(port, Item());
}

void Lane::publish(int step) {
  if (outcomes_[at(step)] != Outcome::done) return;
  for (const int node : state_.plan.turns[at(step)].nodes) {
    int value = state_.wiring.nodes[at(node)].first_output;
    for (std::size_t port = 0; port < outputs_[at(node)].size(); ++port)
      for (std::size_t i = 0; i < state_.plan.nodes[at(node)].outputs[port].size(); ++i, ++value) {
        if (i >= outputs_[at(node)][port].size()) continue;
        Item item = std::exchange(outputs_[at(node)][port][i], {});
        for (const int line : state_.wiring.lines[at(value)]) state_.history.add(line, frame_, item);
        note_reset(value, item);
        if (readers_[at(value)] > 0) values_[at(value)] = std::move(item);
      }
  }
}

void Lane::note_reset(int value, const Item& item) {
  const Values* numbers = item.values();
  if (!numbers || numbers->size() == 0 || *numbers->begin() == 0) return;
  for (std::size_t reset = 0; reset < state_.wiring.resets.size(); ++reset)
    if (state_.wiring.resets[reset].value == value) state_.history.reset(static_cast<int>(reset), frame_);
}

int Lane::failed_step() const {
  const auto failed = std::ranges::find(outcomes_, Outcome::failed);
  return failed == outcomes_.end() ? -1 : static_cast<int>(failed - outcomes_.begin());
}

const std::string& Lane::name(int node) const { return state_.plan.graph->nodes[at(state_.plan.nodes[at(node)].node)].name; }

void Lane::drop_ahead() { std::ranges::fill(ahead_, Item()); }

void Lane::clear() {
  std::ranges::fill(values_, Item());
  drop_ahead();
  for (std::size_t step = 0; step < outcomes_.size(); ++step) drop_items(static_cast<int>(step));
}

}  // namespace quell
