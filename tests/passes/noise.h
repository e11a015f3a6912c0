// Repeatable noise and a slanted scene with holes and an edge, for tests that compare a pass with its formula.
#pragma once

#include <cmath>
#include <cstdint>

#include "quell/sdk/abi.h"

namespace quell::scene {

/// 0 to 1.
inline double noise(int x, int y, int seed) {
  unsigned h =
      static_cast<unsigned>(x) * 374761393U + static_cast<unsigned>(y) * 668265263U + static_cast<unsigned>(seed) * 2246822519U;
  h = (h ^ (h >> 13)) * 1274126177U;
  return static_cast<double>((h ^ (h >> 16)) & 0xffffff) / 0x1000000;
}

inline bool is_hole(int x, int y) { return (x / 4 + y / 3) % 6 == 5; }
inline float color(int x, int y, int c) { return static_cast<float>(2 * noise(x, y, c)); }
/// A little different everywhere, and far off at some pixels.
inline float other_color(int x, int y, int c) {
  return static_cast<float>(0.8 * color(x, y, c) + 0.5 * noise(x, y, c + 20) + (x % 7 == 3 ? 3 : 0));
}
inline float length(int x, int y, int) { return static_cast<float>(1 + static_cast<int>(8 * noise(x, y, 5))); }
inline float depth(int x, int y, int) {
  return is_hole(x, y) ? QUELL_NO_SURFACE_DEPTH
                       : static_cast<float>(5 + 0.1 * x + 0.05 * y + 0.02 * noise(x, y, 6) + (x > 20 ? 4 : 0));
}
inline float gradient(int x, int y, int) { return x == 9 ? 0.0F : static_cast<float>(0.05 + 0.1 * noise(x, y, 7)); }
inline float normal(int x, int y, int c) {
  const double a = 0.3 * noise(x, y, 8) + (y > 9 ? 0.5 : 0);
  return static_cast<float>(c == 0 ? std::sin(a) : c == 2 ? std::cos(a) : 0);
}
inline std::uint32_t id(int x, int y) { return x > 28 && y > 4 ? 2 : 1; }

}  // namespace quell::scene
