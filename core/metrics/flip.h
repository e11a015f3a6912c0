// FLIP: how different two pictures look when a person flips between them.
// Source: Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020; for radiance (HDR-FLIP) Andersson et
//         al., "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics 2021.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "quell/image/buffer_pool.h"
#include "quell/metrics/metric.h"
#include "quell/metrics/parallel.h"
#include "quell/sdk/types.h"

namespace quell {

/// Pixels a degree of the observer in the paper: 0.7 m before a display 0.7 m wide with 3840 pixels.
inline constexpr double kPixelsPerDegree = 67.0206432765823;  // 0.7 * 3840 / 0.7 * pi / 180

/// Images of one size, three planes each, all values finite (see compare()). `counts` is 1 where a pixel's error counts in the
/// score, 0 elsewhere; no image: every pixel counts.
struct FlipImages {
  FloatImage reference, image, counts;
};

/// The errors are 0..1; `map`, one plane of the images' size, takes each pixel's when it is there, also where it does not count.
/// Linear sRGB light (BT.709 primaries, no transfer curve) of 0..1; what is beyond is clamped.
Score flip(const FlipImages& images, double pixels_per_degree, FloatOutput map, BufferPool& pool, const Parallel& parallel);

/// The pictures that HDR-FLIP takes of radiance: exposures in stops (radiance times 2^stop), from `start` to `stop`, evenly
/// apart.
struct Exposures {
  double start = 0, stop = 0;
  int count = 2;  ///< at least 1
  bool operator==(const Exposures&) const = default;
};

/// What of a reference decides its exposures: luminance, median and largest.
struct LuminanceRange {
  double median = 0;  ///< of the values above 0, so that a picture that is mostly black has one; 0 when there are none
  double largest = 0;
};
LuminanceRange luminance_range(FloatImage reference, BufferPool& pool, const Parallel& parallel);
/// The exposures that show every frame of a sequence from its brightest pixel to its median (Andersson 2021, section 3), the same
/// for all frames, so that their errors are comparable. Throws nothing; a black sequence has exposures from 0 to 0.
Exposures choose_exposures(std::span<const LuminanceRange> frames);

/// Radiance: the errors of each pixel are the largest over the exposures, each tone mapped by the ACES curve.
Score hdr_flip(const FlipImages& images, const Exposures& exposures, double pixels_per_degree, FloatOutput map, BufferPool& pool,
               const Parallel& parallel);

/// FLIP's colors for an error of 0..1: the map "magma", as a display shows them (sRGB).
std::array<std::uint8_t, 3> flip_color(double error);

}  // namespace quell
