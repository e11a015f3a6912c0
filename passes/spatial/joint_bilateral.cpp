// Joint bilateral filter: a mean over a window, weighted by how near a tap is in the image or the world, in color, in the
// direction of its surface, and to the plane of the pixel's surface or in depth.
// Source:  Eisemann & Durand, "Flash Photography Enhancement via Intrinsic Relighting", SIGGRAPH 2004, and Petschnigg et al.,
//          "Digital Photography with Flash and No-Flash Image Pairs", SIGGRAPH 2004, for the filter; GAMES202 (Yan, 2021),
//          homework 5, for this set of terms; dtysky's WebGPU path tracer (2021), denoiseSpace.comp.wgsl, for differences of
//          normals and of z; Pham & van Vliet, "Separable bilateral filtering for fast video preprocessing", ICME 2005, for
//          separable.
// Departs: the angle of two normals is taken from their difference, not from acos(n.n'), which loses all digits where they are
//          close; for unit normals it is the same. A pixel without surface counts for no other and keeps its color.
// Cost:    (2 radius + 1)^2 taps a pixel, each 45 vector operations with all terms, none of them a division; separable, 2
//          (2 radius + 1).
#include <cmath>
#include <stdexcept>

#include "passes/spatial/joint_bilateral_filter.h"
#include "quell/sdk/pass.h"

