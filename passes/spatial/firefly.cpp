// Clamps fireflies: pixels far brighter than what is around them.
// Source:  the mean and standard deviation of the window, for range; bound is that of dtysky's WebGPU path tracer
//          (2021), denoiseSpace.comp.wgsl; rank is that of NVIDIA's NRD, RELAX_AntiFirefly.cs.hlsl.
// Departs: the pixel itself is left out of the window unless told otherwise; rank does not compare materials.
// Cost:    (2 radius + 1)^2 taps of 7 operations, three times that by channels; rank 8 taps of 12.
#include "passes/spatial/firefly_kernel.h"
#include "quell/sdk/pass.h"

namespace {

using namespace quell;
using firefly::Method;

enum class Measure { luminance, channels };

struct Params {
  Method method = Method::bound;
  Measure measure = Measure::luminance;
  int radius = 3;
  double k = 2, floor = 1;
  bool exclude_center = true;
  void describe(auto&& field) {
    field(
        "method", method,
        Choices{{"range", "clamps to mean - k sigma .. mean + k sigma of the window"},
                {"bound", "clamps to at most mean + k sigma, or floor where that is more"},
                {"rank", "what is brighter than its eight neighbors becomes the brightest of them, what is darker the darkest"}},
        "How a firefly is told, and what becomes of it.");
    field(
        "measure", measure,
        Choices{{"luminance", "of luminance; the color is scaled, and keeps its hue"}, {"channels", "of each channel by itself"}},
        "What the window's statistics are of. rank goes by luminance.");
    field("radius", radius, Range<int>{1, firefly::kMaxRadius}, "px",
          "The window is 2 radius + 1 pixels wide and high. Not of rank.");
    field("k", k, Range<double>{0, 1e3}, "1", "How many standard deviations are tolerated.");
    field("floor", floor, Range<double>{0, 1e6}, "radiance", "What is darker is no firefly. Of bound only.");
    field("exclude_center", exclude_center,
          "Leaves the pixel itself out of the window. One that is not raises mean and deviation: alone among n - 1 equal ones it"
          " lies (n - 1) / sqrt(n) deviations above the mean, and is let through from k = 6.9 on for 7 x 7 pixels, while with"
          " k = 2 a third of it remains.");
  }
};

const PassInfo kInfo{
    .id = "firefly",
    .summary = "Clamps pixels that are far brighter than what is around them",
    .doc =
        "mean and sigma are those of the window: sigma^2 = sum (v - mean)^2 / (n - 1) over its n taps. Taps outside the image are"
        " left out. With luminance a color is multiplied by limit / luminance; what has a luminance of 0 or less stays as it is."
        " rank replaces a color by that of a neighbor, the first in reading order where several are as bright. A pixel with"
        " fewer than two taps (one, for rank) stays as it is, and what is not clamped is not changed by a bit. Colors are finite"
        " and below 1e18.\n\n"
        "Clamping loses energy: what is clamped is darker than the mean over many frames would be. Fireflies that stand close"
        " together hide each other.",
    .source =
        "dtysky, WebGPU path tracer (2021), denoiseSpace.comp.wgsl: 7 x 7 pixels, max(mean + 2 sigma, 1), the pixel included, for"
        " bound; NVIDIA Real-Time Denoisers (NRD), RELAX_AntiFirefly.cs.hlsl (rank-conditioned rank selection) for rank. Departs:"
        " luminance is that of BT.709; rank does not compare materials.",
    .inputs = {{"color", kColor, "radiance with fireflies"}},
    .outputs = {{"color", kColor, "radiance without"}, {"mask", kMask, "1 where it was clamped"}},
};

class Firefly final : public Pass {
 public:
  explicit Firefly(const Params& p)
      : settings_{.method = p.method,
                  .by_channel = p.measure == Measure::channels,
                  .radius = p.method == Method::rank ? 1 : p.radius,
                  .k = static_cast<float>(p.k),
                  .floor = static_cast<float>(p.floor),
                  .exclude_center = p.exclude_center} {}

  void infer(Inference& inference) const override {
    inference.set_radius("color", settings_.radius);
    inference.set_slot_scratch(firefly::scratch_bytes(inference.size("color").width, settings_.radius));
  }

  void run(const Frame& frame) const override {
    const FloatImage in = frame.image("color");
    const FloatOutput color = frame.output("color"), mask = frame.output("mask");
    frame.parallel_rows(
        color.height,
        [&](int y0, int y1, std::uint32_t slot) {
          firefly::clamp_rows(in, settings_, y0, y1, color, mask, static_cast<float*>(frame.slot_scratch(slot)));
        },
        kRowsPerChunk);
  }

 private:
  static constexpr int kRowsPerChunk = 32;  // of which each band copies 2 radius rows more
  firefly::Settings settings_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Firefly, Params)
