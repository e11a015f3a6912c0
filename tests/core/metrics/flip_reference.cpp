#include "tests/core/metrics/flip_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace quell::flip_test {
namespace {

using Vec = std::array<double, 3>;
using Matrix = std::array<Vec, 3>;

Vec operator*(const Matrix& m, const Vec& v) {
  Vec result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[i] += m[i][j] * v[j];
  return result;
}

// Cramer's rule.
Vec solve(const Matrix& m, const Vec& right) {
  const auto det = [](const Matrix& a) {
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
  };
  Vec result{};
  for (std::size_t j = 0; j < 3; ++j) {
    Matrix replaced = m;
    for (std::size_t i = 0; i < 3; ++i) replaced[i][j] = right[i];
    result[j] = det(replaced) / det(m);
  }
  return result;
}

// XYZ of linear sRGB: columns are the primaries of BT.709, scaled so that they add up to the white of D65.
struct Space {
  Matrix to_xyz;
  Vec white;
};
const Space& space() {
  static const Space result = [] {
    const auto xyz = [](double x, double y) { return Vec{x / y, 1, (1 - x - y) / y}; };
    const std::array<Vec, 3> primaries{xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06)};
    const Vec white = xyz(0.31271, 0.32902);
    Matrix columns{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) columns[i][j] = primaries[j][i];
    const Vec scale = solve(columns, white);
    for (Vec& row : columns)
      for (std::size_t j = 0; j < 3; ++j) row[j] *= scale[j];
    return Space{columns, white};
  }();
  return result;
}

Vec to_ycxcz(const Vec& rgb) {
  Vec t = space().to_xyz * rgb;
  for (std::size_t i = 0; i < 3; ++i) t[i] /= space().white[i];
  return {116 * t[1] - 16, 500 * (t[0] - t[1]), 200 * (t[1] - t[2])};
}
Vec to_rgb(const Vec& ycxcz) {
  const double y = (ycxcz[0] + 16) / 116;
  const Vec t{y + ycxcz[1] / 500, y, y - ycxcz[2] / 200};
  return solve(space().to_xyz, {t[0] * space().white[0], t[1] * space().white[1], t[2] * space().white[2]});
}

// CIELAB, with a and b made smaller in the dark (Hunt).
Vec to_adjusted_lab(const Vec& rgb) {
  const double delta = 6.0 / 29;
  Vec f = space().to_xyz * rgb;
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = f[i] / space().white[i];
    f[i] = t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  }
  const double l = 116 * f[1] - 16;
  return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}
double hyab(const Vec& a, const Vec& b) { return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }

// A filter of two dimensions.
struct Kernel {
  int radius;
  std::vector<double> weights;
  double& at(int x, int y) { return weights[static_cast<std::size_t>((y + radius) * (2 * radius + 1) + x + radius)]; }
  double at(int x, int y) const { return const_cast<Kernel*>(this)->at(x, y); }
};
Kernel make_kernel(int radius, const std::function<double(int x, int y)>& weight) {
  Kernel kernel{radius, std::vector<double>(static_cast<std::size_t>((2 * radius + 1) * (2 * radius + 1)))};
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x) kernel.at(x, y) = weight(x, y);
  return kernel;
}
// Positive weights then sum to 1, negative ones to -1.
Kernel normalized(Kernel kernel) {
  double positive = 0, negative = 0;
  for (const double w : kernel.weights) (w > 0 ? positive : negative) += std::abs(w);
  for (double& w : kernel.weights)
    if (w != 0) w /= w > 0 ? positive : negative;
  return kernel;
}

struct Kernels {
  std::array<Kernel, 3> sensitivity;
  Kernel edge_x, edge_y, point_x, point_y;
};
Kernels make_kernels(double ppd) {
  const double pi = std::acos(-1.0);
  const auto gauss = [=](double d2, double a, double b) { return a * std::sqrt(pi / b) * std::exp(-pi * pi * d2 / b); };
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
  const auto sensitivity = [&](double a1, double b1, double a2, double b2) {
    return normalized(make_kernel(radius, [&](int x, int y) {
      const double d2 = (x * x + y * y) / (ppd * ppd);
      return gauss(d2, a1, b1) + (a2 > 0 ? gauss(d2, a2, b2) : 0);
    }));
  };
  const double sd = 0.5 * 0.082 * ppd;
  const int reach = static_cast<int>(std::ceil(3 * sd));
  const auto bell = [=](int x, int y) { return std::exp(-(x * x + y * y) / (2 * sd * sd)); };
  const auto first = [=](int along, int x, int y) { return -along * bell(x, y); };
  const auto second = [=](int along, int x, int y) { return (along * along / (sd * sd) - 1) * bell(x, y); };
  return {{sensitivity(1, 0.0047, 0, 1), sensitivity(1, 0.0053, 0, 1), sensitivity(34.1, 0.04, 13.5, 0.025)},
          normalized(make_kernel(reach, [=](int x, int y) { return first(x, x, y); })),
          normalized(make_kernel(reach, [=](int x, int y) { return first(y, x, y); })),
          normalized(make_kernel(reach, [=](int x, int y) { return second(x, x, y); })),
          normalized(make_kernel(reach, [=](int x, int y) { return second(y, x, y); }))};
}

