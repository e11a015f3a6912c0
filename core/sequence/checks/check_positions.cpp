// Positions, seen through the camera, have to land on the pixels that hold them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "quell/sequence/checks/checks.h"
#include "quell/sequence/checks/geometry.h"
#include "quell/sequence/checks/statistics.h"

namespace quell {
namespace {

constexpr double kEnough = 0.99;  // of the points; pixel filters have tails
constexpr double kMost = 0.5;     // a reading is the right one when it explains most points, a wrong one explains nearly none
// A shift of all points that is larger than this is no accident: samples are spread evenly about the center, so that the median
// of a thousand differs from it by about 0.5 / sqrt(1000) = 0.016 px at most.
constexpr double kShift = 0.25;

struct Landings {
  Distribution distance, x, y;
  double behind = 0;  ///< share of the points that are not in front of the camera
  std::size_t points = 0;
  Image map;

  double within() const { return distance.share_within(kLandingTolerance) * (1 - behind); }
};

/// Lands `positions` on the screen of a matrix.
Landings land(const FloatImage& positions, const Surfaces& surfaces, const Matrix& world_to_screen, Image map = {}) {
  Landings result;
  std::size_t behind = 0;
  for (int y = 0; y < positions.height; ++y) {
    for (int x = 0; x < positions.width; ++x) {
      if (!surfaces.has(x, y)) continue;
      ++result.points;
      const auto seen = project(world_to_screen, vector_at(positions, x, y));
      if (!seen || !std::isfinite(seen->x) || !std::isfinite(seen->y)) {
        ++behind;
        if (map) map.writable_floats().at(x, y) = std::numeric_limits<float>::max();
        continue;
      }
      const double dx = seen->x - x - 0.5, dy = seen->y - y - 0.5, distance = std::max(std::abs(dx), std::abs(dy));
      result.x.add(dx), result.y.add(dy), result.distance.add(distance);
      if (map) map.writable_floats().at(x, y) = static_cast<float>(distance);
    }
  }
  if (result.points > 0) result.behind = static_cast<double>(behind) / static_cast<double>(result.points);
  result.map = std::move(map);
  return result;
}

Matrix upside_down(const Camera& camera) {
  Matrix flipped = camera.world_to_screen;
  for (std::size_t k = 0; k < 4; ++k)
    flipped[4 + k] = camera.size.height * camera.world_to_screen[12 + k] - camera.world_to_screen[4 + k];
  return flipped;
}

/// Explains by the camera why points do not land; "" when nothing does.
std::string explain_by_camera(const FrameData& frame, const FloatImage& positions, const Surfaces& surfaces) {
  const auto lands = [&](const Matrix& m) { return land(positions, surfaces, m).within() >= kMost; };
  const Camera& camera = *frame.camera;
  if (lands(upside_down(camera)))
    return "they land upside down: the camera's pixels are counted from the bottom, or the images are stored so";
  if (lands(transposed(camera.world_to_screen)))
    return "they land where they should when the camera's matrices are transposed: the file holds them for row vectors";
  if (frame.previous && frame.previous->size == camera.size && lands(frame.previous->world_to_screen))
    return "they land where they should with the camera of the frame before: the cameras' frame numbers are one too late";
  return "";
}

std::optional<Remedy> find_remedy(const FrameData& frame, const Surfaces& surfaces) {
  const CheckedImage& position = *frame.position;
  if (!position.stored) return std::nullopt;
  const bool is_world = position.read_as.space.value_or(Space::world) == Space::world;
  Remedy remedy{position.name, {}};
  remedy.settings.space = is_world ? Space::camera : Space::world;
  const Image other = reread(position, remedy.settings.or_else(position.read_as), frame);
  if (land(other.floats(), surfaces, frame.camera->world_to_screen).within() < kMost) return std::nullopt;
  return remedy;
}

std::string describe(const Landings& landings) {
  std::string text = "99 % land within " + pixels(landings.distance.quantile(0.99)) + " of their pixel's center, the farthest " +
                     pixels(landings.distance.max()) + " from it (" + std::to_string(landings.points) + " points)";
  if (landings.behind > 0) text += "; " + percent(landings.behind) + " are not in front of the camera";
  return text;
}

/// A shift that all points have; "" when there is none.
std::string describe_shift(const Landings& landings) {
  const double x = landings.x.median(), y = landings.y.median();
  if (std::max(std::abs(x), std::abs(y)) < kShift) return "";
  return "; all lie to one side of it, " + pixels(std::abs(x)) + (x < 0 ? " left" : " right") + " and " + pixels(std::abs(y)) +
         (y < 0 ? " above" : " below") + ": the camera may count pixels from their centers, or not know the jitter of the images";
}

Finding judge(const FrameData& frame, const Surfaces& surfaces, Landings landings) {
  Finding finding{Verdict::ok, kPositionSubject, describe(landings)};
  finding.figures = {{"p99_px", landings.distance.quantile(0.99)},
                     {"median_px", landings.distance.median()},
                     {"max_px", landings.distance.max()},
                     {"within_share", landings.within()}};
  finding.errors = std::move(landings.map);
  finding.large_error = kLandingTolerance;
  finding.error_unit = "px";
  const FloatImage positions = frame.position->image.floats();
  if (landings.within() >= kEnough) {
    const std::string shift = describe_shift(landings);
    finding.text += shift;
    if (!shift.empty()) finding.verdict = Verdict::suspicious;
    return finding;
  }
  finding.text = (landings.within() > 0 ? "only " : "") + percent(landings.within()) + " of the points land within " +
                 short_number(kLandingTolerance) + " px of their pixel's center, half of them within " +
                 pixels(landings.distance.median());
  if (landings.within() >= kMost) {
    finding.verdict = Verdict::suspicious;
    finding.text += "; positions that are averaged over a pixel do that at edges";
    return finding;
  }
  finding.verdict = Verdict::wrong;
  finding.remedy = find_remedy(frame, surfaces);
  const std::string why = finding.remedy ? "they do in the other space" : explain_by_camera(frame, positions, surfaces);
  finding.text += "; " + (why.empty() ? "no other reading lands better: the camera may be of another frame or scene" : why);
  return finding;
}

}  // namespace

std::vector<Finding> check_positions(const FrameData& frame) {
  if (!frame.position) return {};
  const Size size = frame.position->image.size();
  const auto not_tested = [](const char* why) { return std::vector{Finding{Verdict::not_tested, kPositionSubject, why}}; };
  if (!frame.camera) return not_tested("there is no camera");
  if (frame.camera->size != size) return not_tested("the camera is of another size");
  const Surfaces surfaces(frame, size);
  Landings landings = land(frame.position->image.floats(), surfaces, frame.camera->world_to_screen, make_error_map(size));
  if (landings.points == 0) return not_tested("no pixel shows a surface");
  return {judge(frame, surfaces, std::move(landings))};
}

}  // namespace quell
