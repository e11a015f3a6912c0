// FLIP of one tile of a picture, for every vector unit.
#pragma once

#include <cstddef>
#include <vector>

#include "quell/metrics/flip_filters.h"
#include "quell/sdk/types.h"

namespace quell::flip_kernel {

/// The filters, with the weights that are used together lying together. [i]: for the two pixels that lie i from the center.
struct Weights {
  struct Luma {
    float blur, smooth, edge, point;
  };
  struct BlueYellow {
    float first, second;
  };
  explicit Weights(const FlipFilters& filters);
  std::vector<Luma> luma;
  std::vector<float> red_green;
  std::vector<BlueYellow> blue_yellow;
  int blur_taps = 0;  ///< of luma's entries, those with a blur
  int radius = 0;
};

/// Tiles of this size, those at the right and lower borders smaller: 0.7 MB with what filters reach beyond them, for the
/// second-level cache, or most of it. Lower ones would convert more rows twice; narrower ones filter more pixels twice.
constexpr int kTileWidth = 512, kTileHeight = 32;

struct Tile {
  FloatImage reference, image;
  int x = 0, y = 0, width = 0, height = 0;  ///< pixels [x, x + width) of rows [y, y + height)
};

/// Floats of scratch memory for a tile. The first tile_errors() of them hold the tile's errors afterwards, in rows of kTileWidth.
std::size_t scratch_size(int radius);
constexpr std::size_t tile_errors() { return std::size_t{kTileWidth} * kTileHeight; }

/// Errors of display light.
void display_errors(const Tile& tile, const Weights& weights, float* scratch);
/// The largest errors of radiance times each gain, tone mapped. At least one gain, each finite and at least 0.
void radiance_errors(const Tile& tile, const Weights& weights, const std::vector<float>& gains, float* scratch);

}  // namespace quell::flip_kernel
