// Normals: their length, and how they stand on the surfaces that neighboring positions span.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "quell/sequence/checks/checks.h"
#include "quell/sequence/checks/geometry.h"
#include "quell/sequence/checks/statistics.h"

namespace quell {
namespace {

// Half precision changes a unit vector's length by 0.05 %; averages over a pixel and interpolated normals that were not scaled
// are shorter where surfaces bend.
constexpr double kLengthTolerance = 0.02;
constexpr double kEnough = 0.9;
constexpr double kMost = 0.5;
// Degrees. Bumps and interpolated normals differ from the flat triangles; a wrong space turns normals by the camera's own
// rotation.
constexpr double kNear = 15;
// Differences of positions span a surface when they are not much longer than those around: a step of depth is none of the
// surface.
constexpr double kLargestStep = 4;

bool is_unsigned(const CheckedImage& normal) {
  return normal.read_as.encoding.value_or(Encoding::signed_numbers) == Encoding::unsigned_numbers;
}

Vec3 decode(Vec3 n, bool unsigned_numbers) { return unsigned_numbers ? Vec3{2 * n.x - 1, 2 * n.y - 1, 2 * n.z - 1} : n; }

/// length - 1 of the stored normals where there are surfaces.
Distribution excess_lengths(const FloatImage& stored, const Surfaces& surfaces, bool unsigned_numbers) {
  Distribution excess;
  for (int y = 0; y < stored.height; ++y)
    for (int x = 0; x < stored.width; ++x) {
      const Vec3 n = vector_at(stored, x, y);
      const bool empty = n.x == 0 && n.y == 0 && n.z == 0;  // how every file says that there is no surface
      if (is_finite(n) && !empty && surfaces.has(x, y)) excess.add(length(decode(n, unsigned_numbers)) - 1);
    }
  return excess;
}

/// The share of lengths within the tolerance of 1.
double share_of_unit(const Distribution& excess) {
  return excess.share_within(kLengthTolerance) - excess.share_within(-kLengthTolerance);
}

Finding check_length(const FrameData& frame, const Surfaces& surfaces) {
  const CheckedImage& normal = *frame.normal;
  const auto as_read = excess_lengths(normal.stored.floats(), surfaces, is_unsigned(normal));
  if (as_read.empty()) return {Verdict::not_tested, kNormalLengthSubject, "no pixel shows a surface"};
  const double share = share_of_unit(as_read);
  Finding finding{Verdict::ok, kNormalLengthSubject,
                  percent(share) + " are within 2 % of length 1, the median is " + short_number(1 + as_read.median()) +
                      "; they are scaled to it when read"};
  finding.figures = {{"outside_share", 1 - share}, {"median_length", 1 + as_read.median()}};
  if (share >= kEnough) return finding;
  // Averages of a pixel's normals are shorter, never longer, and are scaled.
  if (share >= kMost && as_read.share_within(kLengthTolerance) >= kEnough) {
    finding.text += "; the others are shorter, as averages over a pixel are";
    return finding;
  }
  finding.verdict = Verdict::suspicious;
  if (share < kMost && share_of_unit(excess_lengths(normal.stored.floats(), surfaces, !is_unsigned(normal))) >= kEnough) {
    finding.verdict = Verdict::wrong;
    finding.text = "only " + percent(share) + " are within 2 % of length 1; " +
                   (is_unsigned(normal) ? "they are when taken as they stand" : "they are when 0 to 1 stands for -1 to 1");
    finding.remedy = Remedy{frame.normal->name, {}};
    finding.remedy->settings.encoding = is_unsigned(normal) ? Encoding::signed_numbers : Encoding::unsigned_numbers;
  }
  return finding;
}

/// The normal of the surface that the positions around a pixel span, turned to the camera; nothing at edges.
std::optional<Vec3> geometric_normal(const Surfaces& surfaces, Vec3 eye, int x, int y) {
  const std::array<std::array<int, 2>, 5> places{{{x, y}, {x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}}};
  for (const auto& [px, py] : places)
    if (!surfaces.has(px, py) || surfaces.id(px, py) != surfaces.id(x, y)) return std::nullopt;
  const Vec3 p = surfaces.point(x, y);
  const Vec3 left = p - surfaces.point(x - 1, y), right = surfaces.point(x + 1, y) - p;
  const Vec3 up = p - surfaces.point(x, y - 1), down = surfaces.point(x, y + 1) - p;
  const auto even = [](Vec3 a, Vec3 b) {
    return length(a) <= kLargestStep * length(b) && length(b) <= kLargestStep * length(a) && dot(a, b) > 0;
  };
  if (!even(left, right) || !even(up, down)) return std::nullopt;
  const Vec3 n = cross(left + right, up + down);
  const double size = length(n);
  if (!(size > 0.2 * length(left + right) * length(up + down))) return std::nullopt;  // nearly one line: no plane
  return (dot(n, eye - p) < 0 ? -1 : 1) / size * n;
}

double degrees_between(Vec3 a, Vec3 b) { return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi; }

struct Standing {
  Distribution angle;  ///< degrees to the geometric normal that faces the camera
  double facing = 0;   ///< share of normals that face the camera
  std::size_t normals = 0;
};

Standing stand(const FloatImage& normals, const Surfaces& surfaces, Image map = {}) {
  Standing result;
  const Vec3 eye = surfaces.viewpoint()->eye();
  std::size_t facing = 0;
  for (int y = 0; y < normals.height; ++y) {
    for (int x = 0; x < normals.width; ++x) {
      const Vec3 n = vector_at(normals, x, y);
      if (!surfaces.has(x, y) || !is_finite(n) || dot(n, n) == 0) continue;
      ++result.normals;
      facing += dot(n, eye - surfaces.point(x, y)) > 0 ? 1 : 0;
      if (x == 0 || y == 0 || x + 1 == normals.width || y + 1 == normals.height) continue;
      const auto flat = geometric_normal(surfaces, eye, x, y);
      if (!flat) continue;
      const double angle = degrees_between(n, *flat);
      result.angle.add(angle);
      if (map) map.writable_floats().at(x, y) = static_cast<float>(angle);
    }
  }
  if (result.normals > 0) result.facing = static_cast<double>(facing) / static_cast<double>(result.normals);
  return result;
}

/// How far from the surfaces half of the normals are when read from the other space.
std::optional<double> angle_in_other_space(const FrameData& frame, const Surfaces& surfaces, Space& other) {
  const CheckedImage& normal = *frame.normal;
  if (!normal.stored) return std::nullopt;
  Conventions conventions = normal.read_as;
  other = conventions.space.value_or(Space::world) == Space::world ? Space::camera : Space::world;
  conventions.space = other;
  return stand(reread(normal, conventions, frame).floats(), surfaces).angle.median();
}

std::string words(Space space) { return space == Space::world ? "world space" : "camera space"; }

Finding check_standing(const FrameData& frame, const Surfaces& surfaces, const Standing& standing, Image map) {
  if (standing.angle.count() < 16) return {Verdict::not_tested, kNormalSurfaceSubject, "positions show no smooth surface"};
  const double median = standing.angle.median();
  Finding finding{Verdict::ok, kNormalSurfaceSubject,
                  "half are within " + short_number(median) + " degrees of the surfaces that the positions span, 90 % within " +
                      short_number(standing.angle.quantile(0.9))};
  finding.figures = {{"median_degrees", median}, {"p90_degrees", standing.angle.quantile(0.9)}};
  finding.errors = std::move(map), finding.large_error = 45, finding.error_unit = "degrees";
  Space other{};
  const auto otherwise = angle_in_other_space(frame, surfaces, other);
  if (median <= kNear) {
    if (otherwise && *otherwise <= kNear)
      finding.text += "; so is it in " + words(other) + ": the camera is not turned far enough to tell";
    return finding;
  }
  finding.verdict = Verdict::wrong;
  if (otherwise && *otherwise <= kNear) {
    finding.remedy = Remedy{frame.normal->name, {}};
    finding.remedy->settings.space = other;
    finding.text += "; in " + words(other) + " half are within " + short_number(*otherwise) + " degrees";
  } else if (180 - median <= kNear) {
    finding.text += "; they point into the surfaces, away from the camera";
  } else {
    finding.text += "; no other reading agrees better: their axes may be swapped, or positions be of another frame";
  }
  return finding;
}

Finding check_facing(const Standing& standing) {
  Finding finding{Verdict::ok, kNormalFacingSubject, percent(standing.facing) + " do"};
  finding.figures = {{"away_share", 1 - standing.facing}};
  // Bumps and interpolation turn normals away at outlines only.
  if (standing.facing < kEnough) finding.verdict = Verdict::suspicious;
  if (standing.facing < kEnough) finding.text = "only " + finding.text + "; shading may want them turned to the camera";
  return finding;
}

}  // namespace

std::vector<Finding> check_normals(const FrameData& frame) {
  if (!frame.normal) return {};
  const Size size = frame.normal->image.size();
  const Surfaces surfaces(frame, size);
  std::vector<Finding> findings;
  if (frame.normal->stored) {
    findings.push_back(check_length(frame, surfaces));
    if (findings[0].remedy) {  // the rest is told of normals as they would be then
      FrameData mended = frame;
      apply(*findings[0].remedy, mended);
      std::vector<Finding> more = check_normals(mended);
      findings.insert(findings.end(), more.begin() + 1, more.end());
      return findings;
    }
  }
  if (!surfaces.viewpoint() || !surfaces.has_points()) {
    const char* why = !frame.camera                ? "there is no camera"
                      : frame.camera->size != size ? "the camera is of another size"
                                                   : "there are neither positions that land on their pixels, nor depth";
    findings.push_back({Verdict::not_tested, kNormalSurfaceSubject, why});
    return findings;
  }
  Image map = make_error_map(size);
  const Standing standing = stand(frame.normal->image.floats(), surfaces, map);
  if (standing.normals == 0) return findings;
  findings.push_back(check_standing(frame, surfaces, standing, std::move(map)));
  if (findings.back().verdict != Verdict::wrong) findings.push_back(check_facing(standing));
  return findings;
}

}  // namespace quell
