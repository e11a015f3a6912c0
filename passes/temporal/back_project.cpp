// Motion vectors from surface positions, cameras and object matrices: where was what this pixel shows, one frame ago?
// Source:  p_prev = M_prev(id) inverse(M_cur(id)) p, projected by the previous frame's world-to-screen matrix: the back
//          projection of GAMES202 (Real-Time High Quality Rendering, 2021), known from Nehab et al., Graphics Hardware 2007.
// Departs: jitter is taken out of both positions, so that a scene at rest has motion 0 whatever the cameras' jitter.
// Cost:    9 multiplications and 2 divisions in double a pixel; one 4x4 inverse
//          wherever a row comes to another object that moved.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "quell/sdk/pass.h"

namespace quell {
namespace {

enum class Current { pixel_center, projected };

struct Params {
  Current current = Current::pixel_center;
  void describe(auto&& field) {
    field("current", current,
          Choices{{"pixel_center",
                   "the pixel's center: center + motion is exactly where the point was seen. Right when every sample went "
                   "through its pixel's center, and what the published method fetches by"},
                  {"projected",
                   "the point itself, projected: what a renderer writes. Right when samples lie anywhere in their pixel, "
                   "since a scene at rest then has motion 0 instead of the sample's offset"}},
          "From which place on the screen the motion starts.");
  }
};

const PassInfo kInfo{
    .id = "back_project",
    .summary = "Motion vectors from positions, cameras and object matrices",
    .doc =
        "Carries every surface point back to where it stood one frame ago (with its object, if that moved) and projects it "
        "with the previous camera. Objects that are not in both cameras' tables did not move. Pixels without surface, and all "
        "pixels while there is no previous camera, have motion 0. A point that lay behind the previous camera, that cannot be "
        "projected, or that moved by more than 1e6 pixels has motion (1e6, 1e6), which is off any screen.\n\n"
        "Cameras of another resolution than the image are scaled to it. Jitter of the cameras is not part of the motion.",
    .source =
        "GAMES202 (Real-Time High Quality Rendering, 2021), back projection: screen = P' V' M' inverse(M) world. Nehab et "
        "al., \"Accelerating Real-Time Shading with Reverse Reprojection Caching\", Graphics Hardware 2007.",
    .inputs = {{"position", kPosition, "world-space position of the surface in each pixel"},
               {"id", kId, "object of each pixel; without it every pixel is a surface, and nothing but the camera moves", true},
               {"camera", kCamera, "the camera of this frame, with the objects' matrices"},
               {"previous_camera", kCamera, "the camera of the previous frame; absent in the first", true}},
    .outputs = {{"motion", kMotion, "previous minus current position, pixels, y down"}},
};

constexpr float kFarAway = 1e6F;  // pixels; images are at most 65536 wide

using Matrix = std::array<double, 16>;  // row-major, for column vectors

Matrix matrix(const double* values) {
  Matrix m;
  std::copy_n(values, m.size(), m.begin());
  return m;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix product;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 4; ++k) sum += a[4 * i + k] * b[4 * k + j];
      product[4 * i + j] = sum;
    }
  return product;
}

double determinant3(const Matrix& m, std::size_t without_row, std::size_t without_column) {
  std::array<std::size_t, 3> r{}, c{};
  for (std::size_t i = 0, at = 0; i < 4; ++i)
    if (i != without_row) r[at++] = 4 * i;
  for (std::size_t i = 0, at = 0; i < 4; ++i)
    if (i != without_column) c[at++] = i;
  return m[r[0] + c[0]] * (m[r[1] + c[1]] * m[r[2] + c[2]] - m[r[1] + c[2]] * m[r[2] + c[1]]) -
         m[r[0] + c[1]] * (m[r[1] + c[0]] * m[r[2] + c[2]] - m[r[1] + c[2]] * m[r[2] + c[0]]) +
         m[r[0] + c[2]] * (m[r[1] + c[0]] * m[r[2] + c[1]] - m[r[1] + c[1]] * m[r[2] + c[0]]);
}

// By cofactors. A singular matrix gives infinities or NaN, which end as kFarAway: no visible point has such an object.
Matrix inverse(const Matrix& m) {
  Matrix adjugate;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) adjugate[4 * j + i] = ((i + j) % 2 ? -1 : 1) * determinant3(m, i, j);
  double determinant = 0;
  for (std::size_t j = 0; j < 4; ++j) determinant += m[j] * adjugate[4 * j];
  for (double& value : adjugate) value /= determinant;
  return adjugate;
}

