// Compiled with -O3 and nothing else: one pixel after the other, every weight from the formula.
#include <algorithm>
#include <cmath>

#include "tests/bench/references/atrous.h"

namespace quell::bench {
namespace {

constexpr float kNoSurface = 1e10F;
constexpr float kSpline[] = {3.0F / 8, 1.0F / 4, 1.0F / 16};

float luminance(const Float3& color) { return dot(color, {0.2126F, 0.7152F, 0.0722F}); }

struct Filter {
  const AtrousFrame& f;
  const AtrousSettings& s;

  bool is_inside(int x, int y) const { return x >= 0 && y >= 0 && x < f.width && y < f.height; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(f.width) + static_cast<std::size_t>(x);
  }
  bool is_surface(int x, int y) const {
    const Float3& n = f.normal[index(x, y)];
    return f.depth[index(x, y)] < kNoSurface && dot(n, n) > 0;
  }

  /// The smaller of the differences to both neighbors in direction (dx, dy).
  float slope(int x, int y, int dx, int dy) const {
    const float z = f.depth[index(x, y)];
    float smaller = kNoSurface;
    if (is_inside(x - dx, y - dy) && is_surface(x - dx, y - dy)) smaller = z - f.depth[index(x - dx, y - dy)];
    if (is_inside(x + dx, y + dy) && is_surface(x + dx, y + dy)) {
      const float ahead = f.depth[index(x + dx, y + dy)] - z;
      if (std::abs(ahead) < std::abs(smaller)) smaller = ahead;
    }
    return std::abs(smaller) < kNoSurface ? smaller : 0;
  }

  /// 3 x 3 of the variance, weighted by 1/4, 1/8 and 1/16.
  float blurred_variance(int x, int y) const {
    float sum = 0, weights = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if (!is_inside(x + dx, y + dy)) continue;
        const float h = 1.0F / static_cast<float>(4 << (std::abs(dx) + std::abs(dy)));
        sum += h * f.variance[index(x + dx, y + dy)];
        weights += h;
      }
    return sum / weights;
  }

  void filter_pixel(int x, int y, AtrousResult& result) const {
    const std::size_t p = index(x, y);
    result.color[p] = f.color[p];
    result.variance[p] = f.variance[p];
    if (!is_surface(x, y)) return;
    const int step = 1 << s.level;
    const float slope_x = slope(x, y, 1, 0), slope_y = slope(x, y, 0, 1);
    const float deviation = std::sqrt(blurred_variance(x, y));
    Float3 sum{0, 0, 0};
    float variance = 0, weights = 0;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const int qx = x + dx * step, qy = y + dy * step;
        if (!is_inside(qx, qy) || !is_surface(qx, qy)) continue;
        const std::size_t q = index(qx, qy);
        const float change = std::abs(slope_x * static_cast<float>(dx * step) + slope_y * static_cast<float>(dy * step));
        const float w_z = std::exp(-std::abs(f.depth[p] - f.depth[q]) / (s.sigma_z * change + s.eps_z * f.depth[p]));
        const float w_n = std::pow(std::max(0.0F, dot(f.normal[p], f.normal[q])), s.sigma_n);
        const float w_l = std::exp(-std::abs(luminance(f.color[p]) - luminance(f.color[q])) / (s.sigma_l * deviation + 1e-8F));
        const float w = kSpline[std::abs(dx)] * kSpline[std::abs(dy)] * w_z * w_n * w_l;
        sum = sum + f.color[q] * w;
        variance += w * w * f.variance[q];
        weights += w;
      }
    result.color[p] = sum / weights;
    result.variance[p] = variance / (weights * weights);
  }
};

}  // namespace

AtrousResult filter_as_the_paper(const AtrousFrame& frame, const AtrousSettings& settings, int threads) {
  AtrousResult result{std::vector<Float3>(frame.color.size()), std::vector<float>(frame.color.size())};
  const Filter filter{frame, settings};
#pragma omp parallel for num_threads(threads) schedule(dynamic)
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) filter.filter_pixel(x, y, result);
  return result;
}

}  // namespace quell::bench
