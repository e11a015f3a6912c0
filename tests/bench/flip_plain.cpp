#include "tests/bench/flip_plain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "quell/metrics/flip_filters.h"

namespace quell::bench {
namespace {

struct Plane {
  int width, height;
  std::vector<float> values;
  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  float* row(int y) { return values.data() + static_cast<std::ptrdiff_t>(y) * width; }
  const float* row(int y) const { return values.data() + static_cast<std::ptrdiff_t>(y) * width; }
};
using Planes = std::vector<Plane>;

constexpr int kBandRows = 16;

void for_rows(int height, const Parallel& parallel, const std::function<void(int)>& row) {
  parallel((height + kBandRows - 1) / kBandRows, [&](int band) {
    for (int y = band * kBandRows; y < std::min(height, (band + 1) * kBandRows); ++y) row(y);
  });
}

// The weights from one end to the other.
std::vector<float> both_sides(const HalfFilter& filter, bool odd) {
  std::vector<float> weights(filter.rbegin(), filter.rend() - 1);
  if (odd) std::ranges::transform(weights, weights.begin(), std::negate());
  weights.insert(weights.end(), filter.begin(), filter.end());
  return weights;
}

// Beyond the borders the pixels at them go on.
void along_x(const Plane& from, const HalfFilter& filter, bool odd, Plane& to, const Parallel& parallel) {
  const std::vector<float> weights = both_sides(filter, odd);
  const std::size_t radius = filter.size() - 1;
  for_rows(from.height, parallel, [&](int y) {
    std::vector<float> padded(radius, from.row(y)[0]);
    padded.insert(padded.end(), from.row(y), from.row(y) + from.width);
    padded.insert(padded.end(), radius, padded.back());
    for (int x = 0; x < from.width; ++x) {
      float sum = 0;
      for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * padded[static_cast<std::size_t>(x) + i];
      to.row(y)[x] = sum;
    }
  });
}
void along_y(const Plane& from, const HalfFilter& filter, bool odd, Plane& to, const Parallel& parallel,
             bool accumulate = false) {
  const std::vector<float> weights = both_sides(filter, odd);
  const int radius = static_cast<int>(filter.size()) - 1;
  for_rows(from.height, parallel, [&](int y) {
    float* sums = to.row(y);
    if (!accumulate) std::fill_n(sums, to.width, 0.0F);
    for (int i = -radius; i <= radius; ++i) {
      const float* source = from.row(std::clamp(y + i, 0, from.height - 1));
      const float w = weights[static_cast<std::size_t>(i + radius)];
      for (int x = 0; x < from.width; ++x) sums[x] += w * source[x];
    }
  });
}

std::array<float, 3> times(const Matrix3& m, const std::array<float, 3>& v) {
  std::array<float, 3> result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[i] += static_cast<float>(m[i][j]) * v[j];
  return result;
}

float aces(float x) {
  x = std::clamp(x, 0.0F, 1e4F);
  return 0.36F * 2.51F * x * x + 0.6F * 0.03F * x;
}
float aces_divisor(float x) {
  x = std::clamp(x, 0.0F, 1e4F);
  return 0.36F * 2.43F * x * x + 0.6F * 0.59F * x + 0.14F;
}

Planes to_opponent(FloatImage image, const float* gain, const Parallel& parallel) {
  Planes planes(3, Plane(image.width, image.height));
  for_rows(image.height, parallel, [&](int y) {
    for (int x = 0; x < image.width; ++x) {
      std::array<float, 3> rgb{};
      for (std::size_t c = 0; c < 3; ++c) {
        const float value = image.at(x, y, static_cast<int>(c));
        rgb[c] = std::clamp(gain == nullptr ? value : aces(value * *gain) / aces_divisor(value * *gain), 0.0F, 1.0F);
      }
      const auto opponent = times(kRgbToOpponent, rgb);
      for (std::size_t c = 0; c < 3; ++c) planes[c].row(y)[x] = opponent[c];
    }
  });
  return planes;
}

Planes blurred(const Planes& image, const FlipFilters& filters, const Parallel& parallel) {
  Plane between(image[0].width, image[0].height);
  Planes result(3, between);
  along_x(image[0], filters.luma, false, between, parallel);
  along_y(between, filters.luma, false, result[0], parallel);
  along_x(image[1], filters.red_green, false, between, parallel);
  along_y(between, filters.red_green, false, result[1], parallel);
  for (std::size_t i = 0; i < 2; ++i) {
    along_x(image[2], filters.blue_yellow[i], false, between, parallel);
    along_y(between, filters.blue_yellow[i], false, result[2], parallel, i == 1);
  }
  return result;
}

// Edges, points.
Planes features(const Plane& luma, const FlipFilters& filters, const Parallel& parallel) {
  Plane between(luma.width, luma.height), smooth(between), along(between), across(between);
  along_x(luma, filters.smooth, false, smooth, parallel);
  Planes result;
  for (const bool is_edge : {true, false}) {
    const HalfFilter& filter = is_edge ? filters.edge : filters.point;
    along_x(luma, filter, is_edge, between, parallel);
    along_y(between, filters.smooth, false, along, parallel);
    along_y(smooth, filter, is_edge, across, parallel);
    Plane size(luma.width, luma.height);
    for_rows(luma.height, parallel, [&](int y) {
      for (int x = 0; x < luma.width; ++x)
        size.row(y)[x] = std::sqrt(along.row(y)[x] * along.row(y)[x] + across.row(y)[x] * across.row(y)[x]);
    });
    result.push_back(std::move(size));
  }
  return result;
}

std::array<float, 3> adjusted_lab(const Planes& image, int x, int y) {
  auto rgb = times(kOpponentToRgb, {image[0].row(y)[x], image[1].row(y)[x], image[2].row(y)[x]});
  for (float& value : rgb) value = std::clamp(value, 0.0F, 1.0F);
  auto f = times(kRgbToXyz, rgb);
  for (float& t : f) t = t > 216.0F / 24389 ? std::cbrt(t) : (t * 24389 / 27 + 16) / 116;
  const float l = 116 * f[1] - 16;
  return {l, 0.01F * l * 500 * (f[0] - f[1]), 0.01F * l * 200 * (f[1] - f[2])};
}

float color_error(const std::array<float, 3>& a, const std::array<float, 3>& b, FlipRange range) {
  const float hyab = std::abs(a[0] - b[0]) + std::sqrt((a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
  const float difference = std::pow(hyab, static_cast<float>(kFlipColorPower));
  const auto knee = static_cast<float>(range.knee), largest = static_cast<float>(range.largest);
  const auto knee_error = static_cast<float>(kFlipKneeError);
  if (difference < knee) return difference * knee_error / knee;
  return knee_error + (difference - knee) / (largest - knee) * (1 - knee_error);
}

Plane errors(FloatImage reference, FloatImage image, const float* gain, const FlipFilters& filters, const Parallel& parallel) {
  const Planes a = to_opponent(reference, gain, parallel), b = to_opponent(image, gain, parallel);
  const Planes blurred_a = blurred(a, filters, parallel), blurred_b = blurred(b, filters, parallel);
  const Planes features_a = features(a[0], filters, parallel), features_b = features(b[0], filters, parallel);
  const FlipRange range = flip_range();
  Plane result(reference.width, reference.height);
  for_rows(reference.height, parallel, [&](int y) {
    for (int x = 0; x < reference.width; ++x) {
      const float color = color_error(adjusted_lab(blurred_a, x, y), adjusted_lab(blurred_b, x, y), range);
      const float edge = std::abs(features_a[0].row(y)[x] - features_b[0].row(y)[x]);
      const float point = std::abs(features_a[1].row(y)[x] - features_b[1].row(y)[x]);
      const float feature = std::sqrt(std::max(edge, point) / std::sqrt(2.0F));
      result.row(y)[x] = std::min(1.0F, std::pow(color, 1 - feature));
    }
  });
  return result;
}

Score finish(const Plane& error, FloatImage counts, FloatOutput map) {
  Score score;
  for (int y = 0; y < error.height; ++y)
    for (int x = 0; x < error.width; ++x) {
      if (map) map.at(x, y) = error.row(y)[x];
      if (counts && counts.at(x, y) != 1) continue;
      score.sum += error.row(y)[x];
      ++score.count;
    }
  return score;
}

}  // namespace

Score plain_flip(const FlipImages& images, double pixels_per_degree, FloatOutput map, const Parallel& parallel) {
  const FlipFilters filters(pixels_per_degree);
  return finish(errors(images.reference, images.image, nullptr, filters, parallel), images.counts, map);
}

Score plain_hdr_flip(const FlipImages& images, const Exposures& exposures, double pixels_per_degree, FloatOutput map,
                     const Parallel& parallel) {
  const FlipFilters filters(pixels_per_degree);
  Plane largest(images.reference.width, images.reference.height);
  for (int i = 0; i < exposures.count; ++i) {
    const double step = exposures.count > 1 ? (exposures.stop - exposures.start) / (exposures.count - 1) : 0;
    const auto gain = static_cast<float>(std::exp2(exposures.start + i * step));
    const Plane error = errors(images.reference, images.image, &gain, filters, parallel);
    std::ranges::transform(largest.values, error.values, largest.values.begin(), [](float a, float b) { return std::max(a, b); });
  }
  return finish(largest, images.counts, map);
}

}  // namespace quell::bench
