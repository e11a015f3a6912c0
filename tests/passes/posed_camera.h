// Cameras with a known pose for tests of back projection: points on a pixel's ray are found from the pose alone, without
// matrices.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "quell/image/item.h"

namespace quell::test {

using Vector = std::array<double, 3>;

inline Vector sum(const Vector& a, double f, const Vector& b) { return {a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]}; }
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Turned about the world's y by `yaw`, then about its own right by `pitch`; x right, y down, z forward when both are 0.
struct PosedCamera {
  Vector eye{};
  double yaw = 0, pitch = 0;
  double focal = 100;  ///< px; of an orthographic camera, pixels a world unit
  bool orthographic = false;
  double z_sign = 1;   ///< -1: camera space has z backward and y up, as OpenGL has it
  double w_scale = 1;  ///< of world_to_screen, which may be scaled as a whole
  std::array<double, 2> jitter{};
  Size size{33, 17};

  Vector right() const { return {std::cos(yaw), 0, -std::sin(yaw)}; }
  Vector forward() const { return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)}; }
  Vector down() const { return {-std::sin(yaw) * std::sin(pitch), std::cos(pitch), -std::cos(yaw) * std::sin(pitch)}; }

  double depth(const Vector& p) const { return dot(forward(), sum(p, -1, eye)); }
  /// Where a screen of `size` without jitter shows the point.
  std::array<double, 2> pixel(const Vector& p) const {
    const Vector from_eye = sum(p, -1, eye);
    const double scale = focal / (orthographic ? 1 : depth(p));
    return {size.width / 2.0 + scale * dot(right(), from_eye), size.height / 2.0 + scale * dot(down(), from_eye)};
  }
  /// The point at that depth whose sample lies at (u, v) of the jittered screen.
  Vector point(double u, double v, double depth) const {
    const double scale = (orthographic ? 1 : depth) / focal;
    Vector p = sum(eye, depth, forward());
    p = sum(p, scale * (u - jitter[0] - size.width / 2.0), right());
    return sum(p, scale * (v - jitter[1] - size.height / 2.0), down());
  }

  Camera camera() const {
    Camera c;
    c.size = size, c.jitter = jitter;
    set_row(c.world_to_camera, 0, 1, right());
    set_row(c.world_to_camera, 1, z_sign, down());
    set_row(c.world_to_camera, 2, z_sign, forward());
    const std::array<double, 2> center{size.width / 2.0 + jitter[0], size.height / 2.0 + jitter[1]};
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector axis = sum({}, focal, i == 0 ? right() : down());
      set_row(c.world_to_screen, i, w_scale, orthographic ? axis : sum(axis, center[i], forward()));
      if (orthographic) c.world_to_screen[4 * i + 3] += w_scale * center[i];
    }
    set_row(c.world_to_screen, 2, 0, {});
    set_row(c.world_to_screen, 3, orthographic ? 0 : w_scale, forward());
    if (orthographic) c.world_to_screen[15] = w_scale;
    return c;
  }

 private:
  // scale axis . (p - eye)
  void set_row(Matrix& m, std::size_t row, double scale, const Vector& axis) const {
    for (std::size_t i = 0; i < 3; ++i) m[4 * row + i] = scale * axis[i];
    m[4 * row + 3] = -scale * dot(axis, eye);
  }
};

}  // namespace quell::test
