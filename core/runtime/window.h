// How many frames a run works on at a time.
#pragma once

#include <cstddef>
#include <string>

#include "quell/graph/plan.h"

namespace quell {

/// Bytes that this process may have: the machine's memory, or less where a control group says so.
std::size_t available_memory();

/// What all threads together need for themselves while a step, a position in Plan::turns, runs: scratch memory, and the windows
/// of fused nodes.
std::size_t thread_memory(const Plan& plan, std::size_t step, int threads);

struct Window {
  int frames = 1;                   ///< most frames in flight, from reading to writing
  std::size_t memory = 0;           ///< most bytes that the pool may hold
  std::size_t bytes_per_frame = 0;  ///< what each frame in flight is charged
  std::size_t fixed_bytes = 0;      ///< history and constants, whatever the number of frames
  std::string reason;               ///< what decided: "as asked for", "2 threads", "what the memory limit has room for"
};

/// `frames`, `memory` and `reserved` as in SessionOptions, `threads` the actual number. Throws Error(memory) when not even one
/// frame fits.
Window choose_window(const Plan& plan, int threads, int frames, std::size_t memory, std::size_t reserved = 0);

}  // namespace quell
