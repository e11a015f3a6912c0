// Gaussian blur.
// Source:  the normal distribution, sampled at pixel centers; separable, so that two sums over 2 radius + 1 taps are exactly the
//          sum over the square.
// Cost:    2 (2 radius + 1) multiply-adds a channel.
#include <cmath>

#include "passes/spatial/gaussian_kernel.h"
#include "quell/sdk/pass.h"

namespace {

using namespace quell;

struct Params {
  double sigma = 2;
  int radius = -1;
  void describe(auto&& field) {
    field("sigma", sigma, Range<double>{1e-2, 64}, "px", "Standard deviation.");
    field("radius", radius, Range<int>{-1, 192}, "px",
          "The window is 2 radius + 1 pixels wide and high; -1: 3 sigma, rounded up.");
  }
};

const PassInfo kInfo{
    .id = "gaussian",
    .summary = "Gaussian blur",
    .doc =
        "image = sum w image' / sum w over the window, with w = exp(-d^2 / 2 sigma^2) of the distance d in pixels, in each plane"
        " by itself. Taps outside the image are left out: a constant stays constant up to the border. A window of 3 sigma leaves"
        " out 0.3 % of the weight in each direction.",
    .source = "the normal distribution, sampled at pixel centers and cut off at the radius",
    .inputs = {{"image", kColor | kAlbedo | kMotion | kMoments | kVariance | kScalar | kAlpha, "what is blurred"}},
    .outputs = {{.name = "image", .doc = "the same, blurred", .same_as = "image"}},
};

gaussian::Settings make_settings(const Params& p) {
  const int radius = p.radius >= 0 ? p.radius : static_cast<int>(std::ceil(3 * p.sigma));
  const auto weight = [&](int i) { return std::exp(-i * i / (2 * p.sigma * p.sigma)); };
  double total = weight(0);
  for (int i = 1; i <= radius; ++i) total += 2 * weight(i);
  gaussian::Settings s;
  double sum = 0;
  for (int i = 0; i <= radius; ++i) {
    sum += weight(i) / total;
    s.weights.push_back(static_cast<float>(weight(i) / total));
    s.sums.push_back(static_cast<float>(sum));
  }
  return s;
}

class Gaussian final : public Pass {
 public:
  explicit Gaussian(const Params& params) : settings_(make_settings(params)) {}

  void infer(Inference& inference) const override {
    inference.set_radius("image", settings_.radius());
    inference.set_slot_scratch(gaussian::scratch_bytes(inference.size("image").width, settings_.radius()));
  }

  void run(const Frame& frame) const override {
    const FloatImage in = frame.image("image");
    const FloatOutput out = frame.output("image");
    frame.parallel_rows(out.height, [&](int y0, int y1, std::uint32_t slot) {
      for (int c = 0; c < out.channels; ++c)
        for (int y = y0; y < y1; ++y) gaussian::blur_row(in, settings_, y, c, static_cast<float*>(frame.slot_scratch(slot)), out);
    });
  }

 private:
  gaussian::Settings settings_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Gaussian, Params)
