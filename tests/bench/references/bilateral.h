// The joint bilateral filter as others write it, on pixels that lie interleaved: what the pass is compared with.
#pragma once

#include <vector>

#include "tests/bench/references/float3.h"

namespace quell::bench {

/// Rows one after the other, without gaps.
struct InterleavedFrame {
  int width = 0, height = 0;
  std::vector<Float3> color, normal, position;
};

struct BilateralSettings {
  int radius = 16;
  float sigma_coord = 32, sigma_color = 0.8F, sigma_normal = 0.1F, sigma_plane = 0.1F;
};

/// As a student of GAMES202 writes homework 5 from its formula; OpenMP over rows.
std::vector<Float3> filter_as_the_course(const InterleavedFrame& frame, const BilateralSettings& settings, int threads);

/// One pixel in double precision, as the pass describes itself: taps without surface do not count.
struct Double3 {
  double x, y, z;
};
Double3 filter_in_double(const InterleavedFrame& frame, const BilateralSettings& settings, int x, int y);

/// OpenCV's jointBilateralFilter with the normals as its guide: no positions, one color difference, and taps in a disc. Only
/// where OpenCV was found.
std::vector<Float3> filter_with_opencv(const InterleavedFrame& frame, const BilateralSettings& settings, int threads);
#ifdef QUELL_BENCH_OPENCV
inline constexpr bool kHasOpenCv = true;
#else
inline constexpr bool kHasOpenCv = false;
#endif

}  // namespace quell::bench
