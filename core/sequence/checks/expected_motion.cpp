#include "quell/sequence/checks/expected_motion.h"

#include <limits>
#include <map>

namespace quell {
namespace {

/// Where the points of each object were, one frame earlier.
class Objects {
 public:
  Objects(const Camera& now, const Camera& before) {
    for (const auto& [id, matrix] : now.object_to_world) {
      const auto earlier = before.object_to_world.find(id);
      const auto back = inverted(matrix);
      if (earlier != before.object_to_world.end() && back) moves_[id] = product(earlier->second, *back);
    }
  }
  /// What has no matrix in both frames stands still.
  Vec3 before(std::uint32_t id, Vec3 p) const {
    const auto move = moves_.find(id);
    if (move == moves_.end()) return p;
    const auto q = transform(move->second, p);
    return {q[0], q[1], q[2]};
  }

 private:
  std::map<std::uint32_t, Matrix> moves_;
};

}  // namespace

Image expected_motion(const FrameData& frame, const Surfaces& surfaces, Size size) {
  BufferPool pool;
  Image motion(QUELL_TYPE_MOTION, size, pool);
  const FloatOutput out = motion.writable_floats();
  const Camera &now = *frame.camera, &before = *frame.previous;
  const Objects objects(now, before);
  const double jitter_x = before.jitter[0] - now.jitter[0], jitter_y = before.jitter[1] - now.jitter[1];
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const bool surface = surfaces.has(x, y);
      std::optional<Seen> here, then;
      if (surface) {
        const Vec3 p = surfaces.point(x, y);
        here = project(now.world_to_screen, p);
        then = project(before.world_to_screen, objects.before(surfaces.id(x, y), p));
      } else if (surfaces.viewpoint()) {
        here = Seen{x + 0.5, y + 0.5, 1};
        then = project(before.world_to_screen, surfaces.viewpoint()->direction(x + 0.5, y + 0.5), 0);
      }
      const bool both = here && then;
      constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
      out.at(x, y, 0) = static_cast<float>(both ? then->x - here->x - jitter_x : kUnknown);
      out.at(x, y, 1) = static_cast<float>(both ? then->y - here->y - jitter_y : kUnknown);
    }
  }
  return motion;
}

}  // namespace quell
