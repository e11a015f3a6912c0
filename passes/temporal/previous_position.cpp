// Where the surface point that a pixel shows stood one frame ago, and how far from the camera of then: what an image of the
// previous frame's positions or depths has to be compared with.
//
// Source:  p_prev = M_prev(id) inverse(M_cur(id)) p, as in back_project; its depth is that along the previous camera's view axis.
//
// Cost:    12 multiplications and 4 divisions in double a pixel; one 4x4 inverse wherever a row comes to another object that
// moved.
#include <cmath>

#include "passes/temporal/back_projection.h"
#include "quell/sdk/pass.h"

namespace quell {
namespace {

using namespace back_projection;

struct Params {};

const PassInfo kInfo{
    .id = "previous_position",
    .summary = "Positions and depths that surfaces had one frame ago, with their objects' matrices",
    .doc =
        "Carries every surface point back to where it stood one frame ago, with its object, if that moved, and measures its "
        "depth "
        "from the previous camera. Connected to position and depth of reproject, these keep the history of what moves toward the "
        "camera or away from it, which tests against present positions and depths would take for something else.\n\n"
        "The point is the pixel's position or, where there are no positions, what lies at its depth on the ray through its "
        "center; "
        "with both, depth is not looked at. Objects that are not in both cameras' tables did not move. Without a previous "
        "camera, "
        "as in the first frame, everything is as in this frame. Pixels without surface, and points that cannot be carried back, "
        "have position 0 and depth 1e10. The depth of a point that lay behind the previous camera is negative.",
    .source =
        "GAMES202 (Real-Time High Quality Rendering, 2021), back projection: M' inverse(M) world. Nehab et al., \"Accelerating "
        "Real-Time Shading with Reverse Reprojection Caching\", Graphics Hardware 2007: the cache holds depths, and a hit is "
        "where "
        "the depth that a point had then is the one cached.",
    .inputs = {{"position", kPosition, "world-space position of the surface in each pixel", true},
               {"depth", kDepth, "distance along the view axis, where there is no position", true},
               {"id", kId, "object of each pixel; without it every pixel is a surface, and nothing but the camera moves", true},
               {"camera", kCamera, "the camera of this frame, with the objects' matrices"},
               {"previous_camera", kCamera, "the camera of the previous frame; absent in the first", true}},
    .outputs = {{"position", kPosition, "world-space position that the surface had one frame ago"},
                {"depth", kDepth, "its distance along the view axis of the previous camera"}},
};

// False for NaN.
bool is_place(double coordinate) { return std::abs(coordinate) < double{QUELL_NO_SURFACE_DEPTH}; }

class PreviousPositionPass final : public Pass {
 public:
  explicit PreviousPositionPass(const Params&) {}

  void infer(Inference& inference) const override { Surface::require(inference); }

  void run(const Frame& frame) const override {
    const FloatOutput position = frame.output("position");
    const quell_camera& camera = *frame.camera("camera");
    const quell_camera* before = frame.camera("previous_camera");
    const quell_camera& previous = before ? *before : camera;
    const Surface surface(frame, camera, position.width, position.height);
    const Job job{surface, position, frame.output("depth"), WayBack(camera, previous, surface.to_world(), kIdentity),
                  depth_axis(previous).axis};
    frame.parallel_rows(position.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) carry_row_back(job, y);
    });
  }

 private:
  struct Job {
    Surface surface;
    FloatOutput position, depth;
    WayBack previous;
    Row axis;
  };

  static void carry_row_back(const Job& job, int y) {
    float *out_x = job.position.row(y, 0), *out_y = job.position.row(y, 1), *out_z = job.position.row(y, 2);
    float* out_depth = job.depth.row(y);
    const Surface::Pixels pixels = job.surface.row(y);
    WayBack previous = job.previous;
    for (int x = 0; x < job.position.width; ++x) {
      out_x[x] = out_y[x] = out_z[x] = 0;
      out_depth[x] = QUELL_NO_SURFACE_DEPTH;
      if (!pixels.is_at(x)) continue;
      const Projected p = transform(previous.of(pixels.id(x)), pixels.point(x));
      const double px = p.x / p.w, py = p.y / p.w, pz = p.z / p.w;
      const double depth = job.axis[0] * px + job.axis[1] * py + job.axis[2] * pz + job.axis[3];
      if (!is_place(px) || !is_place(py) || !is_place(pz) || !is_place(depth)) continue;
      out_x[x] = static_cast<float>(px), out_y[x] = static_cast<float>(py), out_z[x] = static_cast<float>(pz);
      out_depth[x] = static_cast<float>(depth);
    }
  }
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::PreviousPositionPass, quell::Params)
