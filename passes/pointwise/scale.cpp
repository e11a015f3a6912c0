// Half and double resolution: means of 2 x 2 pixels down, joint bilateral upsampling up.
// Source:  Kopf et al., "Joint Bilateral Upsampling", SIGGRAPH 2007, section 3: weights of distance at the small resolution and
//          of likeness at the large one.
// Departs: the spatial weight is the bilinear tent of four taps; likeness is that of depth and normals; taps that are all unlike
//          count by distance alone.
// Cost:    down, four loads a channel; up, four gathered taps a channel and, with guides, one weight a tap.
#include <algorithm>
#include <stdexcept>
#include <type_traits>

#include "passes/pointwise/scale_kernel.h"
#include "quell/sdk/pass.h"

namespace quell {
namespace {

enum class To { half, twice };
enum class Method { by_type, average, nearest };

struct Params {
  To to = To::half;
  Method method = Method::by_type;
  double sigma_z = 0.05, sigma_n = 32;
  void describe(auto&& field) {
    field("to", to,
          Choices{{"half", "half the resolution, rounded up"},
                  {"double", "twice the resolution, or the size of the full guides where there are some"}},
          "Which resolution the result has.");
    field("method", method,
          Choices{{"by_type",
                   "average for color, albedo, moments, variance, scalar and alpha; nearest for what has no mean across an "
                   "edge: normal, position, depth, id, motion and mask"},
                  {"average", "the mean of 2 x 2 pixels, or joint bilateral upsampling; ids are taken as with nearest"},
                  {"nearest", "the upper left one of 2 x 2 pixels, or the pixel that contains the new one's center"}},
          "How pixels become others.");
    field("sigma_z", sigma_z, Range<double>{1e-6, 1e6}, "1", "Upsampling: tolerated difference in depth, over the depth.");
    field("sigma_n", sigma_n, Range<double>{0, 1024}, "1", "Upsampling: power of the cosine between normals.");
  }
};

const PassInfo kInfo{
    .id = "scale",
    .summary = "Half or double resolution, guided by depth and normals where it is doubled",
    .doc =
        "Half: pixel (x, y) is the mean of those of (2x, 2y) to (2x + 1, 2y + 1) that exist, or the first of them.\n\n"
        "Double: the center of a pixel, (x + 0.5) / 2 - 0.5 among the small ones, has four around it (those outside repeat "
        "the border). Average weighs them bilinearly, times exp(-|z - z'| / (sigma_z |z|)) max(0, n.n')^sigma_n + 1e-6, with "
        "z, n of the full guides and z', n' of the small ones; guides of which one is absent are left out. Where the size of "
        "the full guides is not twice that of the image, or one less, coordinates are scaled by the quotient of the sizes. "
        "The small guides are best made by this pass from the full ones.\n\n"
        "Motion is in pixels and is scaled with them. A variance is averaged as any number: that of the mean of four "
        "independent pixels is a quarter of it.",
    .source =
        "Kopf et al., \"Joint Bilateral Upsampling\", SIGGRAPH 2007, section 3. Departs: a bilinear tent of four taps as the "
        "spatial weight, depth and normals instead of colors, and the floor of 1e-6, which makes it bilinear where all taps "
        "are unlike.",
    .inputs = {{"image", kAnyImage, "what to scale"},
               {"depth", kDepth, "for double: at the image's resolution", true},
               {"normal", kNormal, "for double: at the image's resolution", true},
               {.name = "full_depth",
                .types = kDepth,
                .doc = "for double: at the resolution of the result",
                .optional = true,
                .any_size = true},
               {.name = "full_normal",
                .types = kNormal,
                .doc = "for double: at the resolution of the result",
                .optional = true,
                .any_size = true}},
    .outputs = {{.name = "image", .doc = "the same at the other resolution", .same_as = "image"}},
};

constexpr double kLog2E = 1.4426950408889634;
constexpr Types kAveraged = kColor | kAlbedo | kMoments | kVariance | kScalar | kAlpha;

int half(int size) { return (size + 1) / 2; }

// From a pixel of the large image to one of the small one.
float factor(int small, int large) {
  return half(large) == small ? 0.5F : static_cast<float>(static_cast<double>(small) / large);
}

// The image is an image of ids or of floats: calls body with the input and the output as such.
template <class Body>
void with_image(const Frame& frame, const Body& body) {
  if (frame.type("image") == QUELL_TYPE_ID)
    body(frame.ids("image"), frame.output_ids("image"));
  else
    body(frame.image("image"), frame.output("image"));
}

class Scale final : public Pass {
 public:
  explicit Scale(const Params& params) : p_(params) {}

