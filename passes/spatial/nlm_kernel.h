// Non-local means over rows of pixels, on the vector unit of the machine. nlm.cpp makes a pass of it.
#pragma once

#include <array>
#include <cstddef>

#include "quell/sdk/types.h"

namespace quell::nlm {

inline constexpr int kMaxRadius = 32, kMaxPatchRadius = 8, kMaxFeatures = 8;

struct Feature {
  FloatImage image, variance;  ///< variance may be absent
  bool is_depth = false;       ///< pixels without surface, of depth 1e10, have no slope
};

/// Images of one size. The variance has one plane, of luminance, or three, of the channels.
struct Images {
  FloatImage color, variance;
  std::array<Feature, kMaxFeatures> features;
  int feature_count = 0;
};

struct Settings {
  int radius = 7, patch_radius = 3;
  float k_squared = 1, alpha = 1;
  bool symmetric = false;
  float k_feature_squared = 1, tau = 1e-3F;
};

/// Bytes of scratch for that many features.
std::size_t scratch_bytes(const Settings& settings, std::size_t features);

/// Filters rows [y0, y1). `scratch` is 64-byte aligned; its content does not matter. A result does not depend on y0 and y1.
void filter_rows(const Images& in, const Settings& settings, const FloatOutput& out, int y0, int y1, float* scratch);

}  // namespace quell::nlm
