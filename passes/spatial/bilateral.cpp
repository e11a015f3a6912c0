// Bilateral filter: a mean over a window, weighted by how near a tap is in the image and in color.
// Source:  Tomasi & Manduchi, "Bilateral Filtering for Gray and Color Images", ICCV 1998; separable: Pham & van Vliet, "Separable
//          bilateral filtering for fast video preprocessing", ICME 2005.
// Departs: colors are compared as they are, scene-linear, not in CIE-Lab.
// Cost:    (2 radius + 1)^2 taps a pixel, each 17 vector operations; separable, 2 (2 radius + 1).
#include <cmath>

#include "passes/spatial/joint_bilateral_filter.h"
#include "quell/sdk/pass.h"

namespace {

using namespace quell;

struct Params {
  int radius = 8;
  double sigma_coord = 3, sigma_color = 0.5;
  bool separable = false;
  void describe(auto&& field) {
    field("radius", radius, Range<int>{0, joint_bilateral::kMaxRadius}, "px", "The window is 2 radius + 1 pixels wide and high.");
    field("sigma_coord", sigma_coord, Range<double>{1e-3, 1e6}, "px", "Tolerated distance in the image.");
    field("sigma_color", sigma_color, Range<double>{1e-6, 1e6}, "radiance", "Tolerated distance of color, over all channels.");
    field("separable", separable,
          "Filters over a row, and the result over a column, which is an approximation: exact only where weights do not depend on"
          " colors. Streaks may appear along edges that are neither level nor upright.");
  }
};

const PassInfo kInfo{
    .id = "bilateral",
    .summary = "Mean over a window, weighted by distance and color",
    .doc =
        "The weight of tap q for pixel p is exp(-d^2/2 sigma_coord^2 - |c-c'|^2/2 sigma_color^2), with the distance d in pixels."
        " Taps outside the image are left out, and so are those that are not finite; such a pixel stays as it is. Colors are"
        " below 1e18. It knows noise from edges by its strength alone: joint_bilateral takes guides as well. Within 3e-5 of"
        " double precision.",
    .source =
        "Tomasi & Manduchi, Bilateral Filtering for Gray and Color Images, ICCV 1998. separable: Pham & van Vliet, Separable"
        " bilateral filtering for fast video preprocessing, ICME 2005. Departs: colors are compared in scene-linear RGB.",
    .inputs = {{"color", kColor, "what is filtered, and its own guide"}},
    .outputs = {{"color", kColor, "filtered radiance"}},
};

joint_bilateral::Filter make_filter(const Params& p) {
  const double variance = p.sigma_color * p.sigma_color;
  joint_bilateral::Settings s;
  s.gain = static_cast<float>(1 / (2 * std::log(2.0) * variance));
  return {s, p.radius, p.separable, variance / (p.sigma_coord * p.sigma_coord)};
}

class Bilateral final : public Pass {
 public:
  explicit Bilateral(const Params& params) : filter_(make_filter(params)) {}

  void infer(Inference& inference) const override {
    inference.set_radius("color", filter_.radius());
    filter_.infer(inference);
  }
  void run(const Frame& frame) const override { filter_.run(frame, {frame.image("color"), {}, {}}, frame.output("color")); }

 private:
  joint_bilateral::Filter filter_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Bilateral, Params)
