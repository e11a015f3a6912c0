// Which exposures show a sequence, after section 3 of Andersson et al., Eurographics 2021.
#include <algorithm>
#include <cmath>

#include "quell/metrics/flip.h"
#include "quell/metrics/flip_filters.h"

namespace quell {
namespace {

constexpr int kBandRows = 64;

struct Band {
  std::size_t first = 0, count = 0;  // of the luminances above 0
  float largest = 0;
};

// Luminances above 0 of rows [y0, y1), one after the other.
Band gather(FloatImage image, int y0, int y1, float* to) {
  const auto [r, g, b] = kRgbToXyz[1];
  Band band{.first = static_cast<std::size_t>(y0) * static_cast<std::size_t>(image.width)};
  float* end = to + band.first;
  for (int y = y0; y < y1; ++y) {
    const float *red = image.row(y, 0), *green = image.row(y, 1), *blue = image.row(y, 2);
    for (int x = 0; x < image.width; ++x) {
      const auto luminance = static_cast<float>(r * red[x] + g * green[x] + b * blue[x]);
      *end = luminance;
      end += luminance > 0 ? 1 : 0;
      band.largest = std::max(band.largest, luminance);
    }
  }
  band.count = static_cast<std::size_t>(end - (to + band.first));
  return band;
}

double median(float* first, std::size_t count) {
  if (count == 0) return 0;
  float* middle = first + count / 2;
  std::nth_element(first, middle, first + count);
  const double upper = *middle;
  return count % 2 == 1 ? upper : (upper + *std::max_element(first, middle)) / 2;
}

// The radiance that the tone curve takes to 0.85.
double bright_radiance() {
  const double a = kFlipCurve[0] - kFlipBright * kFlipCurve[2], b = kFlipCurve[1] - kFlipBright * kFlipCurve[3],
               c = -kFlipBright * kFlipCurve[4];
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

}  // namespace

LuminanceRange luminance_range(FloatImage reference, BufferPool& pool, const Parallel& parallel) {
  const auto pixels = static_cast<std::size_t>(reference.width) * static_cast<std::size_t>(reference.height);
  const Buffer buffer = pool.acquire(pixels * sizeof(float));
  auto* luminances = static_cast<float*>(buffer.data());
  std::vector<Band> bands(static_cast<std::size_t>((reference.height + kBandRows - 1) / kBandRows));
  parallel(static_cast<int>(bands.size()), [&](int i) {
    bands[static_cast<std::size_t>(i)] =
        gather(reference, i * kBandRows, std::min(reference.height, (i + 1) * kBandRows), luminances);
  });
  LuminanceRange range;
  std::size_t count = 0;
  for (const Band& band : bands) {
    std::copy_n(luminances + band.first, band.count, luminances + count);
    count += band.count;
    range.largest = std::max(range.largest, static_cast<double>(band.largest));
  }
  range.median = median(luminances, count);
  return range;
}

Exposures choose_exposures(std::span<const LuminanceRange> frames) {
  double largest = 0, median = 0;  // the median of the darkest frame that is not black
  for (const LuminanceRange& frame : frames) {
    if (!(frame.median > 0)) continue;
    largest = std::max(largest, frame.largest);
    median = median > 0 ? std::min(median, frame.median) : frame.median;
  }
  if (median == 0) return {};
  Exposures exposures{.start = std::log2(bright_radiance() / largest), .stop = std::log2(bright_radiance() / median)};
  exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.stop - exposures.start)));
  return exposures;
}

}  // namespace quell
