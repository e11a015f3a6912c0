// The arithmetic of the passes that tests of schedules are made of: integers modulo a prime, which floats hold exactly. Whatever
// is computed from the wrong frame, twice or not at all shows in the result, and no rounding hides or makes a difference.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>

#include "quell/sdk/pass.h"

namespace quell::ring {

constexpr std::int64_t kModulus = 4093;

inline float wrap(std::int64_t number) { return static_cast<float>(number % kModulus); }
inline std::int64_t number(double value) { return static_cast<std::int64_t>(value); }

/// A pixel, of the last plane where the image has fewer.
inline std::int64_t at(const FloatImage& image, int x, int y, int c) {
  return number(image.at(x, y, std::min(c, image.channels - 1)));
}

/// Takes a little while now and then, so that nodes of equal cost do not always end in the same order.
inline void dawdle(const Frame& frame, const void* buffer) {
  const auto draw = reinterpret_cast<std::uintptr_t>(buffer) / 64 + static_cast<std::uintptr_t>(frame.number()) * 0x9e3779b9u;
  if (draw % 13 == 0) std::this_thread::sleep_for(std::chrono::microseconds(20 * (draw % 7)));
}

/// out(x, y, c) = wrap(pixel(x, y, c)), in parallel.
template <class Pixel>
void fill(const Frame& frame, const FloatOutput& out, const Pixel& pixel) {
  dawdle(frame, out.data);
  frame.parallel_rows(out.height, [&](int y0, int y1) {
    for (int c = 0; c < out.channels; ++c)
      for (int y = y0; y < y1; ++y)
        for (int x = 0; x < out.width; ++x) out.at(x, y, c) = wrap(pixel(x, y, c));
  });
}

}  // namespace quell::ring
