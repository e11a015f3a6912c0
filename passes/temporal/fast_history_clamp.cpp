// Limits a slow history to what a fast one makes plausible: little noise, and little lag.
// Source:  RELAX of NVIDIA's NRD, history clamping: mean +- k deviations of 5 x 5 pixels of the fast history, in YCoCg, and the
//          pixel itself.
// Departs: NRD writes the fast history over the slow one where it is younger than the history fix wants; here it is left alone.
// Cost:    (2 radius + 1)^2 taps of some 25 operations.
#include "passes/temporal/fast_history_clamp_kernel.h"
#include "quell/sdk/pass.h"

namespace {

using namespace quell;
using fast_history_clamp::Space;

struct Params {
  int radius = 2;
  double k = 2;
  Space space = Space::ycocg;
  bool include_center = true;
  double min_length = 4;
  void describe(auto&& field) {
    field("radius", radius, Range<int>{0, 16}, "px", "The window has (2 radius + 1)^2 pixels.");
    field("k", k, Range<double>{0, 1e6}, "standard deviations", "Tolerated distance from the window's mean.");
    field("space", space,
          Choices{{"ycocg", "luma and two differences of color, which limit hue and brightness apart"},
                  {"rgb", "red, green and blue"}},
          "In which components of color the history is limited, each by itself.");
    field("include_center", include_center, "Widens the limits to the fast history's own pixel, so that it passes as it is.");
    field("min_length", min_length, Range<double>{0, 1e6}, "frames",
          "Histories shorter than this are left as they are: the fast one is no better then.");
  }
};

const PassInfo kInfo{
    .id = "fast_history_clamp",
    .summary = "Limits a slow history to what a fast one makes plausible",
    .doc =
        "color becomes min(max(color, mu - k sigma), mu + k sigma), in each component, with the mean mu and the population's "
        "standard deviation sigma of the fast history in the window. Both are averages over time of one signal, at this "
        "frame's pixels, the fast one of fewer frames (alpha 1 / 6, say, against 1 / 30): where the light changes the fast "
        "one is there first, and takes the slow one along.\n\n"
        "Pixels outside the image and without surface (depth 1e10) do not count. Pixels without surface, histories shorter "
        "than min_length, and colors within the limits stay as they are, bit for bit. `clamped` is how far the luma Y = (R + "
        "2 G + B) / 4 went from slow to fast, 0 to 1: what else belongs to the history can be mixed by it.",
    .source =
        "NVIDIA Real-Time Denoisers (NRD) 4.17, RELAX, history clamping: 5 x 5, 2 sigma, 30 and 6 frames. The window's mean "
        "and deviation: Salvi, \"An Excursion in Temporal Supersampling\", GDC 2016. Departs: young histories are left "
        "alone; at the border NRD repeats pixels.",
    .inputs = {{"color", kColor, "the slow history"},
               {"fast", kColor, "the fast history"},
               {"length", kScalar, "how many frames the history reaches back", true},
               {"depth", kDepth, "tells pixels without surface", true}},
    .outputs = {{"color", kColor, "the slow history, limited"}, {"clamped", kScalar, "0 to 1: how far it went to the fast one"}},
};

class FastHistoryClamp final : public Pass {
 public:
  explicit FastHistoryClamp(const Params& p)
      : settings_{.radius = p.radius,
                  .k = static_cast<float>(p.k),
                  .space = p.space,
                  .include_center = p.include_center,
                  .min_length = static_cast<float>(p.min_length)} {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    for (const char* input : {"fast", "depth"}) inference.set_radius(input, settings_.radius);
    inference.set_in_place("color", "color");
  }

  void run(const Frame& frame) const override {
    const fast_history_clamp::Images in{frame.image("color"), frame.image("fast"), frame.image("length"), frame.image("depth")};
    const FloatOutput color = frame.output("color"), clamped = frame.output("clamped");
    frame.parallel_rows(color.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) fast_history_clamp::clamp_row(in, settings_, y, color, clamped);
    });
  }

 private:
  fast_history_clamp::Settings settings_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, FastHistoryClamp, Params)
