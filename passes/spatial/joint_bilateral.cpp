// Joint bilateral filter: a mean over a window, weighted by how near a tap is in the image or the world, in color, in the
// direction of its surface, and to the plane of the pixel's surface.
// Source:  Eisemann & Durand, "Flash Photography Enhancement via Intrinsic Relighting", SIGGRAPH 2004, and Petschnigg et al.,
//          "Digital Photography with Flash and No-Flash Image Pairs", SIGGRAPH 2004, for the filter; GAMES202 (Yan, 2021),
//          homework 5, for this set of terms.
// Departs: the angle of two normals is taken from their difference, not from acos(n.n'), which loses all digits where they are
//          close; for unit normals it is the same. A pixel without surface counts for no other and keeps its color.
// Cost:    (2 radius + 1)^2 taps a pixel, each 45 vector operations with all terms, none of them a division.
#include <cmath>
#include <stdexcept>

#include "passes/spatial/joint_bilateral_kernel.h"
#include "quell/sdk/pass.h"

namespace {

using namespace quell;

enum class Distance { pixels, world };

struct Params {
  int radius = 16;
  Distance coord = Distance::pixels;
  double sigma_coord = 32;
  double sigma_color = 0.8;
  double sigma_normal = 0.1;
  double sigma_plane = 0.1;
  void describe(auto&& field) {
    field("radius", radius, Range<int>{0, joint_bilateral::kMaxRadius}, "px", "The window is 2 radius + 1 pixels wide and high.");
    field("coord", coord,
          Choices{{"pixels", "distance in the image, as the published formula has it"},
                  {"world", "distance of the positions, as the published listing has it; needs position"}},
          "What distance sigma_coord is about.");
    field("sigma_coord", sigma_coord, Range<double>{1e-3, 1e6}, "px or world unit", "Tolerated distance.");
    field("sigma_color", sigma_color, Range<double>{1e-6, 1e6}, "radiance", "Tolerated distance of color, over all channels.");
    field("sigma_normal", sigma_normal, Range<double>{1e-3, 1e6}, "rad", "Tolerated angle between normals. Needs normal.");
    field("sigma_plane", sigma_plane, Range<double>{1e-3, 1e6}, "1",
          "Tolerated sine of the angle by which a tap rises from the pixel's tangent plane. Needs normal and position.");
  }
};

const PassInfo kInfo{
    .id = "joint_bilateral",
    .summary = "Mean over a window, weighted by distance, color, normal and tangent plane",
    .doc =
        "The weight of tap q for pixel p is exp(-d^2/2 sigma_coord^2 - |c-c'|^2/2 sigma_color^2 - acos(n.n')^2/2 sigma_normal^2"
        " - (n.(p'-p)/|p'-p|)^2/2 sigma_plane^2). The last term is 0 where the points coincide. Terms whose inputs are absent are"
        " left out. Taps outside the image are left out, and so are those that have no surface (normal 0) or are not finite;"
        " such a pixel keeps its own color. Normals have unit length, colors are below 1e18 and positions below 1e9. Within"
        " 1e-4 of double precision for a sigma_plane of 0.1 and more.",
    .source =
        "Eisemann & Durand, Flash Photography Enhancement via Intrinsic Relighting, SIGGRAPH 2004; Petschnigg et al., Digital"
        " Photography with Flash and No-Flash Image Pairs, SIGGRAPH 2004; the set of terms is that of GAMES202, homework 5."
        " Departs: the angle between normals is computed from their difference.",
    .inputs = {{"color", kColor, "what is filtered, and a guide"},
               {"normal", kNormal, "guide; needed for the normal and plane terms", true},
               {"position", kPosition, "guide; needed for the plane term and for distances in the world", true}},
    .outputs = {{"color", kColor, "filtered radiance"}}};

/// The terms of the exponent that depend on the distance in the image alone, in units of squared color distance.
std::vector<float> pixel_distances(const Params& p) {
  const double factor = p.coord == Distance::pixels ? p.sigma_color * p.sigma_color / (p.sigma_coord * p.sigma_coord) : 0;
  std::vector<float> distances;
  for (int dy = 0; dy <= p.radius; ++dy)
    for (int dx = -p.radius; dx <= p.radius; ++dx) distances.push_back(static_cast<float>(factor * (dx * dx + dy * dy)));
  return distances;
}

joint_bilateral::Settings make_settings(const Params& p) {
  const double variance = p.sigma_color * p.sigma_color;
  joint_bilateral::Settings s;
  s.radius = p.radius;
  s.gain = static_cast<float>(1 / (2 * std::log(2.0) * variance));
  s.normal_factor = static_cast<float>(variance / (p.sigma_normal * p.sigma_normal));
  s.plane_factor = static_cast<float>(p.sigma_color / p.sigma_plane);
  s.position_factor = p.coord == Distance::world ? static_cast<float>(variance / (p.sigma_coord * p.sigma_coord)) : 0.0F;
  s.pixel_distances = pixel_distances(p);
  s.wide_normals = p.sigma_normal > joint_bilateral::kLargestNarrowSigma;
  return s;
}

class JointBilateral final : public Pass {
 public:
  explicit JointBilateral(const Params& params)
      : settings_(make_settings(params)), needs_position_(params.coord == Distance::world) {}

  void infer(Inference& inference) const override {
    require_position(inference.present("position"));
    for (const char* input : {"color", "normal", "position"}) inference.set_radius(input, settings_.radius);
    inference.set_slot_scratch(joint_bilateral::scratch_bytes(settings_.radius));
  }
  void run(const Frame& frame) const override {
    const joint_bilateral::Images in{frame.image("color"), frame.image("normal"), frame.image("position")};
    require_position(static_cast<bool>(in.position));
    const FloatOutput out = frame.output("color");
    frame.parallel_rows(out.height, [&](int y0, int y1, std::uint32_t slot) {
      joint_bilateral::filter_rows(in, settings_, out, y0, y1, static_cast<float*>(frame.slot_scratch(slot)));
    });
  }

 private:
  void require_position(bool present) const {
    if (needs_position_ && !present)
      throw std::invalid_argument(
          "coord is \"world\", which measures distances between positions, but the input 'position' is absent; connect it, or set"
          " coord to \"pixels\"");
  }
  joint_bilateral::Settings settings_;
  bool needs_position_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, JointBilateral, Params)
