// Mean luminance and mean square of it over time, from which variance follows, and how many frames they reach back.
//
// Source:  Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, section 4.2: moments are integrated as the color
// is.
//
// Departs: young histories are plain means (alpha is at least 1 / length), as in Falcor's SVGFPass, which counts to 32.
//
// Cost:    a division and some ten multiplications a pixel; bound by memory.
#include <algorithm>
#include <cmath>

#include "quell/sdk/pass.h"
#include "quell/sdk/plain_loop.h"

namespace quell {
namespace {

struct Params {
  double alpha = 0.2, max_length = 32;
  bool warm_up = true;
  void describe(auto&& field) {
    field("alpha", alpha, Range<double>{0, 1}, "", "Smallest share of the new frame.");
    field("max_length", max_length, Range<double>{1, 1e6}, "frames", "The history's length is counted up to this.");
    field("warm_up", warm_up,
          "Gives the new frame 1 / length while that is more than alpha, so that a young history is a plain mean; otherwise "
          "alpha as "
          "soon as there is a history.");
  }
};

const PassInfo kInfo{
    .id = "moments",
    .summary = "First and second moment of luminance over time, and the length of the history",
    .doc =
        "length = min(max_length, length of the history + 1) and moments = a (l, l^2) + (1 - a) history, with the luminance l of "
        "the "
        "color and a = max(alpha, 1 / length). Where the history is absent or not valid, length is 1 and the moments are those "
        "of "
        "the frame. A history without a length counts as one of max_length frames. Variance is the second moment minus the "
        "square "
        "of the first.",
    .source =
        "Schied et al., \"Spatiotemporal Variance-Guided Filtering\", HPG 2017, section 4.2, with alpha 0.2. Departs: warm_up "
        "and "
        "max_length are those of Falcor's SVGFPass.",
    .inputs = {{"color", kColor, "the new frame"},
               {"history", kMoments, "the moments so far, at this frame's pixels", true},
               {"length", kScalar, "how many frames the history reaches back, at this frame's pixels", true},
               {"valid", kMask, "where the history can be used; without it, everywhere", true}},
    .outputs = {{"moments", kMoments, "the new moments"}, {"length", kScalar, "frames that they reach back"}},
};

class Moments final : public Pass {
 public:
  explicit Moments(const Params& params)
      : alpha_(static_cast<float>(params.alpha)),
        max_length_(static_cast<float>(params.max_length)),
        warm_up_(params.warm_up ? 1.0F : 0.0F) {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    const double least = std::max(alpha_, warm_up_ / max_length_);  // share of the new frame
    inference.set_fading(1 - least, inference.present("length") ? static_cast<int>(std::ceil(max_length_)) : 0);
  }

  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color"), history = frame.image("history"), length = frame.image("length"),
                     valid = frame.image("valid");
    const FloatOutput moments = frame.output("moments"), new_length = frame.output("length");
    frame.parallel_rows(moments.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) {
        const Row row{color.row(y, 0),
                      color.row(y, 1),
                      color.row(y, 2),
                      history ? history.row(y, 0) : nullptr,
                      history ? history.row(y, 1) : nullptr,
                      length ? length.row(y) : nullptr,
                      valid ? valid.row(y) : nullptr};
        integrate_row(row, moments.width, moments.row(y, 0), moments.row(y, 1), new_length.row(y));
      }
    });
  }

 private:
  struct Row {
    const float *red, *green, *blue, *first, *second, *length, *valid;
  };

  QUELL_PLAIN_LOOP void integrate_row(const Row& in, int width, float* __restrict first, float* __restrict second,
                                      float* __restrict length) const {
    for (int x = 0; x < width; ++x) {
      const float l = 0.2126F * in.red[x] + 0.7152F * in.green[x] + 0.0722F * in.blue[x];
      first[x] = l, second[x] = l * l, length[x] = 1;
    }
    if (!in.first) return;
    for (int x = 0; x < width; ++x) {
      const bool is_valid = !in.valid || in.valid[x] > 0.5F;
      const float n = in.length ? std::min(max_length_, in.length[x] + 1) : max_length_;
      const float a = std::max(alpha_, warm_up_ / n);
      const float mean = a * first[x] + (1 - a) * in.first[x], square = a * second[x] + (1 - a) * in.second[x];
      // Chosen, not multiplied by 0: what is not valid need not be finite.
      first[x] = is_valid ? mean : first[x];
      second[x] = is_valid ? square : second[x];
      length[x] = is_valid ? n : 1;
    }
  }

  float alpha_, max_length_, warm_up_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Moments, quell::Params)
