#include "tests/graphs/svgf_reference.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

namespace quell::svgf_reference {
namespace {

constexpr double kNoSurface = 1e10;

double luminance(const Vec& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
void add(Vec& sum, double weight, const Vec& v) {
  for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * v[c];
}
Vec over(const Vec& v, double divisor) { return {v[0] / divisor, v[1] / divisor, v[2] / divisor}; }
Vec color_at(const FloatImage& image, int x, int y) { return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)}; }

// Calls change(neighbor x, y) for the neighbors on both sides along an axis that are in the image and on a surface.
template <class Change>
void for_neighbors(const Plane<double>& depth, int x, int y, int ax, int ay, const Change& change) {
  for (const int side : {-1, 1})
    if (depth.contains(x + side * ax, y + side * ay) && depth.at(x + side * ax, y + side * ay) < kNoSurface)
      change(x + side * ax, y + side * ay);
}

// The smaller of the one-sided differences along an axis; 0 without any.
double depth_change(const Plane<double>& depth, int x, int y, int ax, int ay) {
  double smallest = std::numeric_limits<double>::infinity();
  for_neighbors(depth, x, y, ax, ay,
                [&](int qx, int qy) { smallest = std::min(smallest, std::abs(depth.at(qx, qy) - depth.at(x, y))); });
  return std::isinf(smallest) ? 0 : smallest;
}

// Length of |dn/dx| + |dn/dy|, component by component, each by the neighbor whose normal is nearest.
double normal_change(const Plane<double>& depth, const Plane<Vec>& normal, int x, int y) {
  Vec widths{};
  for (const auto& [ax, ay] : {std::pair{1, 0}, std::pair{0, 1}}) {
    Vec nearest{};
    double smallest = std::numeric_limits<double>::infinity();
    for_neighbors(depth, x, y, ax, ay, [&](int qx, int qy) {
      const Vec change = minus(normal.at(qx, qy), normal.at(x, y));
      if (dot(change, change) < smallest) smallest = dot(change, change), nearest = change;
    });
    for (std::size_t c = 0; c < 3; ++c) widths[c] += std::abs(nearest[c]);
  }
  return std::sqrt(dot(widths, widths));
}

// Falcor's weight of a tap, without the spline: differences of depth and luminance over what is tolerated, and a power of the
// normals' cosine. What is not tolerated at all (phi 0) counts only where it does not differ.
double weigh(double depth_difference, double phi_depth, const Vec& n, const Vec& m, double power, double luminance_difference,
             double phi_luminance) {
  const double w_n = std::pow(std::max(0.0, dot(n, m)), power);
  const double z = phi_depth > 0 ? std::abs(depth_difference) / phi_depth : 0;
  return w_n * std::exp(-z - std::abs(luminance_difference) / phi_luminance);
}

// Taps outside and taps without surface do not count.
bool counts(const Plane<double>& depth, int x, int y) { return depth.contains(x, y) && depth.at(x, y) < kNoSurface; }

}  // namespace

Svgf::Guides Svgf::read_guides(const Frame& frame) {
  const int w = frame.depth.width, h = frame.depth.height;
  Guides g{{w, h}, {w, h}, {w, h}, {w, h}};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      g.depth.at(x, y) = frame.depth.at(x, y);
      g.normal.at(x, y) = color_at(frame.normal, x, y);
    }
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (g.depth.at(x, y) >= kNoSurface) continue;
      g.depth_change.at(x, y) = std::max(depth_change(g.depth, x, y, 1, 0), depth_change(g.depth, x, y, 0, 1));
      g.normal_change.at(x, y) = normal_change(g.depth, g.normal, x, y);
    }
  return g;
}

Plane<Vec> Svgf::demodulate(const Frame& frame) const {
  Plane<Vec> light(frame.color.width, frame.color.height);
  for (int y = 0; y < light.height; ++y)
    for (int x = 0; x < light.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const double reflected = double{frame.color.at(x, y, c)} - double{frame.emission.at(x, y, c)};
        light.at(x, y)[static_cast<std::size_t>(c)] =
            reflected / std::max(double{frame.albedo.at(x, y, c)}, settings_.smallest_albedo);
      }
  return light;
}

bool Svgf::is_consistent(const Guides& g, int x, int y, int tap_x, int tap_y) const {
  if (!before_.depth.contains(tap_x, tap_y)) return false;
  const double depth_off = std::abs(before_.depth.at(tap_x, tap_y) - g.depth.at(x, y)) / (g.depth_change.at(x, y) + 1e-2);
  const Vec turn = minus(g.normal.at(x, y), before_.normal.at(tap_x, tap_y));
  return depth_off <= 10 && std::sqrt(dot(turn, turn)) / (g.normal_change.at(x, y) + 1e-2) <= 16;
}

Svgf::Past Svgf::look_back(const Frame& frame, const Guides& g, int x, int y) const {
  Past past;
  if (before_.depth.pixels.empty()) return past;
  const double px = x + 0.5 + double{frame.motion.at(x, y, 0)}, py = y + 0.5 + double{frame.motion.at(x, y, 1)};
  if (!(std::abs(px) < 1e5 && std::abs(py) < 1e5)) return past;
  double weights = 0;
  const auto take = [&](int tx, int ty, double w) {
    if (w == 0 || !is_consistent(g, x, y, tx, ty)) return;
    weights += w;
    add(past.light, w, before_.light.at(tx, ty));
    past.first += w * before_.first.at(tx, ty);
    past.second += w * before_.second.at(tx, ty);
    past.length += w * before_.length.at(tx, ty);
  };
  const int left = static_cast<int>(std::floor(px - 0.5)), top = static_cast<int>(std::floor(py - 0.5));
  const double fx = px - 0.5 - left, fy = py - 0.5 - top;
  take(left, top, (1 - fx) * (1 - fy));
  take(left + 1, top, fx * (1 - fy));
  take(left, top + 1, (1 - fx) * fy);
  take(left + 1, top + 1, fx * fy);
  if (weights < 0.01) {
    past = {}, weights = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) take(static_cast<int>(std::floor(px)) + dx, static_cast<int>(std::floor(py)) + dy, 1);
  }
  if (weights == 0) return {};
  return {true, over(past.light, weights), past.first / weights, past.second / weights, past.length / weights};
}

