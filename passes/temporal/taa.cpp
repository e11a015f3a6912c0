// Temporal anti-aliasing: the history, limited to the colors around the pixel, and the new frame, weighted against flicker.
// Source:  Karis, "High-Quality Temporal Supersampling", SIGGRAPH 2014 course: box of the 3 x 3 neighbors in YCoCg, the history
//          clipped to it, weights 1 / (1 + luma). Pedersen, "Temporal Reprojection Anti-Aliasing in INSIDE", GDC 2016: the box
//          rounded by that of the cross, and clipped toward its center. Box by variance: Salvi, GDC 2016.
// Departs: the new frame is taken as it is, without the course's reconstruction filter; there is no adaptive alpha.
// Cost:    9 taps of some 20 operations.
#include "passes/temporal/taa_kernel.h"

#include <algorithm>

#include "quell/sdk/pass.h"

namespace {

using namespace quell;
using taa::Box;
using taa::Limit;

struct Params {
  double alpha = 0.1;
  Box box = Box::rounded;
  Limit limit = Limit::clip;
  double k = 1;
  bool weigh = true;
  void describe(auto&& field) {
    field("alpha", alpha, Range<double>{0, 1}, "", "Share of the new frame, before weights; 1 ignores the history.");
    field("box", box,
          Choices{{"range", "from the smallest to the largest value of the 3 x 3 pixels"},
                  {"rounded", "the mean of that and of the same of the cross of five pixels: corners count less"},
                  {"variance", "mean +- k standard deviations of the 3 x 3 pixels"}},
          "Which colors are plausible, in each component of YCoCg.");
    field("limit", limit,
          Choices{{"clip", "to where the way from the history to the center of the box enters the box: keeps the hue"},
                  {"clamp", "each component by itself: to the nearest point of the box"},
                  {"none", "the history as it is"}},
          "What becomes of a history outside the box.");
    field("k", k, Range<double>{0, 1e6}, "standard deviations", "Half the side of a box by variance.");
    field("weigh", weigh, "Weighs both colors by 1 / (1 + luma), so that single bright samples do not flicker.");
  }
};

const PassInfo kInfo{
    .id = "taa",
    .summary = "Temporal anti-aliasing: clips the history to the neighborhood's colors, and blends",
    .doc =
        "color = (alpha w(c) c + (1 - alpha) w(h) h) / (alpha w(c) + (1 - alpha) w(h)), with the new frame c, the history h "
        "after limiting, and w = 1 / (1 + max(Y, 0)), or 1. Y = (R + 2 G + B) / 4, Co = (R - B) / 2, Cg = (2 G - R - B) / 4. "
        "Neighbors outside the image do not count. Where the history is absent or not valid, the new color stands alone.\n\n"
        "The frames should be jittered, and be what is shown or something close to it: denoised, with albedo. The history is "
        "the result of the frame before, at this frame's pixels, best fetched by catmull_rom.",
    .source =
        "Karis, \"High-Quality Temporal Supersampling\", SIGGRAPH 2014, Advances in Real-Time Rendering course. Rounded, and "
        "clipped toward the center: Pedersen, \"Temporal Reprojection Anti-Aliasing in INSIDE\", GDC 2016. Variance: Salvi, "
        "\"An Excursion in Temporal Supersampling\", GDC 2016. Departs: no reconstruction filter on the new frame, no alpha "
        "that adapts, no search for the longest motion around a pixel.",
    .inputs = {{"color", kColor, "the new frame"},
               {"history", kColor, "the result so far, at this frame's pixels", true},
               {"valid", kMask, "where the history can be used; without it, everywhere", true}},
    .outputs = {{"color", kColor, "the result"}},
};

class Taa final : public Pass {
 public:
  explicit Taa(const Params& p)
      : settings_{.alpha = static_cast<float>(p.alpha),
                  .box = p.box,
                  .limit = p.limit,
                  .k = static_cast<float>(p.k),
                  .weigh = p.weigh} {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    if (!settings_.weigh) inference.set_fading(1 - settings_.alpha);  // weights may leave all of a dark history
    if (!inference.present("history")) return inference.set_in_place("color", "color");
    inference.set_in_place("color", "history");
    if (settings_.limit != Limit::none) inference.set_radius("color", 1);
  }

  void run(const Frame& frame) const override {
    const taa::Images in{frame.image("color"), frame.image("history"), frame.image("valid")};
    const FloatOutput color = frame.output("color");
    frame.parallel_rows(color.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) {
        if (in.history)
          taa::blend_row(in, settings_, y, color);
        else
          take_row(in.color, y, color);
      }
    });
  }

 private:
  static void take_row(const FloatImage& from, int y, const FloatOutput& to) {
    for (int c = 0; c < to.channels; ++c)
      if (to.row(y, c) != from.row(y, c)) std::copy_n(from.row(y, c), to.width, to.row(y, c));
  }

  taa::Settings settings_;
};

}  // namespace

QUELL_REGISTER_PASS(kInfo, Taa, Params)
