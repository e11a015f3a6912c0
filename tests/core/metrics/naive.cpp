#include "tests/core/metrics/naive.h"

#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

namespace quell::test {
namespace {

bool is_good(const ImagePair& pair, int x, int y) {
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(pair.reference.floats().at(x, y, c)) || !std::isfinite(pair.image.floats().at(x, y, c))) return false;
  return true;
}

struct Values {
  double r = 0, a = 0;
};

/// A pair of images as a metric looks at them.
class Looked {
 public:
  /// Values are 0 where either image is not finite.
  Looked(const ImagePair& pair, const std::function<double(double)>& look)
      : width(pair.image.width()), height(pair.image.height()) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        good_.push_back(is_good(pair, x, y));
        for (int c = 0; c < 3; ++c)
          values_.push_back(good_.back() ? Values{look(static_cast<double>(pair.reference.floats().at(x, y, c))),
                                                  look(static_cast<double>(pair.image.floats().at(x, y, c)))}
                                         : Values{});
      }
  }
  bool is_good_at(int x, int y) const { return good_[static_cast<std::size_t>(y * width + x)]; }
  const Values& at(int x, int y, int c) const { return values_[static_cast<std::size_t>((y * width + x) * 3 + c)]; }

  int width, height;

 private:
  std::vector<bool> good_;
  std::vector<Values> values_;
};

Score mean_over(const Looked& pair, const std::function<double(Values)>& error) {
  Score score;
  for (int y = 0; y < pair.height; ++y)
    for (int x = 0; x < pair.width; ++x)
      if (pair.is_good_at(x, y)) {
        for (int c = 0; c < 3; ++c) score.sum += error(pair.at(x, y, c)) / 3;
        ++score.count;
      }
  return score;
}

// Over the 11 x 11 pixels around (x, y); equations 13 to 16 of the paper, with the weights of its section III.B.
double similarity(const Looked& pair, int x, int y, int c) {
  const auto mean = [&](auto f) {
    double sum = 0, weights = 0;
    for (int dy = -5; dy <= 5; ++dy)
      for (int dx = -5; dx <= 5; ++dx) {
        const double w = std::exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5));
        sum += w * f(pair.at(x + dx, y + dy, c)), weights += w;
      }
    return sum / weights;
  };
  const double mr = mean([](Values v) { return v.r; }), ma = mean([](Values v) { return v.a; });
  const double vr = mean([&](Values v) { return (v.r - mr) * (v.r - mr); });
  const double va = mean([&](Values v) { return (v.a - ma) * (v.a - ma); });
  const double covariance = mean([&](Values v) { return (v.r - mr) * (v.a - ma); });
  const double c1 = 0.0001, c2 = 0.0009;
  return (2 * mr * ma + c1) * (2 * covariance + c2) / ((mr * mr + ma * ma + c1) * (vr + va + c2));
}

Score naive_ssim(const Looked& pair) {
  Score score;
  for (int y = 5; y < pair.height - 5; ++y)
    for (int x = 5; x < pair.width - 5; ++x)
      if (pair.is_good_at(x, y)) {
        for (int c = 0; c < 3; ++c) score.sum += similarity(pair, x, y, c) / 3;
        ++score.count;
      }
  return score;
}

Score naive_changes(const Looked& now, const Looked& before) {
  Score score;
  for (int y = 0; y < now.height; ++y)
    for (int x = 0; x < now.width; ++x)
      if (now.is_good_at(x, y) && before.is_good_at(x, y)) {
        for (int c = 0; c < 3; ++c) {
          const Values v = now.at(x, y, c), w = before.at(x, y, c);
          score.sum += std::pow((v.a - w.a) - (v.r - w.r), 2) / 3;
        }
        ++score.count;
      }
  return score;
}

// Every pixel of the frame before weighs by its distance: a tent of one pixel in x and y.
Score naive_warped(const Looked& now, const Looked& before, const Image& motion) {
  Score score;
  for (int y = 0; y < now.height; ++y)
    for (int x = 0; x < now.width; ++x) {
      const double px = motion ? x + static_cast<double>(motion.floats().at(x, y, 0)) : x;
      const double py = motion ? y + static_cast<double>(motion.floats().at(x, y, 1)) : y;
      bool counts = now.is_good_at(x, y) && px >= 0 && px <= now.width - 1 && py >= 0 && py <= now.height - 1;
      std::array<Values, 3> fetched;
      for (int v = 0; v < now.height && counts; ++v)
        for (int u = 0; u < now.width && counts; ++u) {
          const double weight = std::max(0.0, 1 - std::abs(u - px)) * std::max(0.0, 1 - std::abs(v - py));
          if (weight == 0) continue;
          counts = before.is_good_at(u, v);
          for (int c = 0; c < 3; ++c) {
            Values& sum = fetched[static_cast<std::size_t>(c)];
            sum.r += weight * before.at(u, v, c).r, sum.a += weight * before.at(u, v, c).a;
          }
        }
      if (!counts) continue;
      for (int c = 0; c < 3; ++c) {
        const Values v = now.at(x, y, c), was = fetched[static_cast<std::size_t>(c)];
        score.sum += (std::abs(v.a - was.a) - std::abs(v.r - was.r)) / 3;
      }
      ++score.count;
    }
  return score;
}

}  // namespace

Score naive_score(const CompareInput& input, Metric metric, DisplayTransform display) {
  const auto square = [](double x) { return x * x; };
  const auto shown = [&](const ImagePair& pair) { return Looked(pair, [&](double x) { return to_display(display, x); }); };
  const auto radiance = [&] { return Looked(input.pair, [](double x) { return x; }); };
  switch (metric) {
    case Metric::psnr:
    case Metric::mse:
      return mean_over(shown(input.pair), [&](Values v) { return square(v.a - v.r); });
    case Metric::relmse:
      return mean_over(radiance(), [&](Values v) { return square(v.a - v.r) / (square(v.r) + 0.01); });
    case Metric::smape:
      return mean_over(radiance(), [](Values v) { return std::abs(v.a - v.r) / (std::abs(v.a) + std::abs(v.r) + 0.01); });
    case Metric::ssim:
      return naive_ssim(shown(input.pair));
    case Metric::tpsnr:
      return naive_changes(shown(input.pair), shown(*input.previous));
    case Metric::warped:
      return naive_warped(shown(input.pair), shown(*input.previous), input.motion);
    case Metric::flip:
    case Metric::hdr_flip:
      break;
  }
  throw std::logic_error("FLIP has a test of its own");
}

}  // namespace quell::test
