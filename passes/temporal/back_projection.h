// What the makers of motion and previous_position share: the surface point that each pixel shows, and where it stood one frame
// ago.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "quell/sdk/pass.h"

namespace quell::back_projection {

inline constexpr float kFarAway = 1e6F;  // pixels, off any screen: images are at most 65536 wide

using Matrix = std::array<double, 16>;  // row-major, for column vectors
inline constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
using Row = std::array<double, 4>;  // of such a matrix

inline Matrix matrix(const double* values) {
  Matrix m;
  std::copy_n(values, m.size(), m.begin());
  return m;
}

inline Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix product;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 4; ++k) sum += a[4 * i + k] * b[4 * k + j];
      product[4 * i + j] = sum;
    }
  return product;
}

inline double determinant3(const Matrix& m, std::size_t without_row, std::size_t without_column) {
  std::array<std::size_t, 3> r{}, c{};
  for (std::size_t i = 0, at = 0; i < 4; ++i)
    if (i != without_row) r[at++] = 4 * i;
  for (std::size_t i = 0, at = 0; i < 4; ++i)
    if (i != without_column) c[at++] = i;
  return m[r[0] + c[0]] * (m[r[1] + c[1]] * m[r[2] + c[2]] - m[r[1] + c[2]] * m[r[2] + c[1]]) -
         m[r[0] + c[1]] * (m[r[1] + c[0]] * m[r[2] + c[2]] - m[r[1] + c[2]] * m[r[2] + c[0]]) +
         m[r[0] + c[2]] * (m[r[1] + c[0]] * m[r[2] + c[1]] - m[r[1] + c[1]] * m[r[2] + c[0]]);
}

// By cofactors. A singular matrix gives infinities or NaN, which end as no history: no visible point has such an object.
inline Matrix inverse(const Matrix& m) {
  Matrix adjugate;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) adjugate[4 * j + i] = ((i + j) % 2 ? -1 : 1) * determinant3(m, i, j);
  double determinant = 0;
  for (std::size_t j = 0; j < 4; ++j) determinant += m[j] * adjugate[4 * j];
  for (double& value : adjugate) value /= determinant;
  return adjugate;
}

// Of an axis, in pixels of an image of another size than the camera's.
inline double pixel_scale(const quell_camera& camera, int axis, int size) {
  const int camera_size = axis == 0 ? camera.width : camera.height;
  return camera_size > 0 ? double(size) / camera_size : 1.0;
}

// World to pixels of the image, with that share of the jitter left in: 0 or 1.
inline Matrix world_to_pixel(const quell_camera& camera, int width, int height, double jitter_left = 0) {
  Matrix m = matrix(camera.world_to_screen);
  const double scale_x = pixel_scale(camera, 0, width), scale_y = pixel_scale(camera, 1, height), taken = 1 - jitter_left;
  for (std::size_t i = 0; i < 4; ++i) {
    m[i] = scale_x * (m[i] - taken * camera.jitter[0] * m[12 + i]);
    m[4 + i] = scale_y * (m[4 + i] - taken * camera.jitter[1] * m[12 + i]);
  }
  return m;
}

inline double length3(const double* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// Depth as a function of the world, and what the projection divides by: depth = axis (p, 1), w = slope depth + constant.
struct DepthAxis {
  Row axis{};
  double slope = 0, constant = 0;
};

// In camera space, where the eye is the origin, the last row of the projection is (n, 0) of a perspective, (0, 0, 0, c) of an
// orthographic camera; in matrices of float precision only nearly so. w is positive in front of a perspective camera, and grows
// along the axis. An orthographic camera does not tell front from back by w, nor do all renderers look along the same direction
// of the camera's z: its screen does, whose x goes right and y down, so that their cross product goes forward.
inline DepthAxis depth_axis(const quell_camera& camera) {
  const Matrix screen = matrix(camera.world_to_screen), view = matrix(camera.world_to_camera);
  const Matrix from_camera = screen * inverse(view);
  const bool perspective = length3(&from_camera[12]) > 1e-5 * std::abs(from_camera[15]);
  DepthAxis depth;
  const double* row = perspective ? &screen[12] : &view[8];
  double scale = 1 / length3(row);
  if (perspective) {
    depth.slope = length3(row);
  } else {
    depth.constant = screen[15];
    const double forward = view[8] * (screen[1] * screen[6] - screen[2] * screen[5]) +
                           view[9] * (screen[2] * screen[4] - screen[0] * screen[6]) +
                           view[10] * (screen[0] * screen[5] - screen[1] * screen[4]);
    if (forward < 0) scale = -scale;
  }
  for (std::size_t i = 0; i < 4; ++i) depth.axis[i] = scale * row[i];
  return depth;
}

struct Point {
  double x = 0, y = 0, z = 0;
};

// What m makes of a point before the division by the fourth number.
struct Projected {
  double x = 0, y = 0, z = 0, w = 0;
};

inline Projected transform(const Matrix& m, const Point& p) {
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
          m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11], m[12] * p.x + m[13] * p.y + m[14] * p.z + m[15]};
}

