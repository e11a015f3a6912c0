#include "quell/metrics/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "quell/text/error.h"

namespace quell {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNegligible = 1e-8;  // of a filter's sum: a sixth of float's rounding

// Table 1: a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees.
struct Sensitivity {
  double a, b;
};
constexpr Sensitivity kLuma{1, 0.0047}, kRedGreen{1, 0.0053};
constexpr std::array<Sensitivity, 2> kBlueYellow{{{34.1, 0.04}, {13.5, 0.025}}};

using Weights = std::vector<double>;

// Both sides.
double sum(const Weights& weights) {
  double total = weights[0];
  for (std::size_t i = 1; i < weights.size(); ++i) total += 2 * weights[i];
  return total;
}
Weights gaussian(int radius, double exponent) {
  Weights weights;
  for (int i = 0; i <= radius; ++i) weights.push_back(std::exp(-exponent * i * i));
  return weights;
}
HalfFilter scaled(const Weights& weights, double factor) {
  HalfFilter filter;
  for (const double w : weights) filter.push_back(static_cast<float>(w * factor));
  return filter;
}

double exponent(Sensitivity s, double pixels_per_degree) { return kPi * kPi / (s.b * pixels_per_degree * pixels_per_degree); }

HalfFilter blur(Sensitivity s, int radius, double pixels_per_degree) {
  Weights weights = gaussian(radius, exponent(s, pixels_per_degree));
  const double factor = 1 / sum(weights);
  double rest = 0;
  while (weights.size() > 1 && (rest += 2 * factor * weights.back()) < kNegligible) weights.pop_back();
  return scaled(weights, factor);
}

std::array<HalfFilter, 2> blue_yellow_blur(int radius, double pixels_per_degree) {
  std::array<Weights, 2> weights;
  std::array<double, 2> share;  // of the height of the sum at its center
  double total = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    weights[i] = gaussian(radius, exponent(kBlueYellow[i], pixels_per_degree));
    share[i] = kBlueYellow[i].a * std::sqrt(kPi / kBlueYellow[i].b);
    total += share[i] * sum(weights[i]) * sum(weights[i]);
  }
  return {scaled(weights[0], std::sqrt(share[0] / total)), scaled(weights[1], std::sqrt(share[1] / total))};
}

// Of the second derivative: the positive weights, which lie beyond the standard deviation, then sum to 1, the others to -1.
HalfFilter balanced(const Weights& weights) {
  double positive = 0, negative = 0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    (weights[i] > 0 ? positive : negative) += (i == 0 ? 1 : 2) * std::abs(weights[i]);
  HalfFilter filter;
  for (const double w : weights) filter.push_back(static_cast<float>(w == 0 ? 0 : w / (w > 0 ? positive : negative)));
  return filter;
}

Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}

Matrix3 inverse(const Matrix3& m) {
  Matrix3 cofactors{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactors[j][i] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
    }
  const double determinant = m[0][0] * cofactors[0][0] + m[0][1] * cofactors[1][0] + m[0][2] * cofactors[2][0];
  for (auto& row : cofactors)
    for (double& value : row) value /= determinant;
  return cofactors;
}

Matrix3 white_relative(const Matrix3& m) {
  Matrix3 relative = m;
  for (auto& row : relative) {
    const double white = row[0] + row[1] + row[2];
    for (double& value : row) value /= white;
  }
  return relative;
}

std::array<double, 3> hunt_adjusted_lab(const std::array<double, 3>& rgb) {
  std::array<double, 3> f{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = kRgbToXyz[i][0] * rgb[0] + kRgbToXyz[i][1] * rgb[1] + kRgbToXyz[i][2] * rgb[2];
    f[i] = t > 216.0 / 24389 ? std::cbrt(t) : (t * 24389 / 27 + 16) / 116;
  }
  const double l = 116 * f[1] - 16;
  return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

}  // namespace

FlipFilters::FlipFilters(double pixels_per_degree) {
  if (!(pixels_per_degree >= 1 && pixels_per_degree <= 1000))
    throw Error(Fault::usage, "pixels per degree", std::to_string(pixels_per_degree) + " is not within 1..1000");
  // All four blurs have the radius of the widest, as the paper's program has it.
  const double widest = std::sqrt(kBlueYellow[0].b / (2 * kPi * kPi)) * pixels_per_degree;
  const int blur_radius = static_cast<int>(std::ceil(3 * widest));
  luma = blur(kLuma, blur_radius, pixels_per_degree);
  red_green = blur(kRedGreen, blur_radius, pixels_per_degree);
  blue_yellow = blue_yellow_blur(blur_radius, pixels_per_degree);

  const double sigma = kFlipFeatureWidth * pixels_per_degree / 2;
  const int feature_radius = static_cast<int>(std::ceil(3 * sigma));
  const Weights bell = gaussian(feature_radius, 1 / (2 * sigma * sigma));
  Weights first, second;
  for (int i = 0; i <= feature_radius; ++i) {
    const double g = bell[static_cast<std::size_t>(i)];
    first.push_back(-i * g);
    second.push_back((i * i / (sigma * sigma) - 1) * g);
  }
  double first_sum = 0;
  for (const double w : first) first_sum -= w;
  smooth = scaled(bell, 1 / sum(bell));
  edge = scaled(first, 1 / first_sum);
  point = balanced(second);
  radius = std::max(blur_radius, feature_radius);
}

// From the chromaticities of ITU-R BT.709: red (.64, .33), green (.30, .60), blue (.15, .06),
// and the white of the paper's program.
const Matrix3 kRgbToXyz = white_relative({{{0.41238656325299, 0.35759149092062, 0.18045049120356},
                                           {0.21263682167732, 0.71518298184124, 0.07218019648142},
                                           {0.01933062015248, 0.11919716364021, 0.95037258700543}}});
const Matrix3 kRgbToOpponent = product({{{0, 1, 0}, {1, -1, 0}, {0, 1, -1}}}, kRgbToXyz);
const Matrix3 kOpponentToRgb = inverse(kRgbToOpponent);

FlipRange flip_range() {
  const auto green = hunt_adjusted_lab({0, 1, 0}), blue = hunt_adjusted_lab({0, 0, 1});
  const double hyab = std::abs(green[0] - blue[0]) + std::hypot(green[1] - blue[1], green[2] - blue[2]);
  const double largest = std::pow(hyab, kFlipColorPower);
  return {kFlipKnee * largest, largest};
}

}  // namespace quell
