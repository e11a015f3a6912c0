// Motion vectors from surface positions, cameras and object matrices: where was what this pixel shows, one frame ago?
// Source:  p_prev = M_prev(id) inverse(M_cur(id)) p, projected by the previous frame's world-to-screen matrix: the back
//          projection of GAMES202 (Real-Time High Quality Rendering, 2021), known from Nehab et al., Graphics Hardware 2007.
//          From depth: the point on the ray through the pixel's center, by the inverse of the current world-to-screen matrix.
// Departs: jitter is taken out of both positions, so that a scene at rest has motion 0 whatever the cameras' jitter.
// Cost:    9 multiplications and 2 divisions in double a pixel; one 4x4 inverse
//          wherever a row comes to another object that moved.
#include <algorithm>
#include <array>
#include <cmath>

#include "passes/temporal/back_projection.h"
#include "quell/sdk/pass.h"

namespace quell {
namespace {

using namespace back_projection;

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
    .summary = "Motion vectors from positions or depth, cameras and object matrices",
    .doc =
        "Carries every surface point back to where it stood one frame ago (with its object, if that moved) and projects it "
        "with the previous camera. The point is the pixel's position or, where there are no positions, what lies at its depth on "
        "the ray through its center; with both, depth is not looked at. Objects that are not in both cameras' tables did not "
        "move. Pixels without surface, and all pixels while there is no previous camera, have motion 0. A point that lay behind "
        "the previous camera, that cannot be projected, or that moved by more than 1e6 pixels has motion (1e6, 1e6), which is "
        "off any screen.\n\n"
        "Cameras of another resolution than the image are scaled to it. Jitter of the cameras is not part of the motion.",
    .source =
        "GAMES202 (Real-Time High Quality Rendering, 2021), back projection: screen = P' V' M' inverse(M) world. Nehab et "
        "al., \"Accelerating Real-Time Shading with Reverse Reprojection Caching\", Graphics Hardware 2007. From depth, world is "
        "where the planes of the pixel's column, row and depth meet, by the inverse of the current camera's matrix.",
    .inputs = {{"position", kPosition, "world-space position of the surface in each pixel", true},
               {"depth", kDepth, "distance along the view axis, where there is no position", true},
               {"id", kId, "object of each pixel; without it every pixel is a surface, and nothing but the camera moves", true},
               {"camera", kCamera, "the camera of this frame, with the objects' matrices"},
               {"previous_camera", kCamera, "the camera of the previous frame; absent in the first", true}},
    .outputs = {{"motion", kMotion, "previous minus current position, pixels, y down"}},
};

struct OnScreen {
  double x = 0, y = 0;
  bool in_front = false;
};

OnScreen project(const Matrix& m, const Point& point) {
  const Projected p = transform(m, point);
  return {p.x / p.w, p.y / p.w, p.w > 0};
}

class BackProjectPass final : public Pass {
 public:
  explicit BackProjectPass(const Params& params) : current_(params.current) {}

  void infer(Inference& inference) const override { Surface::require(inference); }

  void run(const Frame& frame) const override {
    const FloatOutput motion = frame.output("motion");
    const quell_camera& camera = *frame.camera("camera");
    const quell_camera* previous = frame.camera("previous_camera");
    if (!previous) return fill_zero(frame, motion);
    const int width = motion.width, height = motion.height;
    const Surface surface(frame, camera, width, height);
    const Job job{
        surface,
        motion,
        WayBack(camera, *previous, surface.to_world(), world_to_pixel(*previous, width, height)),
        world_to_pixel(camera, width, height) * surface.to_world(),
        {0.5 - camera.jitter[0] * pixel_scale(camera, 0, width), 0.5 - camera.jitter[1] * pixel_scale(camera, 1, height)}};
    frame.parallel_rows(height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) project_row(job, y);
    });
  }

 private:
  struct Job {
    Surface surface;
    FloatOutput motion;
    WayBack previous;
    Matrix current;
    std::array<double, 2> center;  // of pixel (0, 0), where a screen without jitter has it
  };

  static void fill_zero(const Frame& frame, const FloatOutput& motion) {
    frame.parallel_rows(motion.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y)
        for (int c = 0; c < 2; ++c) std::fill_n(motion.row(y, c), motion.width, 0.0F);
    });
  }

  void project_row(const Job& job, int y) const {
    float *out_x = job.motion.row(y, 0), *out_y = job.motion.row(y, 1);
    const Surface::Pixels pixels = job.surface.row(y);
    WayBack previous = job.previous;
    for (int x = 0; x < job.motion.width; ++x) {
      if (!pixels.is_at(x)) {
        out_x[x] = out_y[x] = 0;
        continue;
      }
      const Point point = pixels.point(x);
      const OnScreen before = project(previous.of(pixels.id(x)), point);
      OnScreen now{job.center[0] + x, job.center[1] + y, true};
      if (current_ == Current::projected) now = project(job.current, point);
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
