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
      outcomes_(state.plan.nodes.size()),
      errors_(state.plan.nodes.size()),
      seconds_(state.plan.nodes.size()) {
  for (std::size_t step = 0; step < state.plan.nodes.size(); ++step) {
    const PlannedNode& planned = state.plan.nodes[step];
    const Node& node = state.plan.graph->nodes[at(planned.node)];
    runners_.emplace_back(node.name, *node.instance,
                          NodeLayout{planned.outputs, planned.in_place_of, planned.scratch_bytes, planned.slot_scratch_bytes},
                          services, pool);
    for (const std::vector<Fetch>& port : state.wiring.steps[step].fetches) inputs_[step].emplace_back(port.size());
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
  for (const std::vector<Fetch>& port : state_.wiring.steps[at(step)].fetches)
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
  const std::vector<int>& resets = state_.wiring.steps[at(step)].resets;
  const std::vector<std::vector<Fetch>>& fetches = state_.wiring.steps[at(step)].fetches;
  for (std::size_t port = 0; port < fetches.size(); ++port)
    for (std::size_t i = 0; i < fetches[port].size(); ++i) inputs_[at(step)][port][i] = fetch_item(fetches[port][i], resets);
}

void Lane::run(int step) {
  const auto start = Trace::Clock::now();
  try {
    runners_[at(step)].run(frame_, inputs_[at(step)], outputs_[at(step)]);
    outcomes_[at(step)] = Outcome::done;
  } catch (const Cancelled&) {
    drop_inputs(step);
    throw;
  } catch (const std::bad_alloc&) {
    errors_[at(step)] = name(step) + ": " + out_of_memory(pool_);
    outcomes_[at(step)] = Outcome::failed;
  } catch (...) {
    errors_[at(step)] = what_failed(pool_);
    outcomes_[at(step)] = Outcome::failed;
  }
  const auto end = Trace::Clock::now();
  seconds_[at(step)] = std::chrono::duration<double>(end - start).count();
  if (outcomes_[at(step)] == Outcome::failed) drop_inputs(step);
  if (!trace_) return;
  trace_->slice(Trace::Kind::node, name(step), frame_, start, end);
  trace_->memory(pool_.usage());
}

void Lane::drop_inputs(int step) {
  for (PortItems* items : {&inputs_[at(step)], &outputs_[at(step)]})
    for (std::vector<Item>& port : *items) std::ranges::fill(port, Item());
}

void Lane::publish(int step) {
  if (outcomes_[at(step)] != Outcome::done) return;
  int value = state_.wiring.steps[at(step)].first_output;
  for (std::vector<Item>& port : outputs_[at(step)])
    for (Item& output : port) {
      Item item = std::exchange(output, {});
      for (const int line : state_.wiring.lines[at(value)]) state_.history.add(line, frame_, item);
      note_reset(value, item);
      if (readers_[at(value)] > 0) values_[at(value)] = std::move(item);
      ++value;
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

const std::string& Lane::name(int step) const { return state_.plan.graph->nodes[at(state_.plan.nodes[at(step)].node)].name; }

void Lane::drop_ahead() { std::ranges::fill(ahead_, Item()); }

void Lane::clear() {
  std::ranges::fill(values_, Item());
  drop_ahead();
  for (std::size_t step = 0; step < inputs_.size(); ++step) drop_inputs(static_cast<int>(step));
}

}  // namespace quell
