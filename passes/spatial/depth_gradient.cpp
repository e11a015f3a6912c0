// How fast depth changes from a pixel to the next: what a filter must tolerate on a slope.
//
// Source:  Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017, equation 3; the larger of both axes is what
// Falcor's
//          SVGFPass goes by.
//
// Departs: Falcor takes differences within 2 x 2 pixels, which straddle edges; here it is the smaller of the two one-sided ones.
//
// Cost:    four differences a pixel; bound by memory.
#include <algorithm>
#include <cmath>

#include "quell/sdk/pass.h"
#include "quell/sdk/plain_loop.h"

namespace quell {
namespace {

enum class Differences { smaller, central, quad };

struct Params {
  Differences differences = Differences::smaller;
  void describe(auto&& field) {
    field("differences", differences,
          Choices{{"smaller", "the smaller of those to the two neighbors: an edge of the surface does not count"},
                  {"central", "half of that from one neighbor to the other; where one does not count, that to the other"},
                  {"quad",
                   "that within the 2 x 2 pixels, from an even place on, that the pixel lies in: what ddx_fine and ddy_fine of a "
                   "GPU give"}},
          "Which differences are taken along each axis.");
  }
};

const PassInfo kInfo{.id = "depth_gradient",
                     .summary = "The larger change of depth from a pixel to its neighbors, in x or y",
                     .doc =
                         "gradient = max(|dz/dx|, |dz/dy|) in world units a pixel. By default it is, along each axis, the "
                         "smaller of the "
                         "differences to the two "
                         "neighbors, so that at an edge the slope of the pixel's own surface counts; neighbors outside the image "
                         "and without surface "
                         "(depth 1e10) are left out. 0 where there is no surface or no neighbor.",
                     .source =
                         "Schied et al., \"Spatiotemporal Variance-Guided Filtering\", HPG 2017, equation 3, in the form of "
                         "Falcor's SVGFPass. Departs: "
                         "one-sided differences instead of those within 2 x 2 pixels, which are a choice (HLSL's "
                         "ddx_fine and ddy_fine).",
                     .inputs = {{"depth", kDepth, "distance along the view axis"}},
                     .outputs = {{"gradient", kScalar, "world units a pixel"}}};

constexpr float kNoSurface = 1e10F;
constexpr float kNone = 1e30F;  // larger than any difference

class DepthGradient final : public Pass {
 public:
  explicit DepthGradient(const Params& params) : differences_(params.differences) {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    inference.set_radius("depth", 1);
  }

  void run(const Frame& frame) const override {
    const FloatImage depth = frame.image("depth");
    const FloatOutput out = frame.output("gradient");
    if (differences_ == Differences::central) return run_each(frame, depth, out, central_gradient);
    if (differences_ == Differences::quad) return run_each(frame, depth, out, quad_gradient);
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) {
        const float *row = depth.row(y), *above = y > 0 ? depth.row(y - 1) : nullptr,
                    *below = y + 1 < depth.height ? depth.row(y + 1) : nullptr;
        gradient_row(row, above, below, depth.width, out.row(y));
      }
    });
  }

 private:
  static float change(float depth, float neighbor) { return neighbor < kNoSurface ? std::abs(neighbor - depth) : kNone; }
  static float gradient(float depth, float x, float y) {
    const float larger = std::max(x < kNone ? x : 0.0F, y < kNone ? y : 0.0F);
    return depth < kNoSurface ? larger : 0.0F;
  }

  QUELL_PLAIN_LOOP static void gradient_row(const float* row, const float* above, const float* below, int width,
                                            float* __restrict out) {
    const auto vertical = [=](int x) {
      return std::min(above ? change(row[x], above[x]) : kNone, below ? change(row[x], below[x]) : kNone);
    };
    if (above && below)
      for (int x = 1; x < width - 1; ++x)
        out[x] = gradient(row[x], std::min(change(row[x], row[x - 1]), change(row[x], row[x + 1])),
                          std::min(change(row[x], above[x]), change(row[x], below[x])));
    else
      for (int x = 1; x < width - 1; ++x)
        out[x] = gradient(row[x], std::min(change(row[x], row[x - 1]), change(row[x], row[x + 1])), vertical(x));
    out[0] = gradient(row[0], width > 1 ? change(row[0], row[1]) : kNone, vertical(0));
    if (width > 1) out[width - 1] = gradient(row[width - 1], change(row[width - 1], row[width - 2]), vertical(width - 1));
  }

  template <class Gradient>
  static void run_each(const Frame& frame, const FloatImage& depth, const FloatOutput& out, const Gradient& gradient_at) {
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y)
        for (int x = 0; x < out.width; ++x) out.at(x, y) = gradient_at(depth, x, y);
    });
  }

  static float depth_at(const FloatImage& depth, int x, int y) { return depth.contains(x, y) ? depth.at(x, y) : kNoSurface; }

  static float central_gradient(const FloatImage& depth, int x, int y) {
    const float z = depth.at(x, y);
    const auto along = [=](float before, float after) {
      if (before < kNoSurface && after < kNoSurface) return std::abs(after - before) / 2;
      return std::min(change(z, before), change(z, after));
    };
    return gradient(z, along(depth_at(depth, x - 1, y), depth_at(depth, x + 1, y)),
                    along(depth_at(depth, x, y - 1), depth_at(depth, x, y + 1)));
  }

  static float quad_gradient(const FloatImage& depth, int x, int y) {
    const float z = depth.at(x, y);
    return gradient(z, change(z, depth_at(depth, x ^ 1, y)), change(z, depth_at(depth, x, y ^ 1)));
  }

  Differences differences_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::DepthGradient, quell::Params)
