#include "quell/sequence/checks/geometry.h"

#include <cmath>

namespace quell {
namespace {

bool has_size(const std::optional<CheckedImage>& input, Size size) { return input && input->image.size() == size; }

}  // namespace

Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

double length(Vec3 a) { return std::sqrt(dot(a, a)); }

bool is_finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

std::array<double, 4> transform(const Matrix& m, Vec3 p, double w) {
  std::array<double, 4> result{};
  for (std::size_t row = 0; row < 4; ++row)
    result[row] = m[4 * row] * p.x + m[4 * row + 1] * p.y + m[4 * row + 2] * p.z + m[4 * row + 3] * w;
  return result;
}

std::optional<Matrix> inverted(const Matrix& m) {
  if (!is_invertible(m)) return std::nullopt;
  return inverse(m);
}

std::optional<Seen> project(const Matrix& world_to_screen, Vec3 p, double w) {
  const auto screen = transform(world_to_screen, p, w);
  if (!(screen[3] > 0)) return std::nullopt;
  return Seen{screen[0] / screen[3], screen[1] / screen[3], screen[3]};
}

std::optional<Viewpoint> Viewpoint::of(const Camera& camera) {
  const auto camera_to_world = inverted(camera.world_to_camera), screen_to_world = inverted(camera.world_to_screen);
  if (!camera_to_world || !screen_to_world) return std::nullopt;
  Viewpoint viewpoint;
  const auto eye = transform(*camera_to_world, {});
  viewpoint.eye_ = {eye[0] / eye[3], eye[1] / eye[3], eye[2] / eye[3]};
  viewpoint.screen_to_world_ = *screen_to_world;
  viewpoint.world_to_screen_ = camera.world_to_screen;
  return viewpoint;
}

Vec3 Viewpoint::direction(double x, double y) const {
  // Two points that are seen there, at whatever depth the third component stands for; homogeneous, so that either may be at
  // infinity.
  const auto a = transform(screen_to_world_, {x, y, 0.25}), b = transform(screen_to_world_, {x, y, 0.75});
  const Vec3 along{a[0] * b[3] - b[0] * a[3], a[1] * b[3] - b[1] * a[3], a[2] * b[3] - b[2] * a[3]};
  return transform(world_to_screen_, along, 0)[3] < 0 ? -1.0 * along : along;
}

Surfaces::Surfaces(const FrameData& frame, Size size) {
  if (has_size(frame.id, size)) ids_ = frame.id->image.ids();
  if (has_size(frame.depth, size)) depth_ = frame.depth->image.floats();
  if (has_size(frame.position, size)) positions_ = frame.position->image.floats();
  if (!frame.camera || frame.camera->size != size) return;
  viewpoint_ = Viewpoint::of(*frame.camera);
  world_to_screen_ = frame.camera->world_to_screen;
}

bool Surfaces::has(int x, int y) const {
  if (ids_ && ids_.at(x, y) == QUELL_NO_ID) return false;
  if (depth_ && !(depth_.at(x, y) > 0 && depth_.at(x, y) < QUELL_NO_SURFACE_DEPTH)) return false;
  if (!positions_) return true;
  const Vec3 p = vector_at(positions_, x, y);
  return is_finite(p) && (p.x != 0 || p.y != 0 || p.z != 0);
}

Vec3 Surfaces::point(int x, int y) const {
  if (positions_) return vector_at(positions_, x, y);
  const Vec3 along = viewpoint_->direction(x + 0.5, y + 0.5);
  return viewpoint_->eye() + (depth_.at(x, y) / transform(world_to_screen_, along, 0)[3]) * along;
}

}  // namespace quell
