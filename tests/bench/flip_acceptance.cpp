#include <cstdio>

#include "tests/bench/figure.h"
#include "tests/bench/flip_scene.h"

namespace quell::bench {
namespace {

Figure speedup(int threads) {
  const FlipTimes times = best_flip_times({1920, 1080}, threads);
  char note[80];
  std::snprintf(note, sizeof(note), "%.0f ms instead of %.0f", times.quell * 1e3, times.plain * 1e3);
  return {.what = "1920x1080, threads: " + std::to_string(threads) + ", times as fast as plain loops",
          .reached = times.plain / times.quell,
          .bar = 5,
          .note = note};
}

}  // namespace

std::vector<Figure> flip_figures() {
  std::vector<Figure> figures{speedup(1)};
  if (acceptance_threads() > 1) figures.push_back(speedup(acceptance_threads()));
  return figures;
}

}  // namespace quell::bench
