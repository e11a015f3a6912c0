#include "tests/core/metrics/flip_images.h"

#include <cmath>
#include <cstring>

#include "tests/core/metrics/test_pairs.h"

namespace quell::flip_test {
namespace {

double noise(int x, int y, int c) { return test::noise(x, y, c, 1); }

BufferPool& pool() {
  static BufferPool pool;
  pool.fill(0xff);  // what a test forgets to write is NaN
  return pool;
}

}  // namespace

Image make_picture(Size size, const std::function<Vec(int x, int y)>& color, int spare_lines) {
  Image image(QUELL_TYPE_COLOR, size, pool(), spare_lines);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Vec value = color(x, y);
      for (int c = 0; c < 3; ++c) image.writable_floats().at(x, y, c) = static_cast<float>(value[static_cast<std::size_t>(c)]);
    }
  return image;
}

Image make_plane(Size size, const std::function<float(int x, int y)>& value, int spare_lines) {
  Image image(QUELL_TYPE_SCALAR, size, pool(), spare_lines);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) image.writable_floats().at(x, y) = value(x, y);
  return image;
}

Image flat(Size size, const Vec& color) {
  return make_picture(size, [&](int, int) { return color; });
}

Image make_scene(Size size, int spare_lines) {
  return make_picture(
      size,
      [](int x, int y) -> Vec {
        if ((x / 9 + y / 7) % 3 == 0) return {0.2, 0.6, 0.1};
        if ((x / 9 + y / 7) % 3 == 1) return {0.5 + 0.5 * std::sin(0.3 * x), 0.02 * (x % 50), 0.5 + 0.4 * std::cos(0.2 * y)};
        if (x % 13 == 5 && y % 11 == 3) return {4, 1.5, -0.5};
        return {noise(x, y, 0), noise(x, y, 1) * 0.1, noise(x, y, 2)};
      },
      spare_lines);
}

Image make_wrong_scene(Size size, int spare_lines) {
  const Image scene = make_scene(size);
  return make_picture(
      size,
      [&](int x, int y) -> Vec {
        const int from = (y / 16) % 3 == 1 && x > 0 ? x - 1 : x;
        Vec value{scene.floats().at(from, y, 0), scene.floats().at(from, y, 1), scene.floats().at(from, y, 2)};
        if ((y / 16) % 3 == 2) return value;
        for (std::size_t c = 0; c < 3; ++c)
          value[c] += 0.2 * (noise(x, y, 10 + static_cast<int>(c)) - 0.5) + (x % 40 < 7 ? 0.1 : 0);
        return value;
      },
      spare_lines);
}

Result run_flip(const Image& reference, const Image& image, double pixels_per_degree, const Image& counts,
                const Parallel& parallel) {
  Result result{.score = {}, .map = Image(QUELL_TYPE_SCALAR, reference.size(), pool())};
  const FlipImages images{reference.floats(), image.floats(), counts ? counts.floats() : FloatImage{}};
  result.score = flip(images, pixels_per_degree, result.map.writable_floats(), pool(), parallel);
  return result;
}

Result run_hdr_flip(const Image& reference, const Image& image, const Exposures& exposures, double pixels_per_degree,
                    const Parallel& parallel) {
  Result result{.score = {}, .map = Image(QUELL_TYPE_SCALAR, reference.size(), pool())};
  const FlipImages images{reference.floats(), image.floats(), {}};
  result.score = hdr_flip(images, exposures, pixels_per_degree, result.map.writable_floats(), pool(), parallel);
  return result;
}

double mean(const Score& score) { return score.sum / static_cast<double>(score.count); }

bool same_bits(const Image& a, const Image& b) {
  for (int c = 0; c < a.channels(); ++c)
    for (int y = 0; y < a.height(); ++y)
      if (std::memcmp(a.floats().row(y, c), b.floats().row(y, c), static_cast<std::size_t>(a.width()) * sizeof(float)) != 0)
        return false;
  return true;
}

}  // namespace quell::flip_test
