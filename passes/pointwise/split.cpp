// Takes an image apart into its planes.
// Source:  arithmetic; YCoCg of Malvar and Sullivan, JVT-I014r3, 2003.
// Cost:    a copy, or some five operations a pixel; bound by memory.
#include <algorithm>

#include "quell/sdk/pass.h"

namespace quell {
namespace {

enum class Space { planes, ycocg };

struct Params {
  Space space = Space::planes;
  void describe(auto&& field) {
    field("space", space,
          Choices{{"planes", "the planes as they are: red, green and blue, or x, y and z"},
                  {"ycocg", "of three planes: luma (R + 2 G + B) / 4, and the differences (R - B) / 2 and (2 G - R - B) / 4"}},
          "What becomes of the planes.");
  }
};

const PassInfo kInfo{
    .id = "split",
    .summary = "Takes an image apart into its planes",
    .doc =
        "Each plane becomes a scalar image, which can be filtered, mixed or shown by itself; merge puts three of them "
        "together again. Of images of two planes the third is 0, and they have no YCoCg: their planes are taken as they are.",
    .source =
        "arithmetic. YCoCg: Malvar and Sullivan, \"YCoCg-R: A Color Space with RGB Reversibility and Low Dynamic Range\", "
        "JVT-I014r3, 2003.",
    .inputs = {{"image", kColor | kAlbedo | kNormal | kPosition | kMotion | kMoments, "what to take apart"}},
    .outputs = {{"first", kScalar, "red, x, or luma"},
                {"second", kScalar, "green, y, or the difference of red and blue"},
                {"third", kScalar, "blue, z, or the difference of green and the others; 0 where there are two planes"}},
};

class Split final : public Pass {
 public:
  explicit Split(const Params& params) : space_(params.space) {}

  void infer(Inference& inference) const override { inference.set_by_rows(); }

  void run(const Frame& frame) const override {
    const FloatImage in = frame.image("image");
    const FloatOutput first = frame.output("first"), second = frame.output("second"), third = frame.output("third");
    frame.parallel_rows(in.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) {
        if (in.channels == 3 && space_ == Space::ycocg) {
          convert_row(in, y, first.row(y), second.row(y), third.row(y));
          continue;
        }
        std::copy_n(in.row(y, 0), in.width, first.row(y));
        std::copy_n(in.row(y, 1), in.width, second.row(y));
        if (in.channels == 3)
          std::copy_n(in.row(y, 2), in.width, third.row(y));
        else
          std::fill_n(third.row(y), in.width, 0.0F);
      }
    });
  }

 private:
  static void convert_row(const FloatImage& in, int y, float* __restrict luma, float* __restrict orange,
                          float* __restrict green) {
    const float *r = in.row(y, 0), *g = in.row(y, 1), *b = in.row(y, 2);
    for (int x = 0; x < in.width; ++x) {
      const float sides = 0.5F * (r[x] + b[x]);
      luma[x] = 0.5F * (g[x] + sides);
      orange[x] = 0.5F * (r[x] - b[x]);
      green[x] = 0.5F * (g[x] - sides);
    }
  }

  Space space_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Split, quell::Params)
