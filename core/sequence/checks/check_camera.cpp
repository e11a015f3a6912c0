// Sizes of all inputs, and whether the camera's two matrices tell of the same camera.
#include <algorithm>
#include <cmath>

#include "quell/sequence/checks/checks.h"
#include "quell/sequence/checks/geometry.h"
#include "quell/sequence/checks/statistics.h"

namespace quell {
namespace {

// Both are directions and places from numbers that files may hold in single precision, 6e-8, combined a few times.
constexpr double kSameDirection = 1e-3;  // sine of the angle
constexpr double kSamePlace = 1e-3;      // of the distance to the world's origin, or of 1

std::string text_of(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

}  // namespace

std::vector<Finding> check_sizes(const FrameData& frame) {
  std::vector<std::pair<std::string, Size>> sizes;
  for (const CheckedImage* image : list_images(frame))
    if (image->image) sizes.emplace_back(image->name, image->image.size());
  if (frame.camera) sizes.emplace_back("camera", frame.camera->size);
  if (sizes.size() < 2) return {};
  Finding finding{Verdict::ok, kSizesSubject, "all are " + text_of(sizes.front().second)};
  const Size first = sizes.front().second;
  std::string others;
  for (const auto& [name, size] : sizes)
    if (size != first) others += (others.empty() ? "" : ", ") + name + " is " + text_of(size);
  if (others.empty()) return {finding};
  finding.verdict = Verdict::wrong;
  finding.text = sizes.front().first + " is " + text_of(first) + ", but " + others;
  return {finding};
}

std::vector<Finding> check_camera(const FrameData& frame) {
  if (!frame.camera) return {};
  Finding finding{Verdict::wrong, kCameraSubject, ""};
  const auto result = [&](Verdict verdict, std::string text) {
    finding.verdict = verdict, finding.text = std::move(text);
    return std::vector{finding};
  };
  const Camera& camera = *frame.camera;
  const auto viewpoint = Viewpoint::of(camera);
  if (!viewpoint) return result(Verdict::wrong, "a matrix cannot be inverted");
  const Matrix& screen = camera.world_to_screen;
  const Matrix& view = camera.world_to_camera;
  // The projection's w is the distance along the view axis: its gradient is that axis, of unit length, and it is 0 at the eye.
  const Vec3 gradient{screen[12], screen[13], screen[14]}, axis{view[8], view[9], view[10]};
  const double scale = length(gradient);
  if (scale == 0) return result(Verdict::not_tested, "a parallel projection, which has no depth in w");
  const Vec3 eye = viewpoint->eye();
  const double off_axis = length(cross(gradient, axis)) / (scale * length(axis));
  const double off_eye = std::abs(transform(screen, eye)[3]) / scale;
  finding.figures = {{"axis_sine", off_axis}, {"eye_distance", off_eye}, {"w_scale", scale}};
  if (off_axis > kSameDirection || off_eye > kSamePlace * std::max(1.0, length(eye)))
    return result(Verdict::wrong, "world-to-camera and the projection differ: their view axes by " +
                                      short_number(std::asin(std::min(off_axis, 1.0)) * 57.29577951308232) +
                                      " degrees, and the camera stands " + short_number(off_eye) +
                                      " before or behind the place where the projection's depth is 0");
  if (std::abs(scale - 1) > 1e-3)
    return result(Verdict::suspicious, "the projection's w is " + short_number(scale) +
                                           " times the distance along the view axis; it should be that distance");
  return result(Verdict::ok, "both have one view axis and one place of the camera");
}

}  // namespace quell
