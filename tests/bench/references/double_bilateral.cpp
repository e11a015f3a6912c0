#include <algorithm>
#include <cmath>

#include "tests/bench/references/bilateral.h"

namespace quell::bench {
namespace {

Double3 wide(const Float3& v) { return {v.x, v.y, v.z}; }
Double3 operator-(const Double3& a, const Double3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Double3& a, const Double3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double square(double a) { return a * a; }

/// Normals are unit vectors rounded to float; the formula is about the vectors meant.
double angle(const Double3& n, const Double3& m) {
  return std::acos(std::clamp(dot(n, m) / std::sqrt(dot(n, n) * dot(m, m)), -1.0, 1.0));
}

double weight(const InterleavedFrame& f, const BilateralSettings& s, int x, int y, int qx, int qy) {
  const auto i = static_cast<std::size_t>(y * f.width + x), j = static_cast<std::size_t>(qy * f.width + qx);
  const Double3 n = wide(f.normal[i]), m = wide(f.normal[j]);
  if (dot(m, m) == 0) return 0;
  const Double3 contrast = wide(f.color[i]) - wide(f.color[j]), way = wide(f.position[j]) - wide(f.position[i]);
  double e = (square(qx - x) + square(qy - y)) / square(s.sigma_coord) + dot(contrast, contrast) / square(s.sigma_color) +
             square(angle(n, m) / s.sigma_normal);
  if (dot(way, way) > 0) e += square(dot(n, way) / s.sigma_plane) / dot(way, way);
  return std::exp(-e / 2);
}

}  // namespace

Double3 filter_in_double(const InterleavedFrame& f, const BilateralSettings& s, int x, int y) {
  const auto i = static_cast<std::size_t>(y * f.width + x);
  if (dot(wide(f.normal[i]), wide(f.normal[i])) == 0) return wide(f.color[i]);
  Double3 sum{0, 0, 0};
  double weights = 0;
  for (int qy = std::max(0, y - s.radius); qy <= std::min(f.height - 1, y + s.radius); ++qy)
    for (int qx = std::max(0, x - s.radius); qx <= std::min(f.width - 1, x + s.radius); ++qx) {
      const double w = weight(f, s, x, y, qx, qy);
      const Float3& color = f.color[static_cast<std::size_t>(qy * f.width + qx)];
      weights += w, sum.x += w * color.x, sum.y += w * color.y, sum.z += w * color.z;
    }
  return {sum.x / weights, sum.y / weights, sum.z / weights};
}

}  // namespace quell::bench
