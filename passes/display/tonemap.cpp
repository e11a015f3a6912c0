// Scene-linear radiance to display-linear light in [0, 1].
// Source:  Reinhard et al., "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, equations 3 and 4;
//          Narkowicz, "ACES Filmic Tone Mapping Curve", 2016; OpenColorIO 2 for displays and views.
// Departs: Reinhard's curve is applied to each channel, not to luminance: nothing leaves [0, 1], and bright colors pale.
// Cost:    a division or an exponential a channel; OpenColorIO by its view, plus a power a channel.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "passes/display/tonemap_ocio.h"
#include "quell/sdk/pass.h"

namespace quell {
namespace {

enum class Operator { linear, reinhard, exponential, aces, ocio };

struct Params {
  Operator curve = Operator::linear;
  double exposure = 0;
  double white = 0;
  std::filesystem::path ocio_config;
  std::string ocio_colorspace, ocio_display, ocio_view;
  void describe(auto&& field) {
    field("operator", curve,
          Choices{{"linear", "x, clipped"},
                  {"reinhard", "x / (1 + x), or x (1 + x / white^2) / (1 + x) when white is set"},
                  {"exponential", "1 - exp(-x)"},
                  {"aces", "Narkowicz's fit to ACES: x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14)"},
                  {"ocio", "a display and view of OpenColorIO: of ocio_config, or its built-in ACES output transforms"}},
          "The curve.");
    field("exposure", exposure, Range<double>{-64, 64}, "stops", "Radiance is multiplied by 2^exposure first.");
    field("white", white, Range<double>{0, 1e6}, "radiance", "For reinhard: what becomes 1; 0 is no limit.");
    field("ocio_config", ocio_config, "For ocio: a configuration file; empty takes OpenColorIO's built-in ACES transforms.");
    field("ocio_colorspace", ocio_colorspace,
          "For ocio with a config: color space or role of the input; empty is the role scene_linear. Without one the input is "
          "linear "
          "Rec.709.");
    field("ocio_display", ocio_display,
          "For ocio: a display of the config, empty being its default. Without a config a built-in display, such as sRGB (when "
          "empty), "
          "REC.1886-REC.709 or G2.6-P3-D65.");
    field("ocio_view", ocio_view,
          "For ocio: a view of the display, empty being its default. Without a config a built-in ACES output, such as "
          "SDR-VIDEO_1.0 "
          "(when empty) or SDR-CINEMA_1.0.");
  }
};

const PassInfo kInfo{
    .id = "tonemap",
    .summary = "Scene-linear radiance to display-linear light",
    .doc =
        "Scales by the exposure, applies a curve to each channel, and clips to [0, 1]; what is no number becomes 0. The "
        "result is linear light: encoded with the sRGB curve, as 8-bit pictures are written, it is what the display "
        "shows.\n\n"
        "OpenColorIO's displays give code values. They are decoded with the inverse sRGB curve, so that a picture written "
        "from the result has exactly the display's code values.",
    .source =
        "Reinhard et al., SIGGRAPH 2002, equations 3 and 4 (on each channel). Narkowicz, \"ACES Filmic Tone Mapping Curve\", "
        "2016, https://knarkowicz.wordpress.com/2016/01/06/aces-filmic-tone-mapping-curve/. OpenColorIO 2, opencolorio.org. "
        "sRGB: IEC 61966-2-1.",
    .inputs = {{"color", kColor, "scene-linear radiance; Rec.709 primaries unless an OpenColorIO config says otherwise"}},
    .outputs = {{"color", kColor, "display-linear light, 0 to 1"}},
};

// Beyond it every curve is 1, and its square is still finite.
constexpr float kBrightest = 1e18F;

float clip(float x, float largest) { return x > 0 ? std::min(x, largest) : 0.0F; }  // NaN becomes 0

// Output and input may be the same row: __restrict would deny that, ivdep promises only that no pixel depends on another.
template <class Curve>
void map_row(const float* in, float* out, int width, const Curve& curve) {
#pragma GCC ivdep
  for (int x = 0; x < width; ++x) out[x] = curve(in[x]);
}

float reinhard(float x, float inverse_white_squared) { return x * (1 + x * inverse_white_squared) / (1 + x); }

float aces(float x) { return x * (2.51F * x + 0.03F) / (x * (2.43F * x + 0.59F) + 0.14F); }

// IEC 61966-2-1, code value to light.
float decode_srgb(float code) { return code <= 0.04045F ? code / 12.92F : std::pow((code + 0.055F) / 1.055F, 2.4F); }

class TonemapPass final : public Pass {
 public:
  explicit TonemapPass(const Params& p)
      : curve_(p.curve),
        gain_(static_cast<float>(std::exp2(p.exposure))),
        inverse_white_squared_(p.white > 0 ? static_cast<float>(1 / (p.white * p.white)) : 0.0F) {
    if (curve_ == Operator::ocio)
      view_ =
          std::make_unique<OcioView>(OcioView::Choice{p.ocio_config.string(), p.ocio_colorspace, p.ocio_display, p.ocio_view});
  }

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    inference.set_in_place("color", "color");
  }

  void run(const Frame& frame) const override {
    const FloatImage in = frame.image("color");
    const FloatOutput out = frame.output("color");
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y)
        for (int c = 0; c < out.channels; ++c) map_channel(in.row(y, c), out.row(y, c), out.width);
      if (view_) apply_view(out, y0, y1);
    });
  }

 private:
  void map_channel(const float* in, float* out, int width) const {
    const float gain = gain_, inverse = inverse_white_squared_;
    switch (curve_) {
      case Operator::linear:
        return map_row(in, out, width, [=](float x) { return clip(gain * x, 1); });
      case Operator::reinhard:
        return map_row(in, out, width, [=](float x) { return clip(reinhard(clip(gain * x, kBrightest), inverse), 1); });
      case Operator::exponential:
        return map_row(in, out, width, [=](float x) { return -std::expm1(-clip(gain * x, kBrightest)); });
      case Operator::aces:
        return map_row(in, out, width, [=](float x) { return clip(aces(clip(gain * x, kBrightest)), 1); });
      case Operator::ocio:
        return map_row(in, out, width, [=](float x) { return gain * x; });  // the view does the rest
    }
  }

  void apply_view(const FloatOutput& out, int y0, int y1) const {
    view_->apply(out, y0, y1);
    for (int y = y0; y < y1; ++y)
      for (int c = 0; c < out.channels; ++c)
        map_row(out.row(y, c), out.row(y, c), out.width, [](float code) { return clip(decode_srgb(clip(code, 1)), 1); });
  }

  Operator curve_;
  float gain_;
  float inverse_white_squared_;
  std::unique_ptr<const OcioView> view_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::TonemapPass, quell::Params)
