// Variance of luminance: from its moments over time where history is long, from those of the neighborhood where it is short.
//
// Source:  Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, section 4.2: temporal variance from four frames
// of
//          history on, before that an estimate over 7 x 7 pixels, weighted by depth and normal.
//
// Departs: the estimate averages the moments; boost, sigma_l and filter_color are those of Falcor's SVGFPass.
//
// Cost:    one multiply-add a pixel where history is long; (2 radius + 1)^2 taps of some 35 operations where it is short.
#include <cmath>

#include "passes/spatial/variance_kernel.h"
#include "quell/sdk/pass.h"

namespace {

using namespace quell;

enum class Boost { none, young };

struct Params {
  double min_length = 4;
  int radius = 3;
  double sigma_l = 0, sigma_z = 1, sigma_n = 128;
  Boost boost = Boost::none;
  bool filter_color = false;
  void describe(auto&& field) {
    field("min_length", min_length, Range<double>{0, 1e6}, "frames", "The history is short below this.");
    field("radius", radius, Range<int>{1, variance::kMaxRadius}, "px", "The window has (2 radius + 1)^2 pixels.");
    field("sigma_l", sigma_l, Range<double>{0, 1e6}, "radiance", "Tolerated difference in luminance; 0: any.");
    field("sigma_z", sigma_z, Range<double>{1e-3, 1e6}, "1", "Tolerated difference in depth, over what its gradient explains.");
    field("sigma_n", sigma_n, Range<double>{1, 1024}, "1", "Power of the cosine between normals.");
    field("boost", boost,
          Choices{{"none", "the estimate as it is"},
                  {"young", "times min_length / length, since an estimate from few frames is too low as often as too high"}},
          "What raises the variance of short histories.");
    field("filter_color", filter_color, "Averages the color over the same window, too, where history is short.");
  }
};

const PassInfo kInfo{
    .id = "variance",
    .summary = "Variance of luminance, over time or, where history is short, over the neighborhood",
    .doc =
        "variance = max(0, m2 - m1^2) of the moments m1, m2. Where length is below min_length (everywhere without a length), of "
        "their means over the window, with the weights exp(-|l-l'| / sigma_l - |z-z'| / (sigma_z max(g, 1e-8) d)) "
        "max(0, n.n')^sigma_n: l is luminance, z depth, g its gradient, n the normal and d the distance in pixels. Terms whose "
        "inputs are absent are left out; depth needs its gradient. Taps outside the image and without surface (depth 1e10) do "
        "not "
        "count, and pixels without surface keep their own moments.",
    .source =
        "Schied et al., \"Spatiotemporal Variance-Guided Filtering\", HPG 2017, section 4.2. Departs: moments are averaged, and "
        "the "
        "depth's tolerance is the gradient times the distance, as in Falcor's SVGFPass, whose form has sigma_l 10, sigma_z 3, "
        "boost "
        "young and filter_color true.",
    .inputs = {{"moments", kMoments, "first and second moment of luminance over time"},
               {"length", kScalar, "frames that they reach back", true},
               {"color", kColor, "what the moments are of"},
               {"depth", kDepth, "guide", true},
               {"depth_gradient", kScalar, "the larger change of depth from a pixel to its neighbor, in x or y", true},
               {"normal", kNormal, "guide", true}},
    .outputs = {{"variance", kVariance, "of luminance"},
                {"color", kColor, "the color; where history is short, and filter_color says so, its mean over the window"}}};

constexpr double kLog2E = 1.4426950408889634;

variance::Settings make_settings(const Params& p) {
  variance::Settings s{.radius = p.radius,
                       .min_length = static_cast<float>(p.min_length),
                       .luminance_factor = p.sigma_l > 0 ? static_cast<float>(kLog2E / p.sigma_l) : 0,
                       .normal_power = static_cast<float>(p.sigma_n * kLog2E),
                       .wide_normals = p.sigma_n < 64,
                       .boost = p.boost == Boost::young,
                       .filter_color = p.filter_color};
  for (std::size_t dy = 0; dy <= variance::kMaxRadius; ++dy)
    for (std::size_t dx = 0; dx <= variance::kMaxRadius; ++dx)
      if (dx + dy > 0)
        s.depth_factors[dy][dx] =
            static_cast<float>(kLog2E / (p.sigma_z * std::hypot(static_cast<double>(dx), static_cast<double>(dy))));
  return s;
}

class Variance final : public Pass {
 public:
  explicit Variance(const Params& params) : settings_(make_settings(params)) {}

  void infer(Inference& inference) const override {
    for (const char* input : {"moments", "depth", "normal"}) inference.set_radius(input, settings_.radius);
    if (settings_.filter_color || settings_.luminance_factor > 0)
      inference.set_radius("color", settings_.radius);
    else
      inference.set_in_place("color", "color");
    inference.set_slot_scratch(variance::scratch_bytes(inference.size("moments").width, settings_.radius));
  }

  void run(const Frame& frame) const override {
    const variance::Images in{frame.image("moments"), frame.image("length"),         frame.image("color"),
                              frame.image("depth"),   frame.image("depth_gradient"), frame.image("normal")};
    const FloatOutput variance = frame.output("variance"), color = frame.output("color");
    frame.parallel_rows(
        variance.height,
        [&](int y0, int y1, std::uint32_t slot) {
          variance::variance_rows(in, settings_, y0, y1, variance, color, static_cast<float*>(frame.slot_scratch(slot)));
        },
        kRowsPerChunk);
  }

 private:
  static constexpr int kRowsPerChunk = 32;  // of which each band reads 2 radius rows more
  variance::Settings settings_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Variance, Params)
