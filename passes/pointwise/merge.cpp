// Puts a color together from three planes: the inverse of split.
// Source:  arithmetic; YCoCg of Malvar and Sullivan, JVT-I014r3, 2003.
// Cost:    a copy, or four operations a pixel; bound by memory.
#include <algorithm>

#include "quell/sdk/pass.h"

namespace quell {
namespace {

enum class Space { planes, ycocg };

struct Params {
  Space space = Space::planes;
  void describe(auto&& field) {
    field(
        "space", space,
        Choices{{"planes", "red, green and blue"}, {"ycocg", "Y, Co and Cg: red is Y + Co - Cg, green Y + Cg, blue Y - Co - Cg"}},
        "What the planes are.");
  }
};

constexpr Types kPlane = kScalar | kDepth | kVariance | kMask | kAlpha;

const PassInfo kInfo{
    .id = "merge",
    .summary = "Puts a color together from three planes",
    .doc = "The inverse of split. Planes that are not given, or absent, are 0.",
    .source =
        "arithmetic. YCoCg: Malvar and Sullivan, \"YCoCg-R: A Color Space with RGB Reversibility and Low Dynamic Range\", "
        "JVT-I014r3, 2003.",
    .inputs = {{"first", kPlane, "red, or luma"},
               {"second", kPlane, "green, or the difference of red and blue", true},
               {"third", kPlane, "blue, or the difference of green and the others", true}},
    .outputs = {{"color", kColor, "the color"}},
};

class Merge final : public Pass {
 public:
  explicit Merge(const Params& params) : space_(params.space) {}

  void infer(Inference& inference) const override { inference.set_by_rows(); }

  void run(const Frame& frame) const override {
    const FloatImage planes[] = {frame.image("first"), frame.image("second"), frame.image("third")};
    const FloatOutput out = frame.output("color");
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) {
        for (int c = 0; c < 3; ++c) {
          if (planes[c])
            std::copy_n(planes[c].row(y), out.width, out.row(y, c));
          else
            std::fill_n(out.row(y, c), out.width, 0.0F);
        }
        if (space_ == Space::ycocg) convert_row(out.row(y, 0), out.row(y, 1), out.row(y, 2), out.width);
      }
    });
  }

 private:
  static void convert_row(float* __restrict red, float* __restrict green, float* __restrict blue, int width) {
    for (int x = 0; x < width; ++x) {
      const float luma = red[x], orange = green[x], difference = blue[x], sides = luma - difference;
      red[x] = sides + orange;
      green[x] = luma + difference;
      blue[x] = sides - orange;
    }
  }

  Space space_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Merge, quell::Params)
