// How many frames a run works on at a time.
#pragma once

#include <cstddef>
#include <string>

#include "quell/graph/plan.h"

namespace quell {

/// Bytes that this process may have: the machine's memory, or less where a control group says so.
std::size_t available_memory();

struct Window {
  int frames = 1;                   ///< most frames in flight, from reading to writing
  std::size_t memory = 0;           ///< most bytes that the pool may hold
  std::size_t bytes_per_frame = 0;  ///< what each frame in flight is charged
  std::size_t fixed_bytes = 0;      ///< history and constants, whatever the number of frames
  std::string reason;               ///< what decided: "asked for", "2 threads", "memory", "a loop of 1 frame"
};

/// `frames` and `memory` as in SessionOptions, `threads` the actual number. Throws Error(memory) when not even one frame fits.
Window choose_window(const Plan& plan, int threads, int frames, std::size_t memory);

}  // namespace quell
