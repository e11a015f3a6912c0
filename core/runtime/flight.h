// The frames in flight: which of their nodes may run, and what memory they are charged.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "quell/runtime/plan_state.h"
#include "quell/runtime/window.h"

namespace quell {

/// A step of a frame. The earliest frame comes first, then the plan's order.
struct FrameStep {
  std::size_t index = 0;  ///< of the frame, counted from the run's first
  int step = 0;           ///< position in Plan::turns
  auto operator<=>(const FrameStep&) const = default;
};

/// A node waits for the nodes that it reads, in its own frame and in earlier ones; when none is left it goes into a heap, the
/// earliest frame on top.
///
/// A frame in flight is charged what it takes when its nodes run in the plan's order. A node that runs ahead of that order is
/// charged for what it writes, too, until the frame has caught up with it. The sum stays within the limit; the first unfinished
/// node of a frame is never refused, so that nothing can stall.
///
/// Frames are admitted, begun and retired in order: retired() <= begun() <= admitted(). Not thread-safe, takes no time.
class Flight {
 public:
  explicit Flight(const std::vector<std::int64_t>& frames) : frames_(frames) {}
  /// Before the first frame is admitted, and again while none is between begin() and retire(); of those that are admitted, only
  /// as many stay so as the new window has room for.
  void use(const PlanState& state, const Window& window, int threads);

  std::size_t retired() const { return retired_; }
  std::size_t begun() const { return begun_; }
  std::size_t admitted() const { return admitted_; }
  /// Distinct for the frames in flight.
  std::size_t place(std::size_t index) const { return index % in_flight_.size(); }
  std::size_t places() const { return in_flight_.size(); }

  bool may_admit() const;
  void admit();
  /// The nodes of the next frame wait from now on; nobody has to wait for one that cannot be read.
  void begin(bool is_readable);
  /// How many nodes may run now; more than there is memory for, perhaps, but 0 only when there is none.
  std::size_t ready();
  /// The first of them that there is memory for; it is charged and counts as running.
  std::optional<FrameStep> take();
  /// True when it was the last node of its frame.
  bool complete(const FrameStep& node);
  /// From now on the frame holds nothing but its results and its part of the history, or nothing at all.
  void hold(std::size_t index, bool results);
  /// The earliest frame is through.
  void retire();

 private:
  struct InFlight {
    std::size_t charge = 0;           // for the whole frame
    std::vector<std::size_t> extras;  // for each step that ran ahead of the plan's order
    std::vector<int> waits;           // of each step: how many others it waits for
    std::vector<char> ready;          // each step: waits for nothing but its turn
    std::vector<char> done;           // each step
    std::size_t first_undone = 0, undone = 0;
  };
  InFlight& flying(std::size_t index) { return in_flight_[place(index)]; }
  bool is_undone(std::int64_t frame, int step);
  int count_undone_since(std::int64_t frame, int step);
  void wake(std::size_t index, int step);
  std::size_t price(const FrameStep& node);
  std::optional<FrameStep> best();
  std::optional<FrameStep> next_in_order();
  void release(std::size_t& charge);

  const std::vector<std::int64_t>& frames_;
  const Wiring* wiring_ = nullptr;
  Window window_;
  std::vector<std::size_t> step_bytes_;  // what each step takes by itself
  std::size_t held_bytes_ = 0, history_bytes_ = 0;
  std::size_t charged_ = 0;
  std::vector<InFlight> in_flight_;  // a ring
  std::size_t retired_ = 0, begun_ = 0, admitted_ = 0;
  std::vector<FrameStep> heap_;  // of what is ready, and some that have been taken out of turn
  std::size_t ready_ = 0;        // nodes
};

}  // namespace quell
