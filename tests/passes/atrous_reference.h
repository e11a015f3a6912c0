// The à-trous filter from the published formulas, pixel by pixel in double precision, and scenes to compare on.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "quell/testing/pass_test.h"

namespace quell::atrous_test {

using Vec = std::array<double, 3>;

inline Vec pixel(const Image& image, int x, int y) {
  const FloatImage view = image.floats();
  return {view.at(x, y, 0), view.at(x, y, 1), view.at(x, y, 2)};
}
inline Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double square(double x) { return x * x; }

// Inputs by port; those that are not there are absent.
using Scene = std::map<std::string, Image>;

struct Case {
  std::string stops = "svgf";
  int level = 0;
  Size size{33, 17};
  std::set<std::string> without = {"depth_gradient", "blurred_variance"};
  std::map<std::string, double> params = {};  // others have the defaults below
  std::string phi_color_per_level = "quartered";

  double param(const std::string& name) const {
    static const std::map<std::string, double> kDefaults{
        {"sigma_z", 1},        {"eps_z", 1e-6},      {"sigma_n", 128},    {"sigma_l", 4},      {"eps_l", 1e-8},
        {"eps_variance", 0},   {"phi_color", 1},     {"phi_normal", 0.1}, {"phi_position", 1}, {"sigma_color", 0.8},
        {"sigma_normal", 0.1}, {"sigma_plane", 0.1}, {"sigma_coord", 32}};
    return params.count(name) ? params.at(name) : kDefaults.at(name);
  }
  bool has(const std::string& input) const { return without.count(input) == 0; }
};

// Repeatable noise in [0, 1).
inline double noise(int x, int y, int c) {
  unsigned h =
      static_cast<unsigned>(x) * 374761393u + static_cast<unsigned>(y) * 668265263u + static_cast<unsigned>(c) * 2246822519u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return static_cast<double>((h ^ (h >> 16)) & 0xffffff) / 0x1000000;
}

// A wavy surface with holes, some of which still have a depth, a few fireflies, columns that face anywhere, and a step of depth
// in the middle.
inline Scene make_scene(const Case& c) {
  const auto is_hole = [](int x, int y) { return (x / 3 + y / 4) % 5 == 4; };
  const auto normal = [=](int x, int y, int k) {
    if (is_hole(x, y)) return 0.0F;
    const double a = 0.4 * noise(x / 2, y, 7) * (x % 7 == 0 ? 8 : 0.3), b = 0.7 * y + 0.2 * noise(x, y, 8);
    const Vec n{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)};
    return static_cast<float>(n[static_cast<std::size_t>(k)]);
  };
  const auto position = [](int x, int y, int k) {
    const Vec p{1e2 + 0.5 * x, -20 + 0.5 * y, 30 + 0.2 * std::sin(x + 0.5 * y) + 0.05 * noise(x, y, 3)};
    return static_cast<float>(p[static_cast<std::size_t>(k)]);
  };
  const auto depth = [=](int x, int y, int) {
    if (is_hole(x, y) && (x + y) % 3 != 0) return QUELL_NO_SURFACE_DEPTH;
    return static_cast<float>(5 + 0.05 * x - 0.1 * y + 0.02 * noise(x, y, 4) + (3 * x > y + 50 ? 7 : 0));
  };
  const auto color = [](int x, int y, int k) {
    return static_cast<float>(2 * noise(x, y, k) + (x % 11 == 5 && y % 5 == 2 ? 40 : 0));
  };
  const auto variance = [](int x, int y, int) {
    return static_cast<float>(x % 9 == 8 ? 0 : 0.3 * noise(x, y, 5) * (y % 6 == 0 ? 1e-4 : 1));
  };
  const auto slope = [](int x, int y, int) { return static_cast<float>(0.1 * noise(x, y, 6)); };
  const std::vector<std::tuple<const char*, PortType, std::function<float(int, int, int)>>> all{
      {"color", QUELL_TYPE_COLOR, color},
      {"normal", QUELL_TYPE_NORMAL, normal},
      {"position", QUELL_TYPE_POSITION, position},
      {"depth", QUELL_TYPE_DEPTH, depth},
      {"depth_gradient", QUELL_TYPE_SCALAR, slope},
      {"variance", QUELL_TYPE_VARIANCE, variance},
      {"blurred_variance", QUELL_TYPE_VARIANCE, [&](int x, int y, int k) { return 0.5F * variance(y, x, k); }}};
  Scene scene;
  for (const auto& [name, type, value] : all)
    if (c.has(name)) scene.emplace(name, test_image(type, c.size, value));
  return scene;
}

// The published formulas, pixel by pixel in double precision.
class Reference {
 public:
  Reference(const Case& c, const Scene& scene) : c_(c), scene_(scene) {}