// The surface points of a frame: its positions, or what its depths are seen at. With u and v the pixel's center and s0, s1, s3
// the rows of world-to-screen, s0 p = u w, s1 p = v w and axis p = depth are three equations for the three numbers of p; the
// inverse of their matrix, the same for all pixels, is to_world().
class Surface {
 public:
  Surface(const Frame& frame, const quell_camera& camera, int width, int height)
      : position_(frame.image("position")), depth_(frame.image("depth")), id_(frame.ids("id")) {
    if (position_) return;
    if (!depth_) throw std::runtime_error("neither 'position' nor 'depth' is there in this frame");
    axis_ = depth_axis(camera);
    Matrix equations = world_to_pixel(camera, width, height, 1);  // samples went through the pixels of the jittered screen
    std::copy_n(axis_.axis.begin(), 4, equations.begin() + 8);
    std::copy_n(std::array<double, 4>{0, 0, 0, 1}.begin(), 4, equations.begin() + 12);
    to_world_ = inverse(equations);
  }

  static void require(const Inference& inference) {
    if (!inference.present("position") && !inference.present("depth"))
      throw std::runtime_error("there must be 'position', or 'depth' to rebuild it from");
  }

  // One row of pixels. Its pointers are found once, and, a copy of its own, stay in registers whatever a loop writes.
  class Pixels {
   public:
    // False where there is nothing to be seen.
    bool is_at(int x) const { return !(ids_ && ids_[x] == QUELL_NO_ID) && (x_ || depth_[x] != QUELL_NO_SURFACE_DEPTH); }
    std::uint32_t id(int x) const { return ids_ ? ids_[x] : QUELL_NO_ID; }
    // That to_world() takes to the world.
    Point point(int x) const {
      if (x_) return {x_[x], y_[x], z_[x]};
      const double depth = depth_[x], w = slope_ * depth + constant_;
      return {(x + 0.5) * w, center_y_ * w, depth};
    }

   private:
    friend class Surface;
    const float *x_ = nullptr, *y_ = nullptr, *z_ = nullptr, *depth_ = nullptr;
    const std::uint32_t* ids_ = nullptr;
    double slope_ = 0, constant_ = 0, center_y_ = 0;
  };

  Pixels row(int y) const {
    Pixels row;
    if (position_) row.x_ = position_.row(y, 0), row.y_ = position_.row(y, 1), row.z_ = position_.row(y, 2);
    if (depth_) row.depth_ = depth_.row(y);
    if (id_) row.ids_ = id_.row(y);
    row.slope_ = axis_.slope, row.constant_ = axis_.constant, row.center_y_ = y + 0.5;
    return row;
  }
  const Matrix& to_world() const { return to_world_; }

 private:
  FloatImage position_, depth_;
  IdImage id_;
  DepthAxis axis_;
  Matrix to_world_ = kIdentity;
};

inline const double* find_object(const quell_camera& camera, std::uint32_t id) {
  const std::uint32_t *begin = camera.object_ids, *end = begin + camera.object_count;
  const std::uint32_t* at = std::lower_bound(begin, end, id);
  return at != end && *at == id ? camera.object_to_world + 16 * (at - begin) : nullptr;
}

// Takes points to where they stood one frame ago, and from there through `then`. Of each thread: it keeps the matrix of the
// object that it met last, since neighbors mostly show the same one.
class WayBack {
 public:
  WayBack(const quell_camera& now, const quell_camera& before, const Matrix& to_world, const Matrix& then)
      : now_(&now), before_(&before), to_world_(to_world), then_(then), still_(then * to_world), last_(still_) {}

  const Matrix& of(std::uint32_t id) {
    if (id != last_id_) turn_to(id);
    return last_;
  }

 private:
  [[gnu::noinline]] void turn_to(std::uint32_t id) {  // not into the loop over pixels
    last_id_ = id;
    const double *now = find_object(*now_, id), *before = find_object(*before_, id);
    const bool moved = now && before && matrix(now) != matrix(before);
    last_ = moved ? then_ * (matrix(before) * inverse(matrix(now))) * to_world_ : still_;
  }

  const quell_camera *now_, *before_;
  Matrix to_world_, then_, still_, last_;
  std::uint32_t last_id_ = QUELL_NO_ID;
};

}  // namespace quell::back_projection