// World to pixels of the image, without jitter.
Matrix world_to_pixel(const quell_camera& camera, int width, int height) {
  Matrix m = matrix(camera.world_to_screen);
  const double scale_x = camera.width > 0 ? double(width) / camera.width : 1.0;
  const double scale_y = camera.height > 0 ? double(height) / camera.height : 1.0;
  for (std::size_t i = 0; i < 4; ++i) {
    m[i] = scale_x * (m[i] - camera.jitter[0] * m[12 + i]);
    m[4 + i] = scale_y * (m[4 + i] - camera.jitter[1] * m[12 + i]);
  }
  return m;
}

struct Point {
  double x = 0, y = 0;
  bool in_front = false;
};

Point project(const Matrix& m, double x, double y, double z) {
  const double w = m[12] * x + m[13] * y + m[14] * z + m[15];
  return {(m[0] * x + m[1] * y + m[2] * z + m[3]) / w, (m[4] * x + m[5] * y + m[6] * z + m[7]) / w, w > 0};
}

const double* find_object(const quell_camera& camera, std::uint32_t id) {
  const std::uint32_t *begin = camera.object_ids, *end = begin + camera.object_count;
  const std::uint32_t* at = std::lower_bound(begin, end, id);
  return at != end && *at == id ? camera.object_to_world + 16 * (at - begin) : nullptr;
}

// Present world positions to previous pixels, for the camera alone and for objects that moved.
class Projections {
 public:
  Projections(const quell_camera& now, const quell_camera& before, int width, int height)
      : now_(now), before_(before), still_(world_to_pixel(before, width, height)) {}
  const Matrix& still() const { return still_; }
  Matrix of(std::uint32_t id) const {
    const double *now = find_object(now_, id), *before = find_object(before_, id);
    if (!now || !before || matrix(now) == matrix(before)) return still_;
    return still_ * (matrix(before) * inverse(matrix(now)));
  }

 private:
  const quell_camera &now_, &before_;
  Matrix still_;
};

class BackProjectPass final : public Pass {
 public:
  explicit BackProjectPass(const Params& params) : current_(params.current) {}

  void run(const Frame& frame) const override {
    const FloatOutput motion = frame.output("motion");
    const quell_camera& camera = *frame.camera("camera");
    const quell_camera* previous = frame.camera("previous_camera");
    if (!previous) return fill_zero(frame, motion);
    const Job job{frame.image("position"),
                  frame.ids("id"),
                  motion,
                  Projections(camera, *previous, motion.width, motion.height),
                  world_to_pixel(camera, motion.width, motion.height),
                  {0.5 - scaled_jitter(camera, 0, motion.width), 0.5 - scaled_jitter(camera, 1, motion.height)}};
    frame.parallel_rows(motion.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) project_row(job, y);
    });
  }

 private:
  struct Job {
    FloatImage position;
    IdImage id;
    FloatOutput motion;
    Projections previous;
    Matrix current;
    std::array<double, 2> center;  // of pixel (0, 0), where a screen without jitter has it
  };

  static double scaled_jitter(const quell_camera& camera, int axis, int size) {
    const int camera_size = axis == 0 ? camera.width : camera.height;
    return camera.jitter[axis] * (camera_size > 0 ? double(size) / camera_size : 1.0);
  }

  static void fill_zero(const Frame& frame, const FloatOutput& motion) {
    frame.parallel_rows(motion.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y)
        for (int c = 0; c < 2; ++c) std::fill_n(motion.row(y, c), motion.width, 0.0F);
    });
  }

  void project_row(const Job& job, int y) const {
    const float *px = job.position.row(y, 0), *py = job.position.row(y, 1), *pz = job.position.row(y, 2);
    const std::uint32_t* ids = job.id ? job.id.row(y) : nullptr;
    float *out_x = job.motion.row(y, 0), *out_y = job.motion.row(y, 1);
    Matrix previous = job.previous.still();  // of the last object met: neighbors mostly show the same one
    std::uint32_t last_id = QUELL_NO_ID;
    for (int x = 0; x < job.motion.width; ++x) {
      if (ids && ids[x] == QUELL_NO_ID) {
        out_x[x] = out_y[x] = 0;
        continue;
      }
      if (ids && ids[x] != last_id) previous = job.previous.of(last_id = ids[x]);
      const Point before = project(previous, px[x], py[x], pz[x]);
      Point now{job.center[0] + x, job.center[1] + y, true};
      if (current_ == Current::projected) now = project(job.current, px[x], py[x], pz[x]);
      const double dx = before.x - now.x, dy = before.y - now.y;
      // The comparisons are false for NaN.
      const bool usable = before.in_front && std::abs(dx) <= kFarAway && std::abs(dy) <= kFarAway;
      out_x[x] = usable ? static_cast<float>(dx) : kFarAway;
      out_y[x] = usable ? static_cast<float>(dy) : kFarAway;
    }
  }

  Current current_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::BackProjectPass, quell::Params)
