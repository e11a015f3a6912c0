#include "quell/runtime/flight.h"

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

namespace quell {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

std::size_t add(std::size_t a, std::size_t b) { return a > SIZE_MAX - b ? SIZE_MAX : a + b; }

std::size_t bytes_of_step(const Plan& plan, std::size_t step, int threads) {
  std::size_t bytes = thread_memory(plan, step, threads);
  for (const int position : plan.turns[step].nodes) {
    const PlannedNode& planned = plan.nodes[at(position)];
    bytes = add(bytes, planned.scratch_bytes);
    for (std::size_t port = 0; port < planned.outputs.size(); ++port)
      for (std::size_t item = 0; item < planned.outputs[port].size(); ++item)
        if (const Endpoint endpoint{planned.node, static_cast<int>(port), static_cast<int>(item)}; !plan.is_inner(endpoint))
          bytes = add(bytes, plan.bytes(endpoint));
  }
  return bytes;
}

}  // namespace

void Flight::use(const PlanState& state, const Window& window, int threads) {
  wiring_ = &state.wiring;
  window_ = window;
  step_bytes_.clear();
  for (std::size_t step = 0; step < state.plan.turns.size(); ++step)
    step_bytes_.push_back(bytes_of_step(state.plan, step, threads));

  std::set<Endpoint> kept;
  history_bytes_ = 0;
  for (const PlannedHistory& history : state.plan.histories)
    if (kept.insert(history.from).second) history_bytes_ = add(history_bytes_, history.bytes_per_frame);
  held_bytes_ = history_bytes_;
  for (const PlannedResult& result : state.plan.results())
    if (kept.insert(result.from).second) held_bytes_ = add(held_bytes_, state.plan.bytes(result.from));

  in_flight_.assign(std::clamp<std::size_t>(frames_.size(), 1, static_cast<std::size_t>(window.frames)), {});
  for (InFlight& frame : in_flight_) {
    frame.extras.resize(step_bytes_.size());
    frame.waits.resize(step_bytes_.size());
    frame.ready.resize(step_bytes_.size());
    frame.done.resize(step_bytes_.size());
  }
  heap_.clear();
  heap_.reserve(in_flight_.size() * step_bytes_.size());
  ready_ = 0;
  charged_ = window.fixed_bytes;
  const std::size_t were_admitted = std::exchange(admitted_, retired_);
  while (admitted_ < were_admitted && may_admit()) admit();
}

bool Flight::may_admit() const {
  if (admitted_ == frames_.size() || admitted_ - retired_ == static_cast<std::size_t>(window_.frames)) return false;
  return admitted_ == retired_ || add(charged_, window_.bytes_per_frame) <= window_.memory;
}

void Flight::admit() { charged_ += flying(admitted_++).charge = window_.bytes_per_frame; }

bool Flight::is_undone(std::int64_t frame, int step) {
  for (std::size_t index = retired_; index < begun_; ++index)
    if (frames_[index] == frame) return !flying(index).done[at(step)];
  return false;
}

// In how many of the frames after `frame` the step is not done.
int Flight::count_undone_since(std::int64_t frame, int step) {
  int count = 0;
  for (std::size_t index = retired_; index < begun_; ++index)
    if (frames_[index] > frame && !flying(index).done[at(step)]) ++count;
  return count;
}

void Flight::begin(bool is_readable) {
  const std::size_t index = begun_;
  InFlight& frame = flying(index);
  std::ranges::fill(frame.done, !is_readable);
  std::ranges::fill(frame.ready, 0);
  frame.first_undone = is_readable ? 0 : step_bytes_.size();
  frame.undone = is_readable ? step_bytes_.size() : 0;
  for (std::size_t step = 0; is_readable && step < wiring_->steps.size(); ++step) {
    const WiredStep& wired = wiring_->steps[step];
    frame.waits[step] = static_cast<int>(wired.needs.size());
    for (const DelayedWait& wait : wired.waits)
      if (is_undone(frames_[index] - wait.delay, wait.step)) ++frame.waits[step];
    for (const DelayedWait& wait : wired.reset_waits)
      frame.waits[step] += count_undone_since(frames_[index] - wait.delay, wait.step);
    ++frame.waits[step];  // for the frame itself
    wake(index, static_cast<int>(step));
  }
  ++begun_;
}

void Flight::wake(std::size_t index, int step) {
  InFlight& frame = flying(index);
  if (frame.done[at(step)] || --frame.waits[at(step)] > 0) return;  // done: of a frame that cannot be read
  frame.ready[at(step)] = 1;
  ++ready_;
  heap_.push_back({index, step});
  std::ranges::push_heap(heap_, std::greater<>());
}

// A node in its turn costs nothing beside what its frame was charged.
std::size_t Flight::price(const FrameStep& node) {
  return at(node.step) == flying(node.index).first_undone ? 0 : step_bytes_[at(node.step)];
}

std::optional<FrameStep> Flight::best() {
  const auto is_taken = [&](const FrameStep& node) { return node.index < retired_ || !flying(node.index).ready[at(node.step)]; };
  while (!heap_.empty() && is_taken(heap_.front())) {
    std::ranges::pop_heap(heap_, std::greater<>());
    heap_.pop_back();
  }
  return heap_.empty() ? std::nullopt : std::optional(heap_.front());
}

// The earliest node that is its frame's first unfinished one.
std::optional<FrameStep> Flight::next_in_order() {
  for (std::size_t index = retired_; index < begun_; ++index) {
    const InFlight& frame = flying(index);
    if (frame.first_undone < frame.ready.size() && frame.ready[frame.first_undone])
      return FrameStep{index, static_cast<int>(frame.first_undone)};
  }
  return std::nullopt;
}

std::size_t Flight::ready() {
  const std::optional<FrameStep> first = best();
  if (!first) return 0;
  if (add(charged_, price(*first)) <= window_.memory) return ready_;
  return next_in_order() ? 1 : 0;
}

std::optional<FrameStep> Flight::take() {
  std::optional<FrameStep> node = best();
  if (node && add(charged_, price(*node)) > window_.memory) node = next_in_order();
  if (!node) return std::nullopt;
  InFlight& frame = flying(node->index);
  charged_ += frame.extras[at(node->step)] = price(*node);
  frame.ready[at(node->step)] = 0;
  --ready_;
  return node;
}

void Flight::release(std::size_t& charge) { charged_ -= std::exchange(charge, 0); }

bool Flight::complete(const FrameStep& node) {
  InFlight& frame = flying(node.index);
  frame.done[at(node.step)] = 1;
  --frame.undone;
  while (frame.first_undone < frame.done.size() && frame.done[frame.first_undone]) release(frame.extras[frame.first_undone++]);
  const WiredStep& wired = wiring_->steps[at(node.step)];
  for (const int fed : wired.feeds) wake(node.index, fed);
  for (const DelayedWait& waiting : wired.awaited_by)
    for (std::size_t index = node.index + 1; index < begun_; ++index)
      if (frames_[index] == frames_[node.index] + waiting.delay) wake(index, waiting.step);
  for (const DelayedWait& waiting : wired.resets_for)
    for (std::size_t index = node.index + 1; index < begun_; ++index)
      if (frames_[index] < frames_[node.index] + waiting.delay) wake(index, waiting.step);
  return frame.undone == 0;
}

void Flight::hold(std::size_t index, bool results) {
  InFlight& frame = flying(index);
  release(frame.charge);
  charged_ += frame.charge = results ? held_bytes_ : history_bytes_;
}

void Flight::retire() { release(flying(retired_++).charge); }

}  // namespace quell