Plane<double> Svgf::estimate_variance(const Guides& g, const History& now, Plane<Vec>& light) const {
  const Plane<Vec> from = light;
  Plane<double> variance(light.width, light.height);
  for (int y = 0; y < light.height; ++y)
    for (int x = 0; x < light.width; ++x) {
      double first = now.first.at(x, y), second = now.second.at(x, y), boost = 1;
      const double length = now.length.at(x, y);
      if (length < settings_.short_length && counts(g.depth, x, y)) {
        Vec sum{};
        double weights = 0, sum1 = 0, sum2 = 0;
        for (int qy = y - 3; qy <= y + 3; ++qy)
          for (int qx = x - 3; qx <= x + 3; ++qx) {
            if (!counts(g.depth, qx, qy)) continue;
            const double phi_depth = std::max(g.depth_change.at(x, y), 1e-8) * 3 * std::hypot(qx - x, qy - y);
            const double w =
                weigh(g.depth.at(qx, qy) - g.depth.at(x, y), phi_depth, g.normal.at(x, y), g.normal.at(qx, qy),
                      settings_.phi_normal, luminance(from.at(qx, qy)) - luminance(from.at(x, y)), settings_.phi_color);
            weights += w;
            add(sum, w, from.at(qx, qy));
            sum1 += w * now.first.at(qx, qy);
            sum2 += w * now.second.at(qx, qy);
          }
        if (weights > 0) {
          light.at(x, y) = over(sum, weights);
          first = sum1 / weights, second = sum2 / weights;
        }
        boost = settings_.short_length / length;
      }
      variance.at(x, y) = boost * std::max(0.0, second - first * first);
    }
  return variance;
}

void Svgf::filter_level(const Guides& g, int level, Plane<Vec>& light, Plane<double>& variance) const {
  static constexpr double kSpline[3] = {1, 2.0 / 3, 1.0 / 6};
  static constexpr double kBlur[2] = {1.0 / 2, 1.0 / 4};
  const Plane<Vec> from = light;
  const Plane<double> noise = variance;
  const int step = 1 << level;
  for (int y = 0; y < light.height; ++y)
    for (int x = 0; x < light.width; ++x) {
      if (!counts(g.depth, x, y)) continue;
      double blurred = 0;  // what lies outside is 0
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (noise.contains(x + dx, y + dy)) blurred += kBlur[std::abs(dx)] * kBlur[std::abs(dy)] * noise.at(x + dx, y + dy);
      const double phi_luminance = settings_.phi_color * std::sqrt(std::max(0.0, 1e-10 + blurred));
      Vec sum{};
      double weights = 0, squares = 0;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
          const int qx = x + dx * step, qy = y + dy * step;
          if (!counts(g.depth, qx, qy)) continue;
          const double phi_depth = std::max(g.depth_change.at(x, y), 1e-8) * step * std::hypot(dx, dy);
          const double stop = dx == 0 && dy == 0 ? 1
                                                 : weigh(g.depth.at(qx, qy) - g.depth.at(x, y), phi_depth, g.normal.at(x, y),
                                                         g.normal.at(qx, qy), settings_.phi_normal,
                                                         luminance(from.at(qx, qy)) - luminance(from.at(x, y)), phi_luminance);
          const double w = kSpline[std::abs(dx)] * kSpline[std::abs(dy)] * stop;
          weights += w;
          add(sum, w, from.at(qx, qy));
          squares += w * w * noise.at(qx, qy);
        }
      light.at(x, y) = over(sum, weights);
      variance.at(x, y) = squares / (weights * weights);
    }
}

Plane<Vec> Svgf::filter(const Frame& frame) {
  const Guides g = read_guides(frame);
  Plane<Vec> light = demodulate(frame);
  const int w = light.width, h = light.height;
  History now{{w, h}, g.normal, {w, h}, {w, h}, {w, h}, g.depth};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const Past past = look_back(frame, g, x, y);
      const double length = past.found ? std::min(settings_.max_length, past.length + 1) : 1;
      const double alpha = past.found ? std::max(settings_.alpha, 1 / length) : 1;
      const double moments_alpha = past.found ? std::max(settings_.moments_alpha, 1 / length) : 1;
      const double l = luminance(light.at(x, y));
      now.length.at(x, y) = length;
      now.first.at(x, y) = moments_alpha * l + (1 - moments_alpha) * past.first;
      now.second.at(x, y) = moments_alpha * l * l + (1 - moments_alpha) * past.second;
      for (std::size_t c = 0; c < 3; ++c) light.at(x, y)[c] = alpha * light.at(x, y)[c] + (1 - alpha) * past.light[c];
    }
  Plane<double> variance = estimate_variance(g, now, light);
  for (int level = 0; level < settings_.levels; ++level) {
    filter_level(g, level, light, variance);
    if (level == settings_.feedback_level) now.light = light;
  }
  before_ = std::move(now);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (int c = 0; c < 3; ++c) {
        double& value = light.at(x, y)[static_cast<std::size_t>(c)];
        value = value * double{frame.albedo.at(x, y, c)} + double{frame.emission.at(x, y, c)};
      }
  return light;
}

}  // namespace quell::svgf_reference
