// The joint bilateral filter over rows of pixels, on the vector unit of the machine. joint_bilateral.cpp makes a pass of it, and
// bilateral.cpp one without guides.
#pragma once

#include <cstddef>
#include <vector>

#include "quell/sdk/types.h"

namespace quell::joint_bilateral {

/// How the directions of two surfaces are compared.
enum class NormalTerm {
  narrow_angle,  ///< for a sigma of kLargestNarrowSigma and less
  wide_angle,
  difference,  ///< the length of the difference of the normals
};

/// Images of one size; normal and position may be absent.
struct Images {
  FloatImage color, normal, position;
};

/// What weights are made of. A weight is 2^-(gain e), where e counts in squared distances of color: that term then needs no
/// factor of its own, and the factors of the others are relative to it. Each is finite and at least 0; gain is above 0.
struct Settings {
  int radius_x = 0, radius_y = 0;      ///< px, at most kMaxRadius
  float gain = 1;                      ///< log2(e) / (2 sigma_color^2)
  float normal_factor = 0;             ///< sigma_color^2 / sigma_normal^2
  bool compares_z = false;             ///< positions count by their third coordinate, not by the tangent plane
  float plane_factor = 0;              ///< sigma_color / sigma_plane: it scales a length, not its square
  float z_factor = 0;                  ///< sigma_color^2 / sigma_z^2
  float position_factor = 0;           ///< sigma_color^2 / sigma_coord^2, or 0: positions do not count as distances
  std::vector<float> pixel_distances;  ///< [|dy|][dx + radius_x]: the part of e that depends on the distance in pixels
  NormalTerm normal_term = NormalTerm::narrow_angle;
};

/// Up to this sigma_normal (rad) a weight at 60 degrees is below 1.2e-6, and what a tap beyond that weighs does not matter.
inline constexpr double kLargestNarrowSigma = 0.2;

inline constexpr int kMaxRadius = 64;  ///< px

/// Bytes of memory that filter_rows works in.
std::size_t scratch_bytes(int radius_y);

/// Filters rows [y0, y1) of `in` into `out`. `scratch` is scratch_bytes(radius_y) long and 64-byte aligned; its content does not
/// matter. A pixel's result does not depend on y0 and y1.
void filter_rows(const Images& in, const Settings& settings, const FloatOutput& out, int y0, int y1, float* scratch);

}  // namespace quell::joint_bilateral
