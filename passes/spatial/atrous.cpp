// One level of the edge-avoiding à-trous wavelet: 5 x 5 taps, a power of two apart, weighted by a B3 spline and by what tells an
// edge.
//
// Source:  Dammertz et al., "Edge-Avoiding À-Trous Wavelet Transform for fast Global Illumination Filtering", HPG 2010. The stops
//          svgf: Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, equations 3 to 5. The stops
//          joint_bilateral: GAMES202 (Yan, 2021), homework 5.
//
// Departs: as kInfo's source says.
//
// Cost:    25 taps a pixel, whatever the level, each 32 vector operations and 12 loads with svgf's stops.
#include <cmath>

#include "passes/spatial/atrous_kernel.h"
#include "quell/sdk/pass.h"

namespace {

using namespace quell;
using atrous::Stops;

enum class PhiColor { same, halved, quartered };

struct Params {
  int level = 0;
  Stops stops = Stops::svgf;
  double sigma_z = 1, eps_z = 1e-6, sigma_n = 128, sigma_l = 4, eps_l = 1e-8, eps_variance = 0;
  double phi_color = 1, phi_normal = 0.1, phi_position = 1;
  PhiColor phi_color_per_level = PhiColor::quartered;
  double sigma_color = 0.8, sigma_normal = 0.1, sigma_plane = 0.1, sigma_coord = 32;
  void describe(auto&& field) {
    field("level", level, Range<int>{0, atrous::kLargestLevel}, "log2 px", "Taps are 2^level pixels apart.");
    field("stops", stops,
          Choices{{"svgf", "luminance against its variance, depth against its slope, and a power of the normals' cosine"},
                  {"dammertz", "squared distances of color, normal and position"},
                  {"joint_bilateral", "the terms of the joint bilateral filter, at these taps"}},
          "What tells an edge.");
    field("sigma_z", sigma_z, Range<double>{0, 1e6}, "1", "svgf: tolerated difference in depth, over what the slope explains.");
    field("eps_z", eps_z, Range<double>{0, 1}, "1",
          "svgf: difference in depth that is tolerated anyway, over the depth. Floats need 1e-7, half floats 1e-3.");
    field("sigma_n", sigma_n, Range<double>{1, 1024}, "1", "svgf: power of the cosine between normals.");
    field("sigma_l", sigma_l, Range<double>{0, 1e6}, "1", "svgf: tolerated difference in luminance, over its deviation.");
    field("eps_l", eps_l, Range<double>{0, 1e6}, "radiance", "svgf: difference in luminance that is tolerated anyway.");
    field("eps_variance", eps_variance, Range<double>{0, 1e6}, "radiance^2",
          "svgf: added to the variance that luminances are judged by.");
    field("phi_color", phi_color, Range<double>{1e-12, 1e12}, "radiance^2",
          "dammertz: tolerated squared distance of color, at level 0.");
    field("phi_color_per_level", phi_color_per_level,
          Choices{{"same", "phi_color is for each level"},
                  {"halved", "phi_color 2^-level"},
                  {"quartered", "phi_color 4^-level, with which the tolerated distance is halved, as the paper has it"}},
          "dammertz: what becomes of phi_color from level to level.");
    field("phi_normal", phi_normal, Range<double>{1e-6, 1e12}, "1",
          "dammertz: tolerated squared distance of normals, over the squared distance of taps in pixels.");
    field("phi_position", phi_position, Range<double>{1e-12, 1e12}, "world unit^2",
          "dammertz: tolerated squared distance of positions.");
    field("sigma_coord", sigma_coord, Range<double>{1e-3, 1e6}, "px", "joint_bilateral: tolerated distance in the image.");
    field("sigma_color", sigma_color, Range<double>{1e-6, 1e6}, "radiance",
          "joint_bilateral: tolerated distance of color, over all channels.");
    field("sigma_normal", sigma_normal, Range<double>{1e-3, 1e6}, "rad", "joint_bilateral: tolerated angle between normals.");
    field("sigma_plane", sigma_plane, Range<double>{1e-3, 1e6}, "1",
          "joint_bilateral: tolerated sine of the angle by which a tap rises from the pixel's tangent plane.");
  }
};

const PassInfo kInfo{
    .id = "atrous",
    .summary = "One level of the edge-avoiding à-trous wavelet, with the stops of SVGF, Dammertz or the joint bilateral filter",
    .doc =
        "color = sum h w c' / sum h w over 5 x 5 taps that are step = 2^level pixels apart; h is 3/8, 1/4, 1/16 at 0, 1 and 2"
        " steps in x, times the same in y. variance = sum h^2 w^2 variance' / (sum h w)^2.\n\n"
        "svgf: w = exp(-|z-z'| / (sigma_z |grad z.(p-p')| + eps_z z)) max(0, n.n')^sigma_n"
        " exp(-|l-l'| / (sigma_l deviation + eps_l)). l is luminance; the deviation is the root of eps_variance plus the blurred"
        " variance, or, when that input is absent, plus the variance blurred here by 1/4, 1/2, 1/4 in x and y. Of grad z, each"
        " component is the smaller of the differences to the two neighbors. When the depth's gradient is given, it replaces"
        " |grad z.(p-p')| by the gradient times the distance of the taps.\n\n"
        "dammertz: w = exp(-|c-c'|^2 / phi - |n-n'|^2 / (phi_normal step^2) - |p-p'|^2 / phi_position).\n\n"
        "joint_bilateral: w is that of the pass joint_bilateral with distances in pixels.\n\n"
        "Terms whose inputs are absent are left out, and so are taps outside the image, taps without surface (normal 0, or,"
        " with svgf, depth 1e10) and taps that are not finite; such a pixel keeps its own color and variance. Normals have unit"
        " length. Luminances and positions are below 1e9, and sigma_l times a deviation below 1e15. Within 1e-4 of double"
        " precision for a sigma_n up to 128, luminances up to 40 sigma_l deviations, a sigma_plane from 0.02 on, and taps up to"
        " 1000 times as bright as the pixel, 10 times for a sigma_n of 64. Fireflies behind a bend of the surface count with"
        " a weight that has the fewer right digits the smaller it is.",
    .source =
        "Dammertz et al., Edge-Avoiding À-Trous Wavelet Transform for fast Global Illumination Filtering, HPG 2010; Schied"
        " et al., Spatiotemporal Variance-Guided Filtering, HPG 2017, equations 3 to 5; joint_bilateral: GAMES202, homework 5."
        " Departs: in svgf, eps_z is a fraction of the depth, which is not between 0 and 1 here, and without an input for it"
        " the gradient is taken within the pixel's surface; with one, and with eps_z 0, eps_l 0, eps_variance 1e-10 and"
        " sigma_l 10, the formula is that of the implementation in Falcor. The course's filter has no spline.",
    .inputs = {{"color", kColor, "what is filtered"},
               {"normal", kNormal, "guide", true},
               {"position", kPosition, "guide of dammertz and joint_bilateral", true},
               {"depth", kDepth, "guide of svgf", true},
               {"depth_gradient", kScalar, "svgf: the larger change of depth from a pixel to its neighbor, in x or y", true},
               {"variance", kVariance, "of the color's luminance; a guide of svgf", true},
               {"blurred_variance", kVariance, "svgf: the variance to judge luminances by", true}},
    .outputs = {{"color", kColor, "filtered radiance"},
                {"variance", kVariance, "of the filtered radiance; 0 where no variance is given"}}};

constexpr double kLog2E = 1.4426950408889634;

void set_guided(atrous::Settings& s, double phi, double normal, double position, double plane) {
  s.gain = static_cast<float>(kLog2E / phi);
  s.normal_factor = static_cast<float>(phi / normal);
  s.position_factor = static_cast<float>(position);
  s.plane_factor = static_cast<float>(plane);
}

atrous::Settings make_settings(const Params& p) {
  atrous::Settings s;
  s.stops = p.stops;
  s.step = 1 << p.level;
  const double step = s.step;
  for (std::size_t i = 0; i < atrous::kPairs.size(); ++i) {
    const auto& [dx, dy, h, length] = atrous::kPairs[i];
    const double distance = p.stops == Stops::joint_bilateral ? step * length / p.sigma_coord : 0;
    s.offset_exponents[i] = static_cast<float>(std::log2(h) - kLog2E / 2 * distance * distance);
  }
  if (p.stops == Stops::svgf) {
    s.slope_factor = static_cast<float>(p.sigma_z * step / kLog2E);
    s.depth_eps = static_cast<float>(p.eps_z / kLog2E);
    s.normal_power = static_cast<float>(p.sigma_n * kLog2E);
    s.luminance_factor = static_cast<float>(p.sigma_l / kLog2E);
    s.luminance_eps = static_cast<float>(p.eps_l / kLog2E);
    s.variance_eps = static_cast<float>(p.eps_variance);
    s.wide_normals = p.sigma_n < atrous::kSmallestNarrowPower;
  } else if (p.stops == Stops::dammertz) {
    const int halvings = p.phi_color_per_level == PhiColor::same ? 0 : p.phi_color_per_level == PhiColor::halved ? 1 : 2;
    const double phi = std::ldexp(p.phi_color, -halvings * p.level);
    set_guided(s, phi, p.phi_normal * step * step, phi / p.phi_position, 0);
  } else {
    const double phi = 2 * p.sigma_color * p.sigma_color;
    set_guided(s, phi, 2 * p.sigma_normal * p.sigma_normal, 0, p.sigma_color / p.sigma_plane);
    s.wide_normals = p.sigma_normal > atrous::kLargestNarrowSigma;
  }
  return s;
}

class Atrous final : public Pass {
 public:
  explicit Atrous(const Params& params) : settings_(make_settings(params)) {}

  void infer(Inference& inference) const override {
    for (const char* input : {"color", "normal", "position", "depth", "variance"})
      inference.set_radius(input, 2 * settings_.step);
    inference.set_slot_scratch(atrous::scratch_bytes());
  }
  void run(const Frame& frame) const override {
    const atrous::Images in{frame.image("color"),           frame.image("normal"),         frame.image("position"),
                            frame.image("depth"),           frame.image("depth_gradient"), frame.image("variance"),
                            frame.image("blurred_variance")};
    const FloatOutput color = frame.output("color"), variance = frame.output("variance");
    frame.parallel_rows(
        color.height,
        [&](int begin, int end, std::uint32_t slot) {
          atrous::filter_turns(in, settings_, color, variance, begin, end, static_cast<float*>(frame.slot_scratch(slot)));
        },
        kTurnsPerChunk);
  }

 private:
  static constexpr int kTurnsPerChunk = 32;  // of which each reads 4 rows more than it makes
  atrous::Settings settings_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Atrous, Params)