namespace {

using namespace quell;

enum class Distance { pixels, world };
enum class Measure { angle, difference };
enum class Surface { plane, z };

struct Params {
  int radius = 16;
  Distance coord = Distance::pixels;
  double sigma_coord = 32;
  double sigma_color = 0.8;
  Measure normal_measure = Measure::angle;
  double sigma_normal = 0.1;
  Surface surface = Surface::plane;
  double sigma_plane = 0.1, sigma_z = 0.5;
  bool separable = false;
  void describe(auto&& field) {
    field("radius", radius, Range<int>{0, joint_bilateral::kMaxRadius}, "px", "The window is 2 radius + 1 pixels wide and high.");
    field("coord", coord,
          Choices{{"pixels", "distance in the image, as the published formula has it"},
                  {"world", "distance of the positions, as the published listing has it; needs position"}},
          "What distance sigma_coord is about.");
    field("sigma_coord", sigma_coord, Range<double>{1e-3, 1e6}, "px or world unit", "Tolerated distance.");
    field("sigma_color", sigma_color, Range<double>{1e-6, 1e6}, "radiance", "Tolerated distance of color, over all channels.");
    field("normal_measure", normal_measure,
          Choices{{"angle", "acos(n.n'), in rad"}, {"difference", "|n - n'|, as in the WebGPU path tracer"}},
          "What sigma_normal is about.");
    field("sigma_normal", sigma_normal, Range<double>{1e-3, 1e6}, "rad or 1",
          "Tolerated angle between normals, or length of their difference. Needs normal.");
    field("surface", surface,
          Choices{{"plane", "by how steeply the way to the tap rises from the pixel's tangent plane; needs normal and position"},
                  {"z",
                   "by the third coordinate of position, as in the WebGPU path tracer; needs position. It is the depth only"
                   " where positions are relative to the camera"}},
          "How positions are compared.");
    field("sigma_plane", sigma_plane, Range<double>{1e-3, 1e6}, "1",
          "Tolerated sine of the angle by which a tap rises from the pixel's tangent plane. Only where surface is plane.");
    field("sigma_z", sigma_z, Range<double>{1e-3, 1e6}, "world unit", "Tolerated difference of z. Only where surface is z.");
    field("separable", separable,
          "Filters over a row, and the result over a column, which is an approximation: exact only where weights do not depend on"
          " colors and surfaces. Streaks may appear along edges that are neither level nor upright.");
  }
};

const PassInfo kInfo{
    .id = "joint_bilateral",
    .summary = "Mean over a window, weighted by distance, color, normal, and tangent plane or z",
    .doc =
        "The weight of tap q for pixel p is exp(-d^2/2 sigma_coord^2 - |c-c'|^2/2 sigma_color^2 - acos(n.n')^2/2 sigma_normal^2"
        " - (n.(p'-p)/|p'-p|)^2/2 sigma_plane^2). The last term is 0 where the points coincide. Where normal_measure is"
        " difference, |n-n'| takes the place of the angle; where surface is z, (p_z-p'_z)^2/2 sigma_z^2 that of the last term."
        " Terms whose inputs are absent are left out. Taps outside the image are left out, and so are those that have no surface"
        " (normal 0) or are not finite; such a pixel keeps its own color. Normals have unit length, colors are below 1e18 and"
        " positions below 1e9. Within 1e-4 of double precision for a sigma_plane of 0.1 and more.\n\n"
        "A weight exp(f x^2), as shaders have it, is one of sigma = sqrt(-1 / 2 f).",
    .source =
        "Eisemann & Durand, Flash Photography Enhancement via Intrinsic Relighting, SIGGRAPH 2004; Petschnigg et al., Digital"
        " Photography with Flash and No-Flash Image Pairs, SIGGRAPH 2004; the set of terms is that of GAMES202, homework 5, or,"
        " with difference and z, of dtysky's WebGPU path tracer (2021, denoiseSpace.comp.wgsl). separable: Pham & van Vliet,"
        " Separable bilateral filtering for fast video preprocessing, ICME 2005. Departs: the angle between normals is computed"
        " from their difference; pixels without surface take no part.",
    .inputs = {{"color", kColor, "what is filtered, and a guide"},
               {"normal", kNormal, "guide; needed for the normal and plane terms", true},
               {"position", kPosition, "guide; needed for the plane and z terms and for distances in the world", true}},
    .outputs = {{"color", kColor, "filtered radiance"}}};

joint_bilateral::NormalTerm normal_term(const Params& p) {
  using enum joint_bilateral::NormalTerm;
  if (p.normal_measure == Measure::difference) return difference;
  return p.sigma_normal > joint_bilateral::kLargestNarrowSigma ? wide_angle : narrow_angle;
}

joint_bilateral::Filter make_filter(const Params& p) {
  const double variance = p.sigma_color * p.sigma_color, distance_factor = variance / (p.sigma_coord * p.sigma_coord);
  joint_bilateral::Settings s;
  s.gain = static_cast<float>(1 / (2 * std::log(2.0) * variance));
  s.normal_factor = static_cast<float>(variance / (p.sigma_normal * p.sigma_normal));
  s.normal_term = normal_term(p);
  s.compares_z = p.surface == Surface::z;
  s.plane_factor = static_cast<float>(p.sigma_color / p.sigma_plane);
  s.z_factor = static_cast<float>(variance / (p.sigma_z * p.sigma_z));
  s.position_factor = p.coord == Distance::world ? static_cast<float>(distance_factor) : 0.0F;
  return {s, p.radius, p.separable, p.coord == Distance::pixels ? distance_factor : 0};
}

class JointBilateral final : public Pass {
 public:
  explicit JointBilateral(const Params& params)
      : filter_(make_filter(params)), needs_position_(params.coord == Distance::world) {}

  void infer(Inference& inference) const override {
    require_position(inference.present("position"));
    for (const char* input : {"color", "normal", "position"}) inference.set_radius(input, filter_.radius());
    filter_.infer(inference);
  }
  void run(const Frame& frame) const override {
    const joint_bilateral::Images in{frame.image("color"), frame.image("normal"), frame.image("position")};
    require_position(static_cast<bool>(in.position));
    filter_.run(frame, in, frame.output("color"));
  }

 private:
  void require_position(bool present) const {
    if (needs_position_ && !present)
      throw std::invalid_argument(
          "coord is \"world\", which measures distances between positions, but the input 'position' is absent; connect it, or set"
          " coord to \"pixels\"");
  }
  joint_bilateral::Filter filter_;
  bool needs_position_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, JointBilateral, Params)
