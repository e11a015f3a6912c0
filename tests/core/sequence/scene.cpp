#include "tests/core/sequence/scene.h"

#include <algorithm>
#include <cmath>

#include "quell/sequence/convert.h"

namespace quell::test {
namespace {

Triple add(const Triple& a, double s, const Triple& b) { return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]}; }
Triple minus(const Triple& a, const Triple& b) { return add(a, -1, b); }
double inner(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Triple unit(const Triple& a) { return add({}, 1 / std::sqrt(inner(a, a)), a); }
Triple outer(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Turned about the z axis.
Triple turn(const Triple& p, double angle) {
  return {std::cos(angle) * p[0] - std::sin(angle) * p[1], std::sin(angle) * p[0] + std::cos(angle) * p[1], p[2]};
}

constexpr double kBallRadius = 1;

struct Ball {
  Triple center{};
  double angle = 0;
};

Ball ball_at(int frame, const SceneOptions& options) {
  const double t = options.still || options.sideways_only ? 0 : frame;
  return {{0.3 * t - 0.5, 0.1 * t, 1}, 0.15 * t};
}

}  // namespace

std::array<double, 2> Pinhole::see_direction(const Triple& d) const {
  const double depth = inner(d, forward);
  return {size.width / 2.0 + focal * inner(d, right) / depth + jitter[0],
          size.height / 2.0 - focal * inner(d, up) / depth + jitter[1]};
}

std::array<double, 2> Pinhole::see(const Triple& p) const { return see_direction(minus(p, eye)); }

Camera Pinhole::record() const {
  Camera camera;
  camera.size = size;
  camera.jitter = jitter;
  const double cx = size.width / 2.0 + jitter[0], cy = size.height / 2.0 + jitter[1];
  const double to_right = inner(right, eye), to_up = inner(up, eye), ahead = inner(forward, eye);
  for (std::size_t k = 0; k < 3; ++k) {
    camera.world_to_camera[k] = right[k], camera.world_to_camera[4 + k] = up[k], camera.world_to_camera[8 + k] = -forward[k];
    camera.world_to_screen[k] = focal * right[k] + cx * forward[k];
    camera.world_to_screen[4 + k] = -focal * up[k] + cy * forward[k];
    camera.world_to_screen[8 + k] = 0;
    camera.world_to_screen[12 + k] = forward[k];
  }
  camera.world_to_camera[3] = -to_right, camera.world_to_camera[7] = -to_up, camera.world_to_camera[11] = ahead;
  camera.world_to_screen[3] = -focal * to_right - cx * ahead;
  camera.world_to_screen[7] = focal * to_up - cy * ahead;
  camera.world_to_screen[11] = 1;  // a third component, so that the matrix can be inverted
  camera.world_to_screen[15] = -ahead;
  return camera;
}

Pinhole Scene::pinhole(int frame) const {
  const double t = options_.still ? 0 : frame;
  Pinhole camera;
  camera.size = options_.size;
  camera.focal = 0.9 * options_.size.width * options_.narrow;
  camera.forward = options_.sideways_only ? unit({1, 2, -0.4}) : unit({1 + 0.03 * t, 2, -0.4 + 0.02 * t});
  camera.right = unit(outer(camera.forward, {0, 0, 1}));
  camera.up = outer(camera.right, camera.forward);
  const Triple start{-2.5, -5, 2.2};
  camera.eye = options_.sideways_only ? add(start, 0.2 * t, camera.right) : add(start, t, {0.12, 0.2, 0.05});
  const double side = frame % 2 == 0 ? -1 : 1;
  camera.jitter = {side * options_.jitter[0], side * options_.jitter[1]};
  return camera;
}

Camera Scene::camera(int frame) const {
  Camera camera = pinhole(frame).record();
  const Ball ball = ball_at(frame, options_);
  const double c = std::cos(ball.angle), s = std::sin(ball.angle);
  camera.object_to_world[0] = camera.object_to_world[2] = kIdentity;
  camera.object_to_world[1] = {c, -s, 0, ball.center[0], s, c, 0, ball.center[1], 0, 0, 1, ball.center[2], 0, 0, 0, 1};
  return camera;
}

std::optional<Hit> Scene::hit(int frame, int x, int y) const {
  const Pinhole camera = pinhole(frame);
  const double u = x + 0.5 - camera.jitter[0] - camera.size.width / 2.0,
               v = y + 0.5 - camera.jitter[1] - camera.size.height / 2.0;
  const Triple ray = add(add(add({}, camera.focal, camera.forward), u, camera.right), -v, camera.up);
  std::optional<Hit> nearest;
  double at = 1e30;
  const auto offer = [&](double t, const Hit& hit) {
    if (t > 0 && t < at) at = t, nearest = hit;
  };
  if (ray[2] != 0) {
    const double t = -camera.eye[2] / ray[2];
    const Triple p = add(camera.eye, t, ray);
    if (std::abs(p[0]) < 5 && std::abs(p[1]) < 4) offer(t, {0, p, {0, 0, 1}});
  }
  if (ray[1] != 0) {
    const double t = (4 - camera.eye[1]) / ray[1];
    const Triple p = add(camera.eye, t, ray);
    if (std::abs(p[0]) < 5 && p[2] > 0 && p[2] < 2) offer(t, {2, p, {0, -1, 0}});
  }
  const Triple center = ball_at(frame, options_).center, from = minus(camera.eye, center);
  const double a = inner(ray, ray), b = inner(ray, from), c = inner(from, from) - kBallRadius * kBallRadius;
  if (b * b > a * c) {
    const double t = (-b - std::sqrt(b * b - a * c)) / a;
    const Triple p = add(camera.eye, t, ray);
    offer(t, {1, p, unit(minus(p, center))});
  }
  return nearest;
}

std::array<double, 2> Scene::motion(int frame, int x, int y) const {
  const Pinhole now = pinhole(frame), before = pinhole(frame - 1);
  const auto surface = hit(frame, x, y);
  std::array<double, 2> here{}, then{};
  if (surface) {
    Triple p = surface->position;
    here = now.see(p);
    if (surface->id == 1) {
      const Ball ball = ball_at(frame, options_), earlier = ball_at(frame - 1, options_);
      p = add(earlier.center, 1, turn(minus(p, ball.center), earlier.angle - ball.angle));
    }
    then = before.see(p);
  } else {
    const double u = x + 0.5 - now.jitter[0] - now.size.width / 2.0, v = y + 0.5 - now.jitter[1] - now.size.height / 2.0;
    const Triple ray = add(add(add({}, now.focal, now.forward), u, now.right), -v, now.up);
    here = now.see_direction(ray), then = before.see_direction(ray);
  }
  return {then[0] - before.jitter[0] - here[0] + now.jitter[0], then[1] - before.jitter[1] - here[1] + now.jitter[1]};
}

std::array<double, 3> Scene::value(PortType type, int frame, const Conventions& c, int x, int y) const {
  const Pinhole camera = pinhole(frame);
  const auto surface = hit(frame, x, y);
  const Size size = options_.size;
  const auto in_camera = [&](const Triple& d) {
    return Triple{inner(d, camera.right), inner(d, camera.up), -inner(d, camera.forward)};
  };
  if (type == QUELL_TYPE_MOTION) {
    auto m = motion(frame, x, y);
    if (c.jitter == Jitter::included)
      for (std::size_t k = 0; k < 2; ++k) m[k] += pinhole(frame - 1).jitter[k] - camera.jitter[k];
    const double across = c.unit == MotionUnit::uv ? 1 : 2, sign = c.sign == MotionSign::current_minus_previous ? -1 : 1;
    const bool scaled = c.unit && *c.unit != MotionUnit::pixels;
    const double sx = sign * (scaled ? across / size.width : 1), sy = sign * (scaled ? across / size.height : 1);
    return {sx * m[0], (c.y == YDirection::up ? -sy : sy) * m[1], 0};
  }
  if (type == QUELL_TYPE_COLOR) return {0.3 + 0.01 * x, surface ? 1.5 : 0.2, 0.25};
  if (type == QUELL_TYPE_ID) return {surface ? surface->id : static_cast<double>(c.background.value_or(255)), 0, 0};
  if (!surface) return type == QUELL_TYPE_DEPTH && c.depth != DepthMeasure::reciprocal ? Triple{1e10, 0, 0} : Triple{};
  const Triple from_eye = minus(surface->position, camera.eye);
  switch (type) {
    case QUELL_TYPE_POSITION:
      return c.space == Space::camera ? in_camera(from_eye) : surface->position;
    case QUELL_TYPE_NORMAL: {
      const Triple n = c.space == Space::camera ? in_camera(surface->normal) : surface->normal;
      return c.encoding == Encoding::unsigned_numbers ? Triple{(n[0] + 1) / 2, (n[1] + 1) / 2, (n[2] + 1) / 2} : n;
    }
    case QUELL_TYPE_DEPTH: {
      const double along = inner(from_eye, camera.forward);
      return {c.depth == DepthMeasure::ray          ? std::sqrt(inner(from_eye, from_eye))
              : c.depth == DepthMeasure::reciprocal ? 1 / along
                                                    : along,
              0, 0};
    }
    default:
      return {};
  }
}

Image Scene::stored(PortType type, int frame, const Conventions& conventions) const {
  BufferPool pool;
  Image image(type == QUELL_TYPE_ID ? QUELL_TYPE_SCALAR : type, options_.size, pool);
  const FloatOutput out = image.writable_floats();
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const auto numbers = value(type, frame, conventions, x, y);
      for (int c = 0; c < out.channels; ++c) out.at(x, y, c) = static_cast<float>(numbers[static_cast<std::size_t>(c)]);
    }
  return image;
}

FrameData Scene::read(int frame, const Conventions& truth, const Conventions& read_as) const {
  FrameData data;
  data.frame = frame;
  data.camera = std::make_shared<Camera>(camera(frame));
  data.previous = std::make_shared<Camera>(camera(frame - 1));
  const auto add_image = [&](std::optional<CheckedImage>& slot, PortType type) {
    CheckedImage image{std::string(name(type)), Image(), stored(type, frame, truth), read_as};
    BufferPool pool;
    image.image = Image(type, options_.size, pool);
    if (type == QUELL_TYPE_ID)
      convert_ids(image.stored.floats(), read_as.background.value_or(255), "", image.image.writable_ids());
    else
      image.image = reread(image, read_as, data);
    slot = std::move(image);
  };
  add_image(data.position, QUELL_TYPE_POSITION);
  add_image(data.depth, QUELL_TYPE_DEPTH);
  add_image(data.normal, QUELL_TYPE_NORMAL);
  add_image(data.motion, QUELL_TYPE_MOTION);
  add_image(data.id, QUELL_TYPE_ID);
  add_image(data.color, QUELL_TYPE_COLOR);
  return data;
}

}  // namespace quell::test
