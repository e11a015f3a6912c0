// Takes the texture out of radiance: what falls on a surface is smoother than what it reflects.
//
// Source:  Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, section 4: illumination is color over albedo.
//
// Departs: emission is taken out first and the albedo has a floor, as in Falcor's SVGFPass.
//
// Cost:    one division a channel; bound by memory.
#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include "quell/sdk/pass.h"
#include "quell/sdk/plain_loop.h"

namespace quell {
namespace {

struct Params {
  double floor = 1e-3;
  void describe(auto&& field) { field("floor", floor, Range<double>{1e-6, 1}, "1", "Smallest albedo that is divided by."); }
};

const PassInfo kInfo{
    .id = "demodulate",
    .summary = "Divides radiance by albedo, so that textures are not smoothed",
    .doc =
        "color[i] = (color[i] - emission) / max(albedo[i], floor), for each channel by itself; emission, where given, is that of "
        "the first color alone. The pass modulate is the inverse. Several colors (diffuse and specular light) have an albedo "
        "each, "
        "or share one. The sign is kept: radiance below the emission gives negative light.",
    .source =
        "Schied et al., \"Spatiotemporal Variance-Guided Filtering\", HPG 2017, section 4. Departs: the floor, and that emission "
        "is "
        "taken out, are those of Falcor's SVGFPass, whose floor is 1e-3.",
    .inputs = {{.name = "color", .types = kColor, .doc = "radiance", .array = true},
               {.name = "albedo", .types = kAlbedo, .doc = "reflectance; one for each color, or one for all", .array = true},
               {"emission", kColor, "radiance that the surface emits, part of the first color", true}},
    .outputs = {{.name = "color", .doc = "light on the surface", .array = true, .same_as = "color"}},
};

class Demodulate final : public Pass {
 public:
  explicit Demodulate(const Params& params) : floor_(static_cast<float>(params.floor)) {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    if (inference.count("albedo") != 1 && inference.count("albedo") != inference.count("color"))
      throw std::runtime_error("there must be one albedo, or as many as there are colors");
  }

  void run(const Frame& frame) const override {
    for (std::size_t i = 0; i < frame.count("color"); ++i) {
      const FloatImage color = frame.image("color", i), albedo = frame.image("albedo", frame.count("albedo") == 1 ? 0 : i);
      const FloatImage emission = i == 0 ? frame.image("emission") : FloatImage{};
      const FloatOutput out = frame.output("color", i);
      if (!out) continue;  // absent in this frame
      frame.parallel_rows(out.height, [&](int y0, int y1) {
        for (int y = y0; y < y1; ++y)
          for (int c = 0; c < out.channels; ++c)
            divide_row(color.row(y, c), emission ? emission.row(y, c) : nullptr, albedo.row(y, c), out.width, out.row(y, c));
      });
    }
  }

 private:
  QUELL_PLAIN_LOOP void divide_row(const float* color, const float* emission, const float* albedo, int width,
                                   float* __restrict out) const {
    if (emission)
      for (int x = 0; x < width; ++x) out[x] = (color[x] - emission[x]) / std::max(albedo[x], floor_);
    else
      for (int x = 0; x < width; ++x) out[x] = color[x] / std::max(albedo[x], floor_);
  }

  float floor_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Demodulate, quell::Params)