  struct Filtered {
    Vec color;
    double variance;
  };
  Filtered filter(int x, int y) const {
    static constexpr double kB3[3] = {3.0 / 8, 1.0 / 4, 1.0 / 16};
    if (!counts(x, y)) return {pixel(image("color"), x, y), has("variance") ? at("variance", x, y) : 0};
    Vec color{};
    double weights = 0, variance = 0;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const int step = 1 << c_.level, qx = x + dx * step, qy = y + dy * step;
        if (!inside(qx, qy) || !counts(qx, qy)) continue;
        const double w = kB3[std::abs(dx)] * kB3[std::abs(dy)] * stop(x, y, qx, qy);
        const Vec q = pixel(image("color"), qx, qy);
        weights += w;
        for (std::size_t k = 0; k < 3; ++k) color[k] += w * q[k];
        if (has("variance")) variance += w * w * at("variance", qx, qy);
      }
    return {{color[0] / weights, color[1] / weights, color[2] / weights}, variance / square(weights)};
  }

 private:
  const Image& image(const std::string& name) const { return scene_.at(name); }
  bool has(const std::string& name) const { return scene_.count(name) == 1; }
  double at(const std::string& name, int x, int y) const { return image(name).floats().at(x, y); }
  double p(const std::string& name) const { return c_.param(name); }
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < c_.size.width && y < c_.size.height; }
  bool counts(int x, int y) const {
    if (has("normal") && dot(pixel(image("normal"), x, y), pixel(image("normal"), x, y)) == 0) return false;
    return c_.stops != "svgf" || !has("depth") || at("depth", x, y) < 1e10;
  }

  double stop(int x, int y, int qx, int qy) const {
    if (x == qx && y == qy) return 1;
    if (c_.stops == "svgf") return w_z(x, y, qx, qy) * w_n(x, y, qx, qy) * w_l(x, y, qx, qy);
    return c_.stops == "dammertz" ? dammertz(x, y, qx, qy) : joint_bilateral(x, y, qx, qy);
  }

  // Schied et al.
  double w_z(int x, int y, int qx, int qy) const {
    if (!has("depth")) return 1;
    const double explained = has("depth_gradient") ? at("depth_gradient", x, y) * std::hypot(qx - x, qy - y)
                                                   : std::abs(slope(x, y, 1, 0) * (qx - x) + slope(x, y, 0, 1) * (qy - y));
    const double z = at("depth", x, y);
    return std::exp(-std::abs(z - at("depth", qx, qy)) / (p("sigma_z") * explained + p("eps_z") * z));
  }
  // The smaller of the two differences along an axis, of those that there are.
  double slope(int x, int y, int ax, int ay) const {
    double smaller = std::numeric_limits<double>::infinity();
    for (const int side : {-1, 1}) {
      const int qx = x + side * ax, qy = y + side * ay;
      if (!inside(qx, qy) || at("depth", qx, qy) >= 1e10) continue;
      const double change = side * (at("depth", qx, qy) - at("depth", x, y));
      if (std::abs(change) < std::abs(smaller)) smaller = change;
    }
    return std::isinf(smaller) ? 0 : smaller;
  }
  double w_n(int x, int y, int qx, int qy) const {
    if (!has("normal")) return 1;
    return std::pow(std::max(0.0, dot(pixel(image("normal"), x, y), pixel(image("normal"), qx, qy))), p("sigma_n"));
  }
  double luminance(int x, int y) const { return dot(pixel(image("color"), x, y), {0.2126, 0.7152, 0.0722}); }
  double w_l(int x, int y, int qx, int qy) const {
    if (!has("variance") && !has("blurred_variance")) return 1;
    const double variance = has("blurred_variance") ? at("blurred_variance", x, y) : blurred(x, y);
    return std::exp(-std::abs(luminance(x, y) - luminance(qx, qy)) /
                    (p("sigma_l") * std::sqrt(variance + p("eps_variance")) + p("eps_l")));
  }
  double blurred(int x, int y) const {
    double sum = 0, weights = 0;
    for (int qy = y - 1; qy <= y + 1; ++qy)
      for (int qx = x - 1; qx <= x + 1; ++qx) {
        if (!inside(qx, qy)) continue;
        const double w = (qx == x ? 2 : 1) * (qy == y ? 2 : 1);
        sum += w * at("variance", qx, qy), weights += w;
      }
    return sum / weights;
  }

  // Dammertz et al.
  double dammertz(int x, int y, int qx, int qy) const {
    const int halvings = c_.phi_color_per_level == "same" ? 0 : c_.phi_color_per_level == "halved" ? 1 : 2;
    double e = squared("color", x, y, qx, qy) / (p("phi_color") * std::pow(0.5, halvings * c_.level));
    if (has("normal")) e += squared("normal", x, y, qx, qy) / std::pow(4.0, c_.level) / p("phi_normal");
    if (has("position")) e += squared("position", x, y, qx, qy) / p("phi_position");
    return std::exp(-e);
  }
  double squared(const std::string& name, int x, int y, int qx, int qy) const {
    const Vec d = pixel(image(name), qx, qy) - pixel(image(name), x, y);
    return dot(d, d);
  }

  // The course's. The formula is about the unit vectors that the rounded normals mean.
  double joint_bilateral(int x, int y, int qx, int qy) const {
    double e = (square(qx - x) + square(qy - y)) / (2 * square(p("sigma_coord")));
    e += squared("color", x, y, qx, qy) / (2 * square(p("sigma_color")));
    if (!has("normal")) return std::exp(-e);
    const Vec n = pixel(image("normal"), x, y), m = pixel(image("normal"), qx, qy);
    const double cosine = dot(n, m) / std::sqrt(dot(n, n) * dot(m, m));
    e += square(std::acos(std::min(1.0, std::max(-1.0, cosine)))) / (2 * square(p("sigma_normal")));
    if (!has("position")) return std::exp(-e);
    const Vec d = pixel(image("position"), qx, qy) - pixel(image("position"), x, y);
    if (dot(d, d) > 0) e += square(dot(n, d)) / dot(d, d) / (2 * square(p("sigma_plane")));
    return std::exp(-e);
  }

  const Case& c_;
  const Scene& scene_;
};

}  // namespace quell::atrous_test
