// Motion for pixels that have just come into view: they move along with what hid them, to the background beside it.
// Source:  Zeng et al., "Temporally Reliable Motion Vectors for Real-time Ray Tracing", Computer Graphics Forum (Eurographics)
//          2021, occlusions: x' = y + (x - z), y = x + motion(x), z = y + forward(y).
// Departs: the occluder's motion is that of the pixel that contains y, since motion must not be interpolated across its edge.
// Cost:    one fetch a pixel.
#include <cmath>

#include "quell/sdk/pass.h"

namespace quell {
namespace {

struct Params {};

const PassInfo kInfo{
    .id = "dual_motion",
    .summary = "Motion by way of the occluder, where the ordinary one finds no history",
    .doc =
        "Where valid is 0, pixel x was hidden: y = x + motion is where it would have been seen, and what was seen there "
        "instead, the occluder, now is at z = y + forward_motion(y). Keeping its place beside the occluder, x is looked for "
        "at x' = y + (x - z): the motion becomes x' - x = -forward_motion(y), that of the pixel that contains y. What is "
        "found there is the background that was beside the occluder: another point of the same surface, mostly, as the tests "
        "of a second reproject, with this motion, make sure.\n\n"
        "The motion stays as it is where valid is 1, where y is off the screen or showed no surface (previous_id without "
        "object), where the forward motion is not finite or farther than 1e6 pixels, and everywhere while it is absent. "
        "`dual` tells the pixels whose motion is another. back_project gives the forward motion when it is asked the other "
        "way round: position, id and camera with a delay of 1, and this frame's camera as previous_camera.",
    .source =
        "Zeng et al., \"Temporally Reliable Motion Vectors for Real-time Ray Tracing\", Computer Graphics Forum 40 (2), "
        "2021, the part on occlusions. Departs: the fetch of the occluder's motion is the nearest one.",
    .inputs = {{"motion", kMotion, "previous minus current position, pixels, y down"},
               {"valid", kMask, "where that found a history; without it, nowhere", true},
               {"forward_motion", kMotion, "of the previous frame's pixels: current minus previous position, pixels, y down",
                true},
               {"previous_id", kId, "object of each pixel of the previous frame", true}},
    .outputs = {{"motion", kMotion, "previous minus current position, of what is to be fetched, pixels, y down"},
                {"dual", kMask, "1 where it is by way of the occluder"}},
};

constexpr float kFarthest = 1e6F;  // px; motion that means nothing is that long

class DualMotion final : public Pass {
 public:
  explicit DualMotion(const Params&) {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    inference.set_in_place("motion", "motion");
    for (const char* input : {"forward_motion", "previous_id"}) inference.set_unbounded(input);
  }

  void run(const Frame& frame) const override {
    const Job job{frame.image("motion"),    frame.image("valid"),   frame.image("forward_motion"),
                  frame.ids("previous_id"), frame.output("motion"), frame.output("dual")};
    frame.parallel_rows(job.out.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y)
        for (int x = 0; x < job.out.width; ++x) move(job, x, y);
    });
  }

 private:
  struct Job {
    FloatImage motion, valid, forward;
    IdImage previous_id;
    FloatOutput out, dual;
  };
  struct Motion {
    float x, y;
    bool is_usable() const { return std::abs(x) < kFarthest && std::abs(y) < kFarthest; }  // false for NaN
  };
  static Motion at(const FloatImage& image, int x, int y) { return {image.at(x, y, 0), image.at(x, y, 1)}; }

  static void move(const Job& job, int x, int y) {
    const Motion ordinary = at(job.motion, x, y);
    Motion result = ordinary;
    bool is_dual = false;
    if (job.forward && ordinary.is_usable() && !(job.valid && job.valid.at(x, y) > 0.5F)) {
      const int px = x + static_cast<int>(std::floor(ordinary.x + 0.5F)),
                py = y + static_cast<int>(std::floor(ordinary.y + 0.5F));
      if (job.forward.contains(px, py) && !(job.previous_id && job.previous_id.at(px, py) == QUELL_NO_ID)) {
        const Motion occluder = at(job.forward, px, py);
        is_dual = occluder.is_usable();
        if (is_dual) result = {-occluder.x, -occluder.y};
      }
    }
    job.out.at(x, y, 0) = result.x, job.out.at(x, y, 1) = result.y;
    job.dual.at(x, y) = is_dual ? 1.0F : 0.0F;
  }
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::DualMotion, quell::Params)
