// A wide, sparse filter where history is short: what has just come into view borrows light from around it.
// Source:  RELAX of NVIDIA's NRD, history fix: 5 x 5 taps that are stride / (1 + length) pixels apart, weighted by normal and
//          distance from the pixel's tangent plane.
// Departs: taps outside the image are left out, not mirrored; where there are no positions depth is compared as in SVGF (Schied
//          et al., HPG 2017); one filter for all images, without the parts that need roughness.
// Cost:    24 taps of some 30 operations where history is short, for each distance of taps among neighbors; else a copy.
#include "passes/temporal/history_fix_kernel.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "quell/sdk/pass.h"

namespace {

using namespace quell;
using history_fix::Fixed;

struct Params {
  double min_length = 4, stride = 14;
  double sigma_n = 8, sigma_z = 1, plane_relative = 0.003, plane_absolute = 0;
  void describe(auto&& field) {
    field("min_length", min_length, Range<double>{0, 1e6}, "frames", "The history is short, and filtered, below this.");
    field("stride", stride, Range<double>{0, 256}, "px",
          "Taps are stride / (1 + length) pixels apart, rounded: with 14, 7 pixels in a first frame.");
    field("sigma_n", sigma_n, Range<double>{0, 1024}, "1", "Power of the cosine between normals; 0: any normal.");
    field("sigma_z", sigma_z, Range<double>{1e-3, 1e6}, "1",
          "Tolerated difference in depth, over what its gradient explains. Without positions only.");
    field("plane_relative", plane_relative, Range<double>{0, 1e6}, "1",
          "Tolerated distance from the tangent plane, over the depth.");
    field("plane_absolute", plane_absolute, Range<double>{0, 1e6}, "world units",
          "Tolerated distance from the tangent plane; added. Without depth it alone counts.");
  }
};

const PassInfo kInfo{
    .id = "history_fix",
    .summary = "Filters widely where history is short",
    .doc =
        "Where length is below min_length, each image becomes its mean over 5 x 5 taps that are s = round(stride / (1 + "
        "length)) pixels apart, half to even; a length below 1 counts as 1. The pixel itself has weight 1, a tap max(0, "
        "n.n')^sigma_n, where it has the same id and |n.(p' - p)| <= plane_relative z + plane_absolute, else 0. Where there "
        "is no position or no normal, but a depth with its gradient, exp(-|z - z'| / (sigma_z max(g, 1e-8) d)) takes the "
        "place of the plane, with the distance d in pixels. Terms whose inputs are absent are left out. Taps outside the "
        "image and without surface (depth 1e10) do not count; pixels without surface, and those with a longer history, stay "
        "as they are, bit for bit.\n\n"
        "All images share the weights: give it the history's color and its moments together.",
    .source =
        "NVIDIA Real-Time Denoisers (NRD) 4.17, RELAX, history fix: 5 x 5 taps, stride 14, 3 frames, power 8 of the cosine, "
        "and 0.003 of the depth as distance from the plane. Departs: NRD mirrors taps at the border, leaves out those of a "
        "weight below 1e-4, and keeps cosines above 0.01; depth by its gradient is that of Schied et al., \"Spatiotemporal "
        "Variance-Guided Filtering\", HPG 2017.",
    .inputs = {{.name = "image", .types = kAnyFloatImage, .doc = "what to filter", .array = true},
               {"length", kScalar, "how many frames the history reaches back"},
               {"depth", kDepth, "guide", true},
               {"depth_gradient", kScalar, "the larger change of depth from a pixel to its neighbor, in x or y", true},
               {"normal", kNormal, "guide", true},
               {"position", kPosition, "guide; counts together with a normal", true},
               {"id", kId, "objects, which are kept apart", true}},
    .outputs = {{.name = "image", .doc = "the same, filtered where history is short", .array = true, .same_as = "image"}},
};

constexpr double kLog2E = 1.4426950408889634;

history_fix::Settings make_settings(const Params& p) {
  return {.min_length = static_cast<float>(p.min_length),
          .stride = static_cast<float>(p.stride),
          .depth_factor = static_cast<float>(p.sigma_z / kLog2E),
          .normal_power = static_cast<float>(p.sigma_n * kLog2E),
          .plane_relative = static_cast<float>(p.plane_relative),
          .plane_absolute = static_cast<float>(p.plane_absolute)};
}

class HistoryFix final : public Pass {
 public:
  explicit HistoryFix(const Params& params) : settings_(make_settings(params)) {}

  void infer(Inference& inference) const override {
    const int radius = history_fix::kTapsAside * history_fix::stride(settings_, 1);
    for (const char* input : {"image", "depth", "normal", "position", "id"}) inference.set_radius(input, radius);
    inference.set_slot_scratch(inference.count("image") * sizeof(Fixed));
  }

  void run(const Frame& frame) const override {
    const history_fix::Guides in{frame.image("length"), frame.image("depth"),    frame.image("depth_gradient"),
                                 frame.image("normal"), frame.image("position"), frame.ids("id")};
    frame.parallel_rows(in.length.height, [&](int y0, int y1, std::uint32_t slot) {
      const std::span<const Fixed> images = collect(frame, static_cast<Fixed*>(frame.slot_scratch(slot)));
      for (int y = y0; y < y1; ++y) history_fix::fix_row(in, settings_, images, y);
    });
  }

 private:
  // Images that are absent in this frame are left out.
  static std::span<const Fixed> collect(const Frame& frame, Fixed* images) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < frame.count("image"); ++i)
      if (const FloatImage image = frame.image("image", i))
        std::construct_at(images + count++, Fixed{image, frame.output("image", i)});
    return {images, count};
  }

  history_fix::Settings settings_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, HistoryFix, Params)
