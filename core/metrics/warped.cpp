#include "quell/metrics/warped.h"

#include <array>
#include <cmath>
#include <optional>

#include "quell/metrics/bands.h"

namespace quell::detail {
namespace {

// The four pixels around a place, and their weights.
struct Fetch {
  std::array<std::ptrdiff_t, 4> at;
  std::array<double, 4> weights;

  double of(const float* plane) const {
    const auto tap = [&](std::size_t i) { return weights[i] * static_cast<double>(plane[at[i]]); };
    return (tap(0) + tap(1)) + (tap(2) + tap(3));
  }
};

// Nothing outside of the image. Images have one layout of rows (see prepare()), `like` is any of them.
std::optional<Fetch> fetch_at(double x, double y, FloatImage like) {
  if (!(x >= 0 && y >= 0 && x <= like.width - 1 && y <= like.height - 1)) return std::nullopt;  // nor NaN
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const double fx = x - x0, fy = y - y0;
  const std::ptrdiff_t right = x0 + 1 < like.width ? 1 : 0, down = y0 + 1 < like.height ? like.row_stride : 0;
  const std::ptrdiff_t first = y0 * like.row_stride + x0;
  return Fetch{{first, first + right, first + down, first + down + right},
               {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

bool counts_all(const Fetch& fetch, FloatImage counts) {
  const auto counts_tap = [&](std::size_t i) { return counts.data[fetch.at[i]] != 0.0F || fetch.weights[i] == 0; };
  return counts_tap(0) && counts_tap(1) && counts_tap(2) && counts_tap(3);
}

Score warped_row(const Shown& now, const Shown& before, FloatImage motion, int y) {
  Score score;
  for (int x = 0; x < now.counts.width; ++x) {
    if (now.counts.at(x, y) == 0.0F) continue;
    const double dx = motion ? static_cast<double>(motion.at(x, y, 0)) : 0,
                 dy = motion ? static_cast<double>(motion.at(x, y, 1)) : 0;
    const std::optional<Fetch> fetch = fetch_at(x + dx, y + dy, now.reference);
    if (!fetch || !counts_all(*fetch, before.counts)) continue;
    double error = 0;
    for (int c = 0; c < 3; ++c) {
      const double image = static_cast<double>(now.image.at(x, y, c)) - fetch->of(before.image.row(0, c));
      const double reference = static_cast<double>(now.reference.at(x, y, c)) - fetch->of(before.reference.row(0, c));
      error += std::abs(image) - std::abs(reference);
    }
    score += {error / 3, 1};
  }
  return score;
}

}  // namespace

Score warped_errors(const Shown& now, const Shown& before, FloatImage motion, const Parallel& parallel) {
  return sum_bands<Score>(now.counts.height, parallel, [&](int y0, int y1) {
    Score score;
    for (int y = y0; y < y1; ++y) score += warped_row(now, before, motion, y);
    return score;
  });
}

}  // namespace quell::detail
