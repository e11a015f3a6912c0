// Puts the texture back on filtered light: the inverse of demodulate.
//
// Source:  Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, section 4: the filtered illumination times
// albedo.
//
// Departs: several kinds of light are added up, and emission is put back.
//
// Cost:    a multiply-add for each light and channel; bound by memory.
#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include "quell/sdk/pass.h"
#include "quell/sdk/plain_loop.h"

namespace quell {
namespace {

struct Params {
  double floor = 1e-3;
  void describe(auto&& field) {
    field("floor", floor, Range<double>{0, 1}, "1",
          "Smallest albedo that is multiplied by: that of demodulate to be its inverse; 0 as in Falcor's SVGFPass, where what "
          "has no "
          "albedo reflects nothing.");
  }
};

const PassInfo kInfo{
    .id = "modulate",
    .summary = "Multiplies light by albedo and adds emission: the inverse of demodulate",
    .doc =
        "color = sum over i of color[i] max(albedo[i], floor), plus emission where given, for each channel by itself. Several "
        "lights have an albedo each, or share one. A light that is absent in a frame adds nothing.",
    .source =
        "Schied et al., \"Spatiotemporal Variance-Guided Filtering\", HPG 2017, section 4. Departs: emission, and the floor, "
        "which "
        "Falcor's SVGFPass has in the division alone.",
    .inputs = {{.name = "color", .types = kColor, .doc = "light on the surface", .array = true},
               {.name = "albedo", .types = kAlbedo, .doc = "reflectance; one for each light, or one for all", .array = true},
               {"emission", kColor, "radiance that the surface emits", true}},
    .outputs = {{"color", kColor, "radiance"}},
};

class Modulate final : public Pass {
 public:
  explicit Modulate(const Params& params) : floor_(static_cast<float>(params.floor)) {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    if (inference.count("albedo") != 1 && inference.count("albedo") != inference.count("color"))
      throw std::runtime_error("there must be one albedo, or as many as there are colors");
  }

  void run(const Frame& frame) const override {
    const FloatOutput out = frame.output("color");
    const FloatImage emission = frame.image("emission");
    const bool shared = frame.count("albedo") == 1;
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y)
        for (int c = 0; c < out.channels; ++c) {
          float* to = out.row(y, c);
          if (emission)
            std::copy_n(emission.row(y, c), out.width, to);
          else
            std::fill_n(to, out.width, 0.0F);
          for (std::size_t i = 0; i < frame.count("color"); ++i)
            if (const FloatImage light = frame.image("color", i))
              add_row(light.row(y, c), frame.image("albedo", shared ? 0 : i).row(y, c), out.width, to);
        }
    });
  }

 private:
  QUELL_PLAIN_LOOP void add_row(const float* light, const float* albedo, int width, float* __restrict out) const {
    for (int x = 0; x < width; ++x) out[x] += light[x] * std::max(albedo[x], floor_);
  }

  float floor_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Modulate, quell::Params)
