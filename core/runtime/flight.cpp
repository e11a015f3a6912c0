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
  const PlannedNode& planned = plan.nodes[step];
  std::size_t bytes = add(planned.scratch_bytes, slot_scratch(plan, step, threads));
  for (std::size_t port = 0; port < planned.outputs.size(); ++port)
    for (std::size_t item = 0; item < planned.outputs[port].size(); ++item)
      bytes = add(bytes, plan.bytes({planned.node, static_cast<int>(port), static_cast<int>(item)}));
  return bytes;
}

}  // namespace

void Flight::use(const PlanState& state, const Window& window, int threads) {
  wiring_ = &state.wiring;
  window_ = window;
  step_bytes_.clear();
  for (std::size_t step = 0; step < state.plan.nodes.size(); ++step)
    step_bytes_.push_back(bytes_of_step(state.plan, step, threads));

  std::set<Endpoint> kept;
  history_bytes_ = 0;
  for (const PlannedHistory& history : state.plan.histories)
    if (history.frames > 0 && kept.insert(history.from).second) history_bytes_ = add(history_bytes_, history.bytes_per_frame);
  held_bytes_ = history_bytes_;
  for (const PlannedResult& result : state.plan.results())
    if (kept.insert(result.from).second) held_bytes_ = add(held_bytes_, state.plan.bytes(result.from));

  in_flight_.assign(static_cast<std::size_t>(window.frames), {});
  for (InFlight& frame : in_flight_) {
    frame.extras.resize(step_bytes_.size());
    frame.waits.resize(step_bytes_.size());
    frame.done.resize(step_bytes_.size());
  }
  ready_.clear();
  ready_.reserve(in_flight_.size() * step_bytes_.size());
  refused_.reserve(in_flight_.size() * step_bytes_.size());
  charged_ = window.fixed_bytes;
  const std::size_t were_admitted = std::exchange(admitted_, retired_);
  while (admitted_ < were_admitted && may_admit()) admit();
}

bool Flight::may_admit() const {
  if (admitted_ == frames_.size() || admitted_ - retired_ == static_cast<std::size_t>(window_.frames)) return false;
  return admitted_ == retired_ || add(charged_, window_.bytes_per_frame) <= window_.memory;
}

void Flight::admit() { charged_ += at(admitted_++).charge = window_.bytes_per_frame; }

bool Flight::is_undone(std::int64_t frame, int step) {
  for (std::size_t index = retired_; index < begun_; ++index)
    if (frames_[index] == frame) return !at(index).done[quell::at(step)];
  return false;
}

void Flight::begin(bool is_readable) {
  const std::size_t index = begun_;
  InFlight& frame = at(index);
  std::ranges::fill(frame.done, !is_readable);
  frame.first_undone = is_readable ? 0 : step_bytes_.size();
  frame.undone = is_readable ? step_bytes_.size() : 0;
  for (std::size_t step = 0; is_readable && step < wiring_->steps.size(); ++step) {
    const WiredStep& wired = wiring_->steps[step];
    frame.waits[step] = static_cast<int>(wired.needs.size());
    for (const DelayedWait& wait : wired.waits)
      if (is_undone(frames_[index] - wait.delay, wait.step)) ++frame.waits[step];
    ++frame.waits[step];  // for the frame itself
    wake(index, static_cast<int>(step));
  }
  ++begun_;
}

void Flight::wake(std::size_t index, int step) {
  InFlight& frame = at(index);
  if (frame.done[quell::at(step)] || --frame.waits[quell::at(step)] > 0) return;  // done: of a frame that cannot be read
  ready_.push_back({index, step});
  std::ranges::push_heap(ready_, std::greater<>());
}

std::optional<FrameStep> Flight::take() {
  std::optional<FrameStep> taken;
  while (!taken && !ready_.empty()) {
    std::ranges::pop_heap(ready_, std::greater<>());
    const FrameStep best = ready_.back();
    ready_.pop_back();
    if (charge_for(best))
      taken = best;
    else
      refused_.push_back(best);
  }
  for (const FrameStep& node : refused_) {
    ready_.push_back(node);
    std::ranges::push_heap(ready_, std::greater<>());
  }
  refused_.clear();
  return taken;
}

bool Flight::charge_for(const FrameStep& node) {
  InFlight& frame = at(node.index);
  if (quell::at(node.step) == frame.first_undone) return true;
  const std::size_t bytes = step_bytes_[quell::at(node.step)];
  if (add(charged_, bytes) > window_.memory) return false;
  charged_ += frame.extras[quell::at(node.step)] = bytes;
  return true;
}

void Flight::release(std::size_t& charge) { charged_ -= std::exchange(charge, 0); }

bool Flight::complete(const FrameStep& node) {
  InFlight& frame = at(node.index);
  frame.done[quell::at(node.step)] = 1;
  --frame.undone;
  while (frame.first_undone < frame.done.size() && frame.done[frame.first_undone]) release(frame.extras[frame.first_undone++]);
  const WiredStep& wired = wiring_->steps[quell::at(node.step)];
  for (const int fed : wired.feeds) wake(node.index, fed);
  for (const DelayedWait& waiting : wired.awaited_by)
    for (std::size_t index = node.index + 1; index < begun_; ++index)
      if (frames_[index] == frames_[node.index] + waiting.delay) wake(index, waiting.step);
  return frame.undone == 0;
}

void Flight::hold(std::size_t index, bool results) {
  InFlight& frame = at(index);
  release(frame.charge);
  charged_ += frame.charge = results ? held_bytes_ : history_bytes_;
}

void Flight::retire() { release(at(retired_++).charge); }

}  // namespace quell
