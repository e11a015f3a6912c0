#include "tests/core/metrics/test_pairs.h"

#include <hwy/highway.h>

#include <cmath>

namespace quell::test {

double noise(int x, int y, int c, unsigned seed) {
  unsigned h = static_cast<unsigned>(x) * 374761393U + static_cast<unsigned>(y) * 668265263U +
               static_cast<unsigned>(c) * 2246822519U + seed * 3266489917U;
  h = (h ^ (h >> 13)) * 1274126177U;
  h = (h ^ (h >> 15)) * 2246822519U;
  return static_cast<double>((h ^ (h >> 16)) & 0xffffff) / 0x1000000;
}

ImagePair make_pair(Size size, unsigned seed, int spare_lines) {
  const auto radiance = [](int x, int y, int c) {
    const double wave = 0.4 + 0.4 * std::sin(0.3 * x + 0.5 * c) * std::cos(0.2 * y);
    return (x / 7 + y / 5) % 4 == 3 ? 20 * wave : wave - 0.05;
  };
  const auto noisy = [&](int x, int y, int c) { return radiance(x, y, c) * (0.5 + noise(x, y, c, seed)); };
  return {test_image(
              QUELL_TYPE_COLOR, size, [&](int x, int y, int c) { return static_cast<float>(radiance(x, y, c)); }, spare_lines),
          test_image(
              QUELL_TYPE_COLOR, size, [&](int x, int y, int c) { return static_cast<float>(noisy(x, y, c)); }, spare_lines)};
}

Image flat(Size size, float red, float green, float blue) {
  return test_image(QUELL_TYPE_COLOR, size, [=](int, int, int c) { return c == 0 ? red : c == 1 ? green : blue; });
}

std::vector<Score> scores(const CompareInput& input, const std::vector<Metric>& metrics, DisplayTransform display,
                          const Parallel& parallel) {
  static BufferPool pool;
  pool.fill(PassTest::kNanByte);
  return compare(input, {.metrics = metrics, .display = display}, false, pool, parallel).scores;
}

Score score(const CompareInput& input, Metric metric, DisplayTransform display) { return scores(input, {metric}, display)[0]; }

double figure(const CompareInput& input, Metric metric, DisplayTransform display) {
  return value(metric, score(input, metric, display));
}

const std::vector<Metric>& plain_metrics() {
  static const std::vector<Metric> metrics{Metric::psnr,  Metric::ssim,  Metric::mse,   Metric::relmse,
                                           Metric::smape, Metric::tpsnr, Metric::warped};
  return metrics;
}

std::vector<std::int64_t> vector_units() {
  std::vector<std::int64_t> units;
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) units.push_back(left & -left);
  return units;
}
void use_vector_unit(std::int64_t unit) { hwy::SetSupportedTargetsForTest(unit); }
void use_best_vector_unit() { hwy::SetSupportedTargetsForTest(0); }
std::string name_of_vector_unit(std::int64_t unit) { return hwy::TargetName(unit); }

}  // namespace quell::test