  void infer(Inference& inference) const override {
    inference.set_unbounded("image");
    const Size size = inference.size("image");
    if (p_.to == To::half) return inference.set_size("image", {half(size.width), half(size.height)});
    for (const char* input : {"depth", "normal"}) inference.set_unbounded(input);
    inference.set_size("image", full_size(inference));
  }

  void run(const Frame& frame) const override {
    const quell_type type = frame.type("image");
    const bool is_averaged = type != QUELL_TYPE_ID && (p_.method == Method::average ||
                                                       (p_.method == Method::by_type && (QUELL_TYPE_BIT(type) & kAveraged)));
    with_image(frame, [&](const auto& in, const auto& out) {
      const Gains gains = find_gains(type, in.width, in.height, out.width, out.height);
      if (!is_averaged)
        pick_nearest(frame, in, out, gains);
      else if (p_.to == To::half)
        halve(frame, gains);
      else
        enlarge(frame, gains);
    });
  }

 private:
  // Of the first plane, and of all others: motion is in pixels.
  struct Gains {
    float first, others;
    float of(int c) const { return c == 0 ? first : others; }
  };
  Gains find_gains(quell_type type, int width, int height, int new_width, int new_height) const {
    if (type != QUELL_TYPE_MOTION) return {1, 1};
    if (p_.to == To::half) return {0.5F, 0.5F};
    return {1 / factor(width, new_width), 1 / factor(height, new_height)};
  }

  static Size full_size(const Inference& inference) {
    const Size small = inference.size("image");
    Size full{2 * small.width, 2 * small.height};
    bool is_told = false;
    for (const char* input : {"full_depth", "full_normal"}) {
      if (!inference.present(input)) continue;
      if (is_told && inference.size(input) != full) throw std::runtime_error("full_depth and full_normal must have one size");
      full = inference.size(input), is_told = true;
    }
    return full;
  }

  template <class Body>
  static void each_row(const Frame& frame, int height, const Body& body) {
    frame.parallel_rows(height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) body(y);
    });
  }

  // Upper left pixels of 2 x 2, or pixels that contain the centers of new ones.
  template <class In, class Out>
  void pick_nearest(const Frame& frame, const In& in, const Out& out, const Gains& gains) const {
    const auto place = [&](int at, int from, int to) {
      const int there = p_.to == To::half ? 2 * at : half(to) == from ? at / 2 : static_cast<int>((at + 0.5) * from / to);
      return std::min(there, from - 1);
    };
    each_row(frame, out.height, [&](int y) {
      for (int c = 0; c < out.channels; ++c) {
        const auto* row = in.row(place(y, in.height, out.height), c);
        for (int x = 0; x < out.width; ++x) {
          const auto value = row[place(x, in.width, out.width)];
          if constexpr (std::is_same_v<decltype(value), const float>)
            out.at(x, y, c) = gains.of(c) * value;
          else
            out.at(x, y, c) = value;
        }
      }
    });
  }

  static void halve(const Frame& frame, const Gains& gains) {
    const FloatImage in = frame.image("image");
    const FloatOutput out = frame.output("image");
    const int pairs = in.width / 2;
    each_row(frame, out.height, [&](int y) {
      for (int c = 0; c < out.channels; ++c) {
        // Where there is no lower row, that above stands for it: the mean is the same.
        const float *upper = in.row(2 * y, c), *lower = in.row(std::min(2 * y + 1, in.height - 1), c);
        float* __restrict to = out.row(y, c);
        const float quarter = 0.25F * gains.of(c);
        for (int x = 0; x < pairs; ++x) to[x] = quarter * ((upper[2 * x] + upper[2 * x + 1]) + (lower[2 * x] + lower[2 * x + 1]));
        if (pairs < out.width) to[pairs] = 2 * quarter * (upper[2 * pairs] + lower[2 * pairs]);
      }
    });
  }

  void enlarge(const Frame& frame, const Gains& gains) const {
    const FloatImage in = frame.image("image");
    const FloatOutput out = frame.output("image");
    scale::Guides guides{frame.image("depth"), frame.image("normal"), frame.image("full_depth"), frame.image("full_normal")};
    if (!guides.depth || !guides.full_depth) guides.depth = guides.full_depth = {};
    if (!guides.normal || !guides.full_normal) guides.normal = guides.full_normal = {};
    const scale::Settings settings{.factor_x = factor(in.width, out.width),
                                   .factor_y = factor(in.height, out.height),
                                   .inverse_sigma_z = static_cast<float>(kLog2E / p_.sigma_z),
                                   .normal_power = static_cast<float>(p_.sigma_n * kLog2E),
                                   .gains = {gains.first, gains.others}};
    each_row(frame, out.height, [&](int y) { scale::enlarge_row(in, guides, settings, y, out); });
  }

  Params p_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Scale, quell::Params)
