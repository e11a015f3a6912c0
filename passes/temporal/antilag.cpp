// Trusts a history less where it differs from what is there now by more than the noise explains.
// Source:  RELAX of NVIDIA's NRD, history reset: the excess of |slow - mean of the new frame| over deviations of the fast history
//          and of the new frame, relative to the brightness.
// Departs: NRD moves the histories toward the new frame by that amount; here it is a confidence, and a shorter length.
// Cost:    (2 radius + 1)^2 taps of some 15 operations.
#include "passes/temporal/antilag_kernel.h"
#include "quell/sdk/pass.h"

namespace {

using namespace quell;

struct Params {
  int radius = 2;
  double sensitivity = 0.25, k_fast = 4.5, k_color = 0.5, max_length = 32;
  void describe(auto&& field) {
    field("radius", radius, Range<int>{0, 16}, "px", "The window has (2 radius + 1)^2 pixels.");
    field("sensitivity", sensitivity, Range<double>{0, 1e6}, "1",
          "How much confidence an excess of the size of the brightness itself takes away; 0 trusts every history.");
    field("k_fast", k_fast, Range<double>{0, 1e6}, "standard deviations",
          "Tolerated difference, over the deviation of the fast history in the window.");
    field("k_color", k_color, Range<double>{0, 1e6}, "standard deviations",
          "Tolerated difference, over the deviation of the new frame in the window; added.");
    field("max_length", max_length, Range<double>{1, 1e6}, "frames", "What a history without a length counts as.");
  }
};

const PassInfo kInfo{
    .id = "antilag",
    .summary = "Trusts a history less where it differs from the present beyond the noise",
    .doc =
        "With the luminance l of the slow history, the mean m of the new frame in the window, the tolerance t = k_fast "
        "sigma(fast) + k_color sigma(color), and populations' standard deviations of luminance in the window: confidence = 1 "
        "- min(1, sensitivity max(0, |l - m| - t) / (max(l, m, 0) + t + 1e-6)). Without the new frame m is the mean of the "
        "fast history, and k_color does not matter. The new length is 1 + confidence (length - 1).\n\n"
        "The tolerances are RELAX's, whose light has been filtered before. Of light with a path or two a pixel the deviation is "
        "as large as the light, and no change exceeds 4.5 of it; but a mean of n pixels errs by 1 / sqrt(n) of it, so that in a "
        "window of 7 x 7 a k_color of 0.5 and hardly any k_fast tell changes from noise, as asvgf_lite has it.\n\n"
        "The confidence is what temporal_blend asks for; the length is what the next frame's average would begin with. All "
        "images are at this frame's pixels. Pixels outside the image and without surface (depth 1e10) do not count, and "
        "pixels without surface have confidence 1.",
    .source =
        "NVIDIA Real-Time Denoisers (NRD) 4.17, RELAX, history clamping, the part that resets: 5 x 5, 4.5 spatial and 0.5 "
        "temporal sigma, and half of an amount of 0.5. Departs: NRD moves both histories toward the new frame by 1 - "
        "confidence, which is what an average by the confidence does; its deviation of the fast history is that of (R + 2 G + "
        "B) / 4, its slow history has had its share of the new frame; the form without the new frame is quell's; at the border "
        "NRD repeats pixels.",
    .inputs = {{"slow", kColor, "the history that may lag behind"},
               {"fast", kColor, "an average of fewer frames"},
               {"color", kColor, "the new frame", true},
               {"length", kScalar, "how many frames the slow history reaches back", true},
               {"depth", kDepth, "tells pixels without surface", true}},
    .outputs = {{"confidence", kScalar, "0 to 1: how far the history is to be trusted"},
                {"length", kScalar, "how many frames it is worth"}},
};

class Antilag final : public Pass {
 public:
  explicit Antilag(const Params& p)
      : settings_{.radius = p.radius,
                  .sensitivity = static_cast<float>(p.sensitivity),
                  .k_fast = static_cast<float>(p.k_fast),
                  .k_color = static_cast<float>(p.k_color),
                  .max_length = static_cast<float>(p.max_length)} {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    for (const char* input : {"fast", "color", "depth"}) inference.set_radius(input, settings_.radius);
    if (inference.present("length")) inference.set_in_place("length", "length");
  }

  void run(const Frame& frame) const override {
    const antilag::Images in{frame.image("slow"), frame.image("fast"), frame.image("color"), frame.image("length"),
                             frame.image("depth")};
    const FloatOutput confidence = frame.output("confidence"), length = frame.output("length");
    frame.parallel_rows(confidence.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) antilag::find_lag(in, settings_, y, confidence, length);
    });
  }

 private:
  antilag::Settings settings_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Antilag, Params)
