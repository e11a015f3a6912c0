// Smooths variance by 3 x 3 pixels, so that one wrong estimate does not let a firefly stand.
//
// Source:  Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, section 4.4, equation 5: the Gaussian g3x3.
//
// Cost:    12 operations a pixel; bound by memory.
#include <algorithm>

#include "quell/sdk/pass.h"
#include "quell/sdk/plain_loop.h"

namespace quell {
namespace {

enum class Border { renormalize, zero };

struct Params {
  Border border = Border::renormalize;
  void describe(auto&& field) {
    field("border", border,
          Choices{{"renormalize", "pixels outside the image are left out, and the others weigh more"},
                  {"zero", "pixels outside the image are 0: Falcor's SVGFPass"}},
          "What becomes of the weights at the border.");
  }
};

const PassInfo kInfo{.id = "variance_blur",
                     .summary = "Smooths variance by a Gaussian of 3 x 3 pixels",
                     .doc = "The weights are 1/4, 1/2, 1/4 in x, times the same in y.",
                     .source = "Schied et al., \"Spatiotemporal Variance-Guided Filtering\", HPG 2017, equation 5.",
                     .inputs = {{"variance", kVariance, "what is smoothed"}},
                     .outputs = {{"variance", kVariance, "smoothed variance"}}};

class VarianceBlur final : public Pass {
 public:
  explicit VarianceBlur(const Params& params) : renormalizes_(params.border == Border::renormalize) {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    inference.set_radius("variance", 1);
    inference.set_slot_scratch((static_cast<std::size_t>(inference.size("variance").width) + 2) * sizeof(float));
  }

  void run(const Frame& frame) const override {
    const FloatImage in = frame.image("variance");
    const FloatOutput out = frame.output("variance");
    frame.parallel_rows(out.height, [&](int y0, int y1, std::uint32_t slot) {
      for (int y = y0; y < y1; ++y) blur_row(in, y, static_cast<float*>(frame.slot_scratch(slot)) + 1, out.row(y));
    });
  }

 private:
  // `columns` has a pixel more on both sides.
  QUELL_PLAIN_LOOP void blur_row(const FloatImage& in, int y, float* __restrict columns, float* __restrict out) const {
    const int width = in.width;
    const bool has_above = y > 0, has_below = y + 1 < in.height;
    // A row that is not there is read as the row itself, with weight 0.
    const float *row = in.row(y), *above = in.row(has_above ? y - 1 : y), *below = in.row(has_below ? y + 1 : y);
    const float w_above = has_above ? 0.25F : 0.0F, w_below = has_below ? 0.25F : 0.0F;
    const float scale = renormalizes_ ? 1 / (0.5F + w_above + w_below) : 1;
    const float a = scale * w_above, b = scale * 0.5F, c = scale * w_below;
    for (int x = 0; x < width; ++x) columns[x] = a * above[x] + b * row[x] + c * below[x];
    columns[-1] = columns[width] = 0;
    for (int x = 0; x < width; ++x) out[x] = 0.25F * columns[x - 1] + 0.5F * columns[x] + 0.25F * columns[x + 1];
    if (!renormalizes_) return;
    const float side = width > 1 ? 4.0F / 3 : 2;  // 1 over the weights that are left
    out[0] *= side;
    if (width > 1) out[width - 1] *= side;
  }

  bool renormalizes_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::VarianceBlur, quell::Params)
