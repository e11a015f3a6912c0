// FLIP: how different two pictures look when a person flips between them.
// Source: Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020; for radiance (HDR-FLIP) Andersson et
//         al., "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics 2021.
// Borders: beyond them the pixels at them go on, as in the paper's program.
// Error:   of a pixel's parts, 1e-3 of the color distance HyAB (which goes to 203) and 4e-7 of the feature difference before its
//          square root (which goes to 1), then 3e-6 of the result: float, against the formulas in double. Where the colors agree
//          and features do not, the power of the two makes that more. Up to 1.44e-7 of features are there on purpose
//          (kFlipEdgeRounding in flip_filters.h): they stand for the paper's program's own rounding, which its figures show.
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
/// Linear sRGB light (BT.709 primaries, no transfer curve) of 0..1; what is beyond is clamped. The same for any `parallel`, bit
/// for bit, and with reference and image exchanged. Throws Error(usage) when pixels_per_degree is not within 1..1000.
Score flip(const FlipImages& images, double pixels_per_degree, FloatOutput map, BufferPool& pool, const Parallel& parallel);

/// The pictures that HDR-FLIP takes of radiance: exposures in stops (radiance times 2^stop), from `start` to `stop`, evenly
/// apart. Stops are within -1000..1000.
struct Exposures {
  double start = 0, stop = 0;
  int count = 2;  ///< 1..1000
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

/// Radiance, of which negative values count as 0: the errors of each pixel are the largest over the exposures, each tone mapped
/// by the ACES curve. Otherwise as flip(). Throws Error(usage) for other exposures than those above, too.
Score hdr_flip(const FlipImages& images, const Exposures& exposures, double pixels_per_degree, FloatOutput map, BufferPool& pool,
               const Parallel& parallel);

/// FLIP's colors for an error of 0..1: the map "magma", as a display shows them (sRGB).
std::array<std::uint8_t, 3> flip_color(double error);

}  // namespace quell
