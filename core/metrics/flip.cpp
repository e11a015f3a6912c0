#include "quell/metrics/flip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "quell/metrics/flip_filters.h"
#include "quell/metrics/flip_kernel.h"
#include "quell/text/error.h"

namespace quell {
namespace {

using flip_kernel::kTileHeight;
using flip_kernel::kTileWidth;
using flip_kernel::Tile;
using flip_kernel::Weights;

int tiles_across(int width) { return (width + kTileWidth - 1) / kTileWidth; }

Tile make_tile(const FlipImages& images, int i) {
  Tile tile{.reference = images.reference, .image = images.image};
  tile.x = i % tiles_across(tile.image.width) * kTileWidth;
  tile.y = i / tiles_across(tile.image.width) * kTileHeight;
  tile.width = std::min(kTileWidth, tile.image.width - tile.x);
  tile.height = std::min(kTileHeight, tile.image.height - tile.y);
  return tile;
}

// A row's sum, in four parts, so that additions need not wait for each other.
double sum_of(const float* errors, int count) {
  std::array<double, 4> sums{};
  for (int x = 0; x < count; ++x) sums[static_cast<std::size_t>(x % 4)] += errors[x];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

Score score_of_row(const float* errors, const float* counts, int count) {
  if (counts == nullptr) return {.sum = sum_of(errors, count), .count = static_cast<std::uint64_t>(count)};
  Score score;
  for (int x = 0; x < count; ++x) {
    if (counts[x] == 0) continue;
    score.sum += errors[x];
    ++score.count;
  }
  return score;
}

Score finish_tile(const Tile& tile, const float* errors, FloatImage counts, FloatOutput map) {
  Score score;
  for (int i = 0; i < tile.height; ++i, errors += kTileWidth) {
    if (map) std::copy_n(errors, tile.width, map.row(tile.y + i) + tile.x);
    score += score_of_row(errors, counts ? counts.row(tile.y + i) + tile.x : nullptr, tile.width);
  }
  return score;
}

using FillErrors = std::function<void(const Tile& tile, float* scratch)>;

Score for_tiles(const FlipImages& images, int radius, const FillErrors& fill_errors, FloatOutput map, BufferPool& pool,
                const Parallel& parallel) {
  const int rows = (images.reference.height + kTileHeight - 1) / kTileHeight;
  std::vector<Score> scores(static_cast<std::size_t>(rows * tiles_across(images.reference.width)));
  parallel(static_cast<int>(scores.size()), [&](int i) {
    const Buffer buffer = pool.acquire(flip_kernel::scratch_size(radius) * sizeof(float));
    auto* const scratch = static_cast<float*>(buffer.data());
    const Tile tile = make_tile(images, i);
    fill_errors(tile, scratch);
    scores[static_cast<std::size_t>(i)] = finish_tile(tile, scratch, images.counts, map);
  });
  Score total;
  for (const Score& score : scores) total += score;
  return total;
}

// More than the range of float, of 277 stops, asks for.
constexpr int kMostExposures = 1000, kMostStops = 1000;

// Radiance is multiplied with them. One that float cannot hold shows everything white all the same.
std::vector<float> gains_of(const Exposures& exposures) {
  if (exposures.count < 1 || exposures.count > kMostExposures)
    throw Error(Fault::usage, "exposures",
                std::to_string(exposures.count) + " of them; there has to be at least one, and at most " +
                    std::to_string(kMostExposures));
  for (const double stop : {exposures.start, exposures.stop})
    if (!(std::abs(stop) <= kMostStops))
      throw Error(
          Fault::usage, "exposures",
          std::to_string(stop) + " stops are not within -" + std::to_string(kMostStops) + ".." + std::to_string(kMostStops));
  std::vector<float> gains;
  const double step = exposures.count > 1 ? (exposures.stop - exposures.start) / (exposures.count - 1) : 0;
  for (int i = 0; i < exposures.count; ++i) {
    const double gain = std::exp2(exposures.start + i * step);
    gains.push_back(static_cast<float>(std::min(gain, static_cast<double>(std::numeric_limits<float>::max()))));
  }
  gains.erase(std::unique(gains.begin(), gains.end()), gains.end());  // the same picture again has no other errors
  return gains;
}

}  // namespace

Score flip(const FlipImages& images, double pixels_per_degree, FloatOutput map, BufferPool& pool, const Parallel& parallel) {
  const Weights weights{FlipFilters(pixels_per_degree)};
  return for_tiles(
      images, weights.radius, [&](const Tile& tile, float* scratch) { flip_kernel::display_errors(tile, weights, scratch); }, map,
      pool, parallel);
}

Score hdr_flip(const FlipImages& images, const Exposures& exposures, double pixels_per_degree, FloatOutput map, BufferPool& pool,
               const Parallel& parallel) {
  const Weights weights{FlipFilters(pixels_per_degree)};
  const std::vector<float> gains = gains_of(exposures);
  return for_tiles(
      images, weights.radius,
      [&](const Tile& tile, float* scratch) { flip_kernel::radiance_errors(tile, weights, gains, scratch); }, map, pool,
      parallel);
}

}  // namespace quell
