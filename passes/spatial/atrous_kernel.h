// One level of the edge-avoiding à-trous wavelet over rows of pixels, on the vector unit of the machine. atrous.cpp makes a pass
// of it.
#pragma once

#include <array>
#include <cstddef>

#include "quell/sdk/types.h"

namespace quell::atrous {

/// What stops the filter at an edge; the formulas stand in atrous.cpp.
enum class Stops { svgf, dammertz, joint_bilateral };

/// Images of one size. All but the color may be absent; terms of absent images are 1 (in a weight) or 0 (in an exponent).
struct Images {
  FloatImage color, normal, position, depth, depth_gradient, variance, blurred_variance;
};

/// What weights are made of. A weight is 2^(offset_exponent - e); each factor is finite and at least 0.
struct Settings {
  Stops stops = Stops::svgf;
  int step = 1;  ///< px between taps

  std::array<float, 12> offset_exponents{};  ///< by pair: log2 of what depends on the offset alone, h included

  /// For dammertz and joint_bilateral e = gain (squared distance of color + the terms below), so that each factor is relative to
  /// that of color. `gain` is above 0.
  float gain = 1;
  float normal_factor = 0;    ///< of the squared distance or angle of normals
  float position_factor = 0;  ///< dammertz: of the squared distance of positions
  float plane_factor = 0;     ///< joint_bilateral: it scales a length, not its square

  /// For svgf, where each is for e itself.
  float slope_factor = 0;      ///< of the change of depth; it and the next are in a denominator
  float depth_eps = 0;         ///< of the depth
  float normal_power = 0;      ///< of -ln(n.n')
  float luminance_factor = 0;  ///< of the deviation; it and the next are in a denominator
  float luminance_eps = 0;     ///< radiance
  float variance_eps = 0;      ///< radiance^2, added to the variance

  bool wide_normals = false;  ///< svgf: a sigma below kSmallestNarrowPower; joint_bilateral: above kLargestNarrowSigma
};

/// From this sigma_n on, (n.n')^sigma_n is within 1.5e-6 with a short series.
inline constexpr double kSmallestNarrowPower = 64;
/// Up to this sigma_normal (rad) a weight at 60 degrees is below 1.2e-6, and what a tap beyond that weighs does not matter.
inline constexpr double kLargestNarrowSigma = 0.2;
inline constexpr int kLargestLevel = 7;

/// The B3 spline's weights at 0, 1 and 2 steps.
inline constexpr std::array<float, 3> kB3{3.0F / 8, 1.0F / 4, 1.0F / 16};

/// An offset in steps; the taps at it and at its opposite are a pair. All pairs and the pixel itself make the 5 x 5 taps.
struct Offset {
  float dx, dy, h, length;
};
inline constexpr std::array<Offset, 12> kPairs{{{1, 0, kB3[1] * kB3[0], 1},
                                                {2, 0, kB3[2] * kB3[0], 2},
                                                {-2, 1, kB3[2] * kB3[1], 2.23606798F},
                                                {-1, 1, kB3[1] * kB3[1], 1.41421356F},
                                                {0, 1, kB3[0] * kB3[1], 1},
                                                {1, 1, kB3[1] * kB3[1], 1.41421356F},
                                                {2, 1, kB3[2] * kB3[1], 2.23606798F},
                                                {-2, 2, kB3[2] * kB3[2], 2.82842712F},
                                                {-1, 2, kB3[1] * kB3[2], 2.23606798F},
                                                {0, 2, kB3[0] * kB3[2], 2},
                                                {1, 2, kB3[1] * kB3[2], 2.23606798F},
                                                {2, 2, kB3[2] * kB3[2], 2.82842712F}}};

/// Scratch memory holds rows of planes, with these floats from a plane to the next. Not a multiple of 4 kB, or all planes would
/// compete for the same lines of the first-level cache.
inline constexpr int kStride = 1040;
inline constexpr int kMaxPlanes = 10;

/// Bytes of memory that filter_turns works in.
std::size_t scratch_bytes();

/// Each row has its turn: those that are `step` apart follow each other, and share the rows that they read. Filters the rows of
/// the turns [begin, end), of as many as there are rows. `scratch` is scratch_bytes() long and 64-byte aligned; its content does
/// not matter. A pixel's result does not depend on begin and end. Without a variance, `variance` becomes 0.
void filter_turns(const Images& in, const Settings& settings, const FloatOutput& color, const FloatOutput& variance, int begin,
                  int end, float* scratch);

}  // namespace quell::atrous
