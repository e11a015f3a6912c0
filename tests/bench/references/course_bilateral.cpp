// Compiled with -O3 -march=native -fopenmp. Written from the formula: exp(-|i-j|^2/2sp^2 - |C_i-C_j|^2/2sc^2 -
// acos(N_i.N_j)^2/2sn^2
// - (N_i.(P_j-P_i)/|P_j-P_i|)^2/2sd^2), in floats, one pixel after the other.
#include <algorithm>
#include <cmath>

#include "tests/bench/references/bilateral.h"

namespace quell::bench {
namespace {

float square(float a) { return a * a; }
float safe_acos(float a) { return std::acos(std::min(1.0F, std::max(-1.0F, a))); }

float weight(const InterleavedFrame& f, const BilateralSettings& s, int x, int y, int qx, int qy) {
  const auto i = static_cast<std::size_t>(y * f.width + x), j = static_cast<std::size_t>(qy * f.width + qx);
  const float d_position =
      (square(static_cast<float>(qx - x)) + square(static_cast<float>(qy - y))) / (2 * square(s.sigma_coord));
  const Float3 contrast = f.color[i] - f.color[j];
  const float d_color = dot(contrast, contrast) / (2 * square(s.sigma_color));
  const float d_normal = square(safe_acos(dot(f.normal[i], f.normal[j]))) / (2 * square(s.sigma_normal));
  float d_plane = 0;
  const Float3 way = f.position[j] - f.position[i];
  const float length = std::sqrt(dot(way, way));
  if (length > 0) d_plane = square(dot(f.normal[i], way / length)) / (2 * square(s.sigma_plane));
  return std::exp(-d_position - d_color - d_normal - d_plane);
}

Float3 filter_pixel(const InterleavedFrame& f, const BilateralSettings& s, int x, int y) {
  Float3 sum{0, 0, 0};
  float weights = 0;
  for (int qy = std::max(0, y - s.radius); qy <= std::min(f.height - 1, y + s.radius); ++qy)
    for (int qx = std::max(0, x - s.radius); qx <= std::min(f.width - 1, x + s.radius); ++qx) {
      const float w = weight(f, s, x, y, qx, qy);
      weights += w;
      sum = sum + f.color[static_cast<std::size_t>(qy * f.width + qx)] * w;
    }
  return sum / weights;
}

}  // namespace

std::vector<Float3> filter_as_the_course(const InterleavedFrame& frame, const BilateralSettings& settings, int threads) {
  std::vector<Float3> filtered(frame.color.size());
#pragma omp parallel for num_threads(threads) schedule(dynamic)
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      filtered[static_cast<std::size_t>(y * frame.width + x)] = filter_pixel(frame, settings, x, y);
  return filtered;
}

}  // namespace quell::bench
