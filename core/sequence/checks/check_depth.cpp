// Depth, compared with the positions seen through the camera.
#include <array>
#include <cmath>

#include "quell/sequence/checks/checks.h"
#include "quell/sequence/checks/geometry.h"
#include "quell/sequence/checks/statistics.h"

namespace quell {
namespace {

// Half precision rounds by 2^-12 of the number at most, 0.024 %; a factor of 8 is left for positions that are rounded as well.
// Rays 4 degrees off the axis are 0.24 % longer than their distance along it.
constexpr double kTolerance = 0.002;
constexpr double kEnough = 0.9;  // where depth or position are averages over a pixel, edges differ
constexpr double kMost = 0.5;

/// Relative differences of a depth image from the distance along the view axis.
struct Differences {
  Distribution relative;  ///< |depth / w - 1|
  Distribution ratio;     ///< depth / w
};

Differences compare(const FloatImage& depth, const FrameData& frame, const Surfaces& surfaces, Image map = {}) {
  Differences result;
  const FloatImage positions = frame.position->image.floats();
  for (int y = 0; y < depth.height; ++y) {
    for (int x = 0; x < depth.width; ++x) {
      if (!surfaces.has(x, y)) continue;
      const auto seen = project(frame.camera->world_to_screen, vector_at(positions, x, y));
      if (!seen) continue;
      const double ratio = depth.at(x, y) / seen->depth;
      if (!std::isfinite(ratio)) continue;
      result.ratio.add(ratio), result.relative.add(std::abs(ratio - 1));
      if (map) map.writable_floats().at(x, y) = static_cast<float>(100 * std::abs(ratio - 1));
    }
  }
  return result;
}

const char* words(DepthMeasure measure) {
  switch (measure) {
    case DepthMeasure::axis:
      return "along the view axis";
    case DepthMeasure::ray:
      return "from the camera";
    case DepthMeasure::reciprocal:
      return "as 1 / z";
  }
  return "";
}

constexpr std::array kMeasures{DepthMeasure::axis, DepthMeasure::ray, DepthMeasure::reciprocal};

DepthMeasure present_measure(const CheckedImage& depth) { return depth.read_as.depth.value_or(DepthMeasure::axis); }

/// How much of the depth agrees when it is read by another measure.
double share_read_as(DepthMeasure measure, const FrameData& frame, const Surfaces& surfaces) {
  Conventions conventions = frame.depth->read_as;
  conventions.depth = measure;
  const Image other = reread(*frame.depth, conventions, frame);
  return compare(other.floats(), frame, surfaces).relative.share_within(kTolerance);
}

/// Adds what the images cannot tell apart.
void tell_ambiguity(Finding& finding, const FrameData& frame, const Surfaces& surfaces) {
  if (!frame.depth->stored) return;
  for (const DepthMeasure measure : kMeasures)
    if (measure != present_measure(*frame.depth) && share_read_as(measure, frame, surfaces) >= kEnough)
      finding.text += std::string("; so narrow a view does not tell whether it is measured ") + words(measure);
}

void find_remedy(Finding& finding, const FrameData& frame, const Surfaces& surfaces, const Differences& present) {
  if (frame.depth->stored)
    for (const DepthMeasure measure : kMeasures) {
      if (measure == present_measure(*frame.depth) || share_read_as(measure, frame, surfaces) < kMost) continue;
      finding.remedy = Remedy{frame.depth->name, {}};
      finding.remedy->settings.depth = measure;
      finding.text += std::string("; it does when measured ") + words(measure);
      return;
    }
  const double factor = present.ratio.median();
  if (factor > 0 &&
      present.ratio.share_within(factor * (1 + kTolerance)) - present.ratio.share_within(factor * (1 - kTolerance)) >= kMost)
    finding.text += "; it is " + short_number(factor) + " times as far as the positions are: another unit of length";
  else
    finding.text += "; no other reading agrees";
}

}  // namespace

std::vector<Finding> check_depth(const FrameData& frame) {
  if (!frame.depth) return {};
  const Size size = frame.depth->image.size();
  const auto not_tested = [](const char* why) { return std::vector{Finding{Verdict::not_tested, kDepthSubject, why}}; };
  if (!frame.camera) return not_tested("there is no camera");
  if (!frame.position) return not_tested("there are no positions that land on their pixels to compare with");
  if (frame.camera->size != size || frame.position->image.size() != size) return not_tested("sizes differ");
  const Surfaces surfaces(frame, size);
  Image map = make_error_map(size);
  const Differences present = compare(frame.depth->image.floats(), frame, surfaces, map);
  if (present.relative.empty()) return not_tested("no pixel shows a surface in front of the camera");
  const double share = present.relative.share_within(kTolerance);
  Finding finding{Verdict::ok, kDepthSubject,
                  percent(share) + " within 0.2 % of the distance along the view axis, half within " +
                      short_number(100 * present.relative.median()) + " %"};
  finding.figures = {{"outside_share", 1 - share}, {"median_relative", present.relative.median()}};
  finding.errors = std::move(map), finding.large_error = 1000 * kTolerance, finding.error_unit = "%";
  if (share >= kEnough) {
    tell_ambiguity(finding, frame, surfaces);
  } else if (share >= kMost) {
    finding.verdict = Verdict::suspicious;
    finding.text += "; depths that are averaged over a pixel differ at edges";
  } else {
    finding.verdict = Verdict::wrong;
    find_remedy(finding, frame, surfaces, present);
  }
  return {finding};
}

}  // namespace quell
