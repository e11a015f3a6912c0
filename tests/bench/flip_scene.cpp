#include "tests/bench/flip_scene.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "tests/bench/flip_plain.h"

namespace quell::bench {
namespace {

double noise(int x, int y, int c) {
  unsigned h =
      static_cast<unsigned>(x) * 374761393u + static_cast<unsigned>(y) * 668265263u + static_cast<unsigned>(c) * 2246822519u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return static_cast<double>((h ^ (h >> 16)) & 0xffffff) / 0x1000000;
}

double radiance(int x, int y, int c) {
  if ((x / 37 + y / 29) % 3 == 0) return 0.1 + 0.2 * c;
  return 0.5 + 0.4 * std::sin(0.02 * x + c) * std::cos(0.03 * y) + (x % 97 == 5 && y % 83 == 7 ? 9 : 0);
}

double seconds(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

FlipScene make_flip_scene(Size size, BufferPool& pool) {
  FlipScene scene{Image(QUELL_TYPE_COLOR, size, pool), Image(QUELL_TYPE_COLOR, size, pool)};
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const double value = radiance(x, y, c);
        scene.reference.writable_floats().at(x, y, c) = static_cast<float>(value);
        scene.image.writable_floats().at(x, y, c) = static_cast<float>(value * (0.8 + 0.4 * noise(x, y, c)));
      }
  return scene;
}

Parallel on_threads(int threads) {
  return [=](int count, const std::function<void(int i)>& body) {
    std::atomic<int> next = 0;
    const auto work = [&] {
      for (int i = next++; i < count; i = next++) body(i);
    };
    std::vector<std::jthread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back(work);
    work();
  };
}

namespace {

FlipTimes time_flip(const FlipScene& scene, int threads, BufferPool& pool) {
  const Parallel parallel = on_threads(threads);
  Image map(QUELL_TYPE_SCALAR, scene.image.size(), pool);
  Score want, have;
  FlipTimes times;
  times.plain = seconds([&] { want = plain_flip(scene.views(), kPixelsPerDegree, map.writable_floats(), parallel); });
  times.quell = seconds([&] { have = flip(scene.views(), kPixelsPerDegree, map.writable_floats(), pool, parallel); });
  if (std::abs(want.sum - have.sum) > 1e-4 * want.sum) throw std::runtime_error("flip() differs from plain loops");
  return times;
}

}  // namespace

FlipTimes best_flip_times(Size size, int threads) {
  constexpr int kRepeats = 5;
  BufferPool pool;
  const FlipScene scene = make_flip_scene(size, pool);
  FlipTimes best = time_flip(scene, threads, pool);
  for (int i = 1; i < kRepeats; ++i) {
    const FlipTimes times = time_flip(scene, threads, pool);
    best = {std::min(best.plain, times.plain), std::min(best.quell, times.quell)};
  }
  return best;
}

}  // namespace quell::bench