struct Picture {
  int width, height;
  std::vector<Vec> pixels;  // YCxCz
  // Beyond the borders, the nearest pixel.
  double at(int x, int y, std::size_t c) const {
    const int inside = std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1);
    return pixels[static_cast<std::size_t>(inside)][c];
  }
};
double convolve(const Picture& picture, std::size_t c, const Kernel& kernel, int x, int y) {
  double sum = 0;
  for (int dy = -kernel.radius; dy <= kernel.radius; ++dy)
    for (int dx = -kernel.radius; dx <= kernel.radius; ++dx) sum += kernel.at(dx, dy) * picture.at(x + dx, y + dy, c);
  return sum;
}

Vec seen_color(const Picture& picture, const Kernels& kernels, int x, int y) {
  Vec ycxcz{};
  for (std::size_t c = 0; c < 3; ++c) ycxcz[c] = convolve(picture, c, kernels.sensitivity[c], x, y);
  Vec rgb = to_rgb(ycxcz);
  for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
  return to_adjusted_lab(rgb);
}
double size_of(const Picture& picture, const Kernel& kx, const Kernel& ky, int x, int y) {
  return std::hypot(convolve(picture, 0, kx, x, y), convolve(picture, 0, ky, x, y)) / 116;
}

using ToDisplay = std::function<double(double)>;

Picture make_ycxcz(const Image& image, const ToDisplay& to_display) {
  Picture picture{image.width(), image.height(), {}};
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      Vec rgb{};
      for (int c = 0; c < 3; ++c) rgb[static_cast<std::size_t>(c)] = std::clamp(to_display(image.floats().at(x, y, c)), 0.0, 1.0);
      picture.pixels.push_back(to_ycxcz(rgb));
    }
  return picture;
}

std::vector<Expected> compute(const Image& reference, const Image& image, const ToDisplay& to_display, double ppd) {
  const Kernels k = make_kernels(ppd);
  const Picture a = make_ycxcz(reference, to_display), b = make_ycxcz(image, to_display);
  std::vector<Expected> result;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const double edge = std::abs(size_of(a, k.edge_x, k.edge_y, x, y) - size_of(b, k.edge_x, k.edge_y, x, y));
      const double point = std::abs(size_of(a, k.point_x, k.point_y, x, y) - size_of(b, k.point_x, k.point_y, x, y));
      result.push_back({hyab(seen_color(a, k, x, y), seen_color(b, k, x, y)), std::max(edge, point) / std::sqrt(2.0)});
    }
  return result;
}

// Narkowicz' fit of the ACES curve, of 0.6 times the radiance.
double tone_curve(double radiance) {
  const double x = 0.6 * std::max(radiance, 0.0);
  return std::min(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));
}

double error_of(double hyab_distance, double feature) {
  const double largest = std::pow(hyab(to_adjusted_lab({0, 1, 0}), to_adjusted_lab({0, 0, 1})), 0.7);
  const double knee = 0.4 * largest, difference = std::pow(hyab_distance, 0.7);
  const double color = difference < knee ? difference / knee * 0.95 : 0.95 + (difference - knee) / (largest - knee) * (1 - 0.95);
  return std::pow(color, 1 - std::sqrt(feature));
}

}  // namespace

double Expected::error() const { return error_of(hyab, feature); }

std::array<double, 2> Expected::error_range(double hyab_off, double feature_off) const {
  return {error_of(std::max(0.0, hyab - hyab_off), std::max(0.0, feature - feature_off)),
          error_of(hyab + hyab_off, std::min(1.0, feature + feature_off))};
}

std::vector<Expected> reference_flip(const Image& reference, const Image& image, double pixels_per_degree) {
  return compute(
      reference, image, [](double value) { return value; }, pixels_per_degree);
}

std::vector<Expected> reference_flip_at(const Image& reference, const Image& image, double stop, double pixels_per_degree) {
  return compute(
      reference, image, [=](double radiance) { return tone_curve(radiance * std::exp2(stop)); }, pixels_per_degree);
}

double reference_stop(double luminance) {
  double low = -200, high = 200;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (tone_curve(luminance * std::exp2(middle)) < 0.85 ? low : high) = middle;
  }
  return low;
}

}  // namespace quell::flip_test
