// A camera for tests that is told by where it stands and where it looks, independent of any matrix convention.
#pragma once

#include <cmath>

#include "quell/image/item.h"

namespace quell::test::camera {

using Vector = std::array<double, 3>;

inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// A camera told by where it stands and its three axes.
struct Pose {
  Vector eye{1, -2, 3};
  Vector right, down, forward;  ///< orthonormal
};

inline Pose a_pose() {
  // Turned about two axes, so that no element of the matrices is 0.
  const double a = 0.5, b = -0.3;
  Pose pose;
  pose.right = {std::cos(a), std::sin(a), 0};
  pose.forward = {-std::sin(a) * std::cos(b), std::cos(a) * std::cos(b), std::sin(b)};
  pose.down = {pose.forward[1] * pose.right[2] - pose.forward[2] * pose.right[1],
               pose.forward[2] * pose.right[0] - pose.forward[0] * pose.right[2],
               pose.forward[0] * pose.right[1] - pose.forward[1] * pose.right[0]};
  return pose;
}

inline void set_row(Matrix& m, std::size_t row, const Vector& direction, double offset) {
  for (std::size_t i = 0; i < 3; ++i) m[4 * row + i] = direction[i];
  m[4 * row + 3] = offset;
}

inline Vector scaled(const Vector& v, double s) { return {s * v[0], s * v[1], s * v[2]}; }
inline Vector plus(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

inline constexpr Size kWhole{64, 48};
inline constexpr double kFocal = 50, kCenterX = 30, kCenterY = 25;  // pixels; the principal point is not the middle

/// What the camera files would tell of the pose. `z` is the sign of the camera space's z in front of it (its y is then chosen so
/// that both are usual: down and forward, or up and backward); `w` is a factor on world_to_screen.
inline Camera camera_of(const Pose& pose, double z = 1, double w = 1, bool orthographic = false) {
  Camera camera;
  camera.size = kWhole;
  camera.world_to_camera = kIdentity;
  set_row(camera.world_to_camera, 0, pose.right, -dot(pose.right, pose.eye));
  set_row(camera.world_to_camera, 1, scaled(pose.down, z), -z * dot(pose.down, pose.eye));
  set_row(camera.world_to_camera, 2, scaled(pose.forward, z), -z * dot(pose.forward, pose.eye));
  const Vector axis = orthographic ? Vector{} : pose.forward;
  const Vector x = plus(scaled(pose.right, kFocal), scaled(axis, kCenterX));
  const Vector y = plus(scaled(pose.down, kFocal), scaled(axis, kCenterY));
  set_row(camera.world_to_screen, 0, scaled(x, w), w * (-dot(x, pose.eye) + (orthographic ? kCenterX : 0)));
  set_row(camera.world_to_screen, 1, scaled(y, w), w * (-dot(y, pose.eye) + (orthographic ? kCenterY : 0)));
  set_row(camera.world_to_screen, 3, scaled(axis, w), orthographic ? w : -w * dot(axis, pose.eye));
  return camera;
}

}  // namespace quell::test::camera
