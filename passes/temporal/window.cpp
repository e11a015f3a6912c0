// The mean over frames before and after, where they look alike: a filter over time for offline work.
// Source:  non-local means (Buades et al., CVPR 2005) along motion instead of around the pixel, with the difference of patches
//          judged by its variance, as in Rousselle et al., "Adaptive Rendering with Non-Local Means Filtering", SIGGRAPH Asia
//          2012.
// Departs: the difference of the patches' means, not the mean of their differences, is what is judged: noise averages out of it.
// Cost:    (2 radius + 1)^2 taps of some 15 operations a frame.
#include "passes/temporal/window_kernel.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>

#include "quell/sdk/pass.h"

namespace {

using namespace quell;
using window::Aligned;

struct Params {
  int radius = 1;
  double k = 2;
  void describe(auto&& field) {
    field("radius", radius, Range<int>{0, 16}, "px", "Frames are compared over (2 radius + 1)^2 pixels.");
    field("k", k, Range<double>{1e-3, 1e6}, "standard deviations", "Tolerated difference of the compared means.");
  }
};

const PassInfo kInfo{
    .id = "window",
    .summary = "Mean over frames before and after, where they look alike",
    .doc =
        "color = (c + sum over i of w_i c_i) / (1 + sum over i of w_i), over the other frames i that are present, with w_i = "
        "exp(-d^2 / (2 k^2 v)) where the frame is valid, else 0. Over those pixels of the window where the frame is valid, d "
        "is the sum of the differences of luminance, l_i - l, and v that of the variances, V_i + V, which is the variance of "
        "d when nothing but noise differs. Without a variance w_i is 1 where valid. A frame without a variance of its own "
        "has that of the frame in the middle. Pixels outside the image do not count.\n\n"
        "`variance` is that of the result, (V + sum of w_i^2 V_i) / (1 + sum of w_i)^2, 0 without one; `length` how many "
        "frames the mean is worth, (1 + sum of w_i)^2 / (1 + sum of w_i^2).\n\n"
        "The other frames stand at this frame's pixels. Each comes from a reproject of its own: its history are the graph's "
        "inputs with a delay, a negative one for a frame ahead, and initial none, so that a frame that is not there is "
        "nowhere valid; its motion is that from here to there, which back_project finds with the camera of that delay as "
        "previous_camera. Light is divided by albedo after that, both from there. `valid` goes to the same place of the list "
        "here.",
    .source =
        "Buades et al., \"A Non-Local Algorithm for Image Denoising\", CVPR 2005, along motion. The variance of the "
        "difference: Rousselle et al., \"Adaptive Rendering with Non-Local Means Filtering\", SIGGRAPH Asia 2012. Departs: "
        "means of patches are compared, and their difference, not its square, is what the variance is taken of.",
    .inputs =
        {{"color", kColor, "the frame in the middle"},
         {"variance", kVariance, "of its luminance", true},
         {.name = "frames", .types = kColor, .doc = "other frames, at this frame's pixels", .optional = true, .array = true},
         {.name = "valid",
          .types = kMask,
          .doc = "where each of them can be used, in their order; without any, everywhere",
          .optional = true,
          .array = true},
         {.name = "variances",
          .types = kVariance,
          .doc = "of the luminance of each of them, in their order",
          .optional = true,
          .array = true}},
    .outputs = {{"color", kColor, "the mean"},
                {"variance", kVariance, "of its luminance"},
                {"length", kScalar, "how many frames it is worth"}},
};

constexpr double kLog2E = 1.4426950408889634;

class Window final : public Pass {
 public:
  explicit Window(const Params& p) : settings_{p.radius, static_cast<float>(kLog2E / (2 * p.k * p.k))} {}

  void infer(Inference& inference) const override {
    const std::size_t frames = inference.count("frames");
    for (const char* input : {"valid", "variances"})
      if (inference.count(input) != 0 && inference.count(input) != frames)
        throw std::runtime_error(std::string("there must be as many '") + input + "' as there are 'frames', or none");
    if (inference.present("variance"))
      for (const char* input : {"color", "variance", "frames", "valid", "variances"})
        inference.set_radius(input, settings_.radius);
    inference.set_slot_scratch(frames * sizeof(Aligned));
  }

  void run(const Frame& frame) const override {
    const Aligned middle{frame.image("color"), {}, frame.image("variance")};
    const window::Outputs out{frame.output("color"), frame.output("variance"), frame.output("length")};
    frame.parallel_rows(out.color.height, [&](int y0, int y1, std::uint32_t slot) {
      const std::span<const Aligned> frames = collect(frame, static_cast<Aligned*>(frame.slot_scratch(slot)));
      for (int y = y0; y < y1; ++y) window::average_row(middle, frames, settings_, y, out);
    });
  }

 private:
  static std::span<const Aligned> collect(const Frame& frame, Aligned* frames) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < frame.count("frames"); ++i)
      if (const FloatImage color = frame.image("frames", i))
        std::construct_at(frames + count++, Aligned{color, frame.image("valid", i), frame.image("variances", i)});
    return {frames, count};
  }

  window::Settings settings_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Window, Params)
