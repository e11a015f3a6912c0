// Points, matrices and where surfaces are, in double precision.
#pragma once

#include <array>
#include <optional>

#include "quell/sequence/checks/frame_data.h"
#include "quell/sequence/matrix.h"

namespace quell {

struct Vec3 {
  double x = 0, y = 0, z = 0;
};
inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 cross(Vec3 a, Vec3 b);
double length(Vec3 a);
/// The pixel's three numbers.
inline Vec3 vector_at(const FloatImage& image, int x, int y) { return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)}; }
bool is_finite(Vec3 a);

/// A point (w = 1) or a direction (w = 0) after a matrix.
std::array<double, 4> transform(const Matrix& m, Vec3 p, double w = 1);
/// Nothing for a matrix that cannot be inverted.
std::optional<Matrix> inverted(const Matrix& m);

/// Where a point (w = 1), or one at infinity (w = 0), is seen.
struct Seen {
  double x = 0, y = 0;  ///< pixels
  double depth = 0;     ///< the projection's w: along the view axis
};
/// Nothing for what is not in front of the camera.
std::optional<Seen> project(const Matrix& world_to_screen, Vec3 p, double w = 1);

/// A camera made ready for rays.
class Viewpoint {
 public:
  /// Nothing when a matrix cannot be inverted.
  static std::optional<Viewpoint> of(const Camera& camera);
  /// Where the camera stands.
  Vec3 eye() const { return eye_; }
  /// The direction in which a place of the screen (pixels) is seen, of any length, away from the camera.
  Vec3 direction(double x, double y) const;

 private:
  Vec3 eye_;
  Matrix screen_to_world_ = kIdentity, world_to_screen_ = kIdentity;
};

/// Which pixels show a surface, and where it is. Everything that can tell (ids, depth, positions of this size) has to agree that
/// there is one, so that a single input that was read wrongly does not make background a surface.
class Surfaces {
 public:
  Surfaces(const FrameData& frame, Size size);
  /// Whether any input tells surfaces from background.
  bool known() const { return ids_ || depth_ || positions_; }
  bool has(int x, int y) const;
  /// QUELL_NO_ID where there is none.
  std::uint32_t id(int x, int y) const { return ids_ ? ids_.at(x, y) : QUELL_NO_ID; }
  bool has_ids() const { return static_cast<bool>(ids_); }
  /// Whether point() can tell: from positions, or else from depth and camera.
  bool has_points() const { return positions_ || (depth_ && viewpoint_); }
  bool points_are_from_depth() const { return !positions_; }
  /// In world space; only where has() says so.
  Vec3 point(int x, int y) const;
  const std::optional<Viewpoint>& viewpoint() const { return viewpoint_; }

 private:
  IdImage ids_;
  FloatImage depth_, positions_;
  std::optional<Viewpoint> viewpoint_;
  Matrix world_to_screen_ = kIdentity;
};

}  // namespace quell
