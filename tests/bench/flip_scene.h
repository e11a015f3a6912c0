// Pictures to measure FLIP with, and how long it takes beside plain loops.
#pragma once

#include "quell/image/image.h"
#include "quell/metrics/flip.h"

namespace quell::bench {

/// A picture of edges, shading and noise, and the same with errors; radiance up to about 10.
struct FlipScene {
  Image reference, image;
  FlipImages views() const { return {reference.floats(), image.floats(), {}}; }
};
FlipScene make_flip_scene(Size size, BufferPool& pool);

/// `threads` at a time.
Parallel on_threads(int threads);

/// Seconds of plain_flip() and of flip().
struct FlipTimes {
  double plain = 0, quell = 0;
};
/// With the same threads, each the least of several that were taken in turn, so that a machine that is busy now and then slows
/// both. Throws std::runtime_error when their figures differ.
FlipTimes best_flip_times(Size size, int threads);

}  // namespace quell::bench
