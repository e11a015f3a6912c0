// Blockwise regression: in each block of pixels the color is the best linear function of features.
// Source:  Koskela et al., "Blockwise Multi-Order Feature Regression for Real-Time Path-Tracing Reconstruction", ACM TOG 38(5),
//          2019, and its code, bmfr.cl: the features, the offsets of blocks, noise against rank deficiency.
// Departs: see kInfo.source.
// Cost:    some 350 multiply-adds in double a pixel.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "passes/spatial/least_squares.h"
#include "quell/sdk/pass.h"

namespace quell {
namespace {

enum class Placement { moving, fixed };

struct Params {
  int block = 32;
  Placement placement = Placement::moving;
  double noise = 1e-2;
  void describe(auto&& field) {
    field("block", block, Range<int>{8, 64}, "px", "Width and height of a block.");
    field("placement", placement,
          Choices{{"moving", "at another of 16 places in each frame, so that a mean over frames does not show the blocks"},
                  {"fixed", "from the image's corner on"}},
          "Where blocks are.");
    field("noise", noise, Range<double>{0, 1}, "1",
          "Amplitude of the noise that is added to features while they are fitted: it keeps weights of features that depend on"
          " each other small, and takes noise^2 / 3 over a feature's variance off its weight.");
  }
};

const PassInfo kInfo{
    .id = "regress",
    .summary = "Blockwise regression of color on features",
    .doc =
        "In each block color = w0 + w . features, in each channel with the weights w of least squares, and at least 0. The "
        "features"
        " are the normal, the position, and the square of the position, component by component; the position is scaled to 0..1"
        " in a block, and is 0 where it is the same throughout, up to 1e-6. Features whose inputs are absent are left out. While"
        " they are fitted, evenly distributed noise between -noise and noise is added to each, a hash of the pixel's place,"
        " the feature and the frame's number. A feature that depends on those before it weighs 0.\n\n"
        "Blocks at the border are fitted to the pixels nearest to them that make a whole block. Pixels without surface (normal 0)"
        " and such as are not finite do not count, and keep their color; without normals background is not told, and counts with"
        " whatever position it has. Where fewer than four pixels a feature count, the color becomes their mean.\n\n"
        "Give it demodulated, accumulated light: what features do not explain, such as shadows and textures, is blurred to a"
        " block's polynomial. Accumulating its results over frames, as its authors do, hides the blocks.",
    .source =
        "Koskela et al., Blockwise Multi-Order Feature Regression for Real-Time Path-Tracing Reconstruction, ACM TOG 2019, with"
        " the offsets and the noise of bmfr.cl. Departs: blocks at the border are shifted inside, not mirrored; every range of"
        " positions is scaled, not those above 1 alone, which would depend on the unit; squares are of the scaled position,"
        " which makes the same functions from better numbers; background does not count; double precision.",
    .inputs = {{"color", kColor, "radiance, best without albedo"},
               {"normal", kNormal, "feature", true},
               {"position", kPosition, "feature, of first and second order", true}},
    .outputs = {{"color", kColor, "the fit"}},
};

// Of bmfr.cl, for blocks of 32 pixels.
constexpr int kBlockOfOffsets = 32;
constexpr std::array<std::array<int, 2>, 16> kOffsets{{{-14, -14},
                                                       {4, -6},
                                                       {-8, 14},
                                                       {8, 0},
                                                       {-10, -8},
                                                       {2, 12},
                                                       {12, -12},
                                                       {-10, 0},
                                                       {12, 14},
                                                       {-8, -16},
                                                       {6, 6},
                                                       {-2, -2},
                                                       {6, -14},
                                                       {-16, 12},
                                                       {14, -4},
                                                       {-6, 4}}};

constexpr int kMaxFeatures = 10;  // 1, normal, position, its square
constexpr int kPixelsPerFeature = 4;
constexpr double kSmallestRange = 1e-6;  // of positions, over their size: what floats tell apart

// The finalizer of MurmurHash3.
std::uint32_t mix(std::uint32_t h) {
  h ^= h >> 16, h *= 0x85ebca6bU, h ^= h >> 13, h *= 0xc2b2ae35U;
  return h ^ (h >> 16);
}
// A hash of a pixel's place and of the frame's number.
std::uint32_t hash_pixel(int x, int y, std::uint32_t frame) {
  return mix(mix(mix(frame + 0x9e3779b9U) ^ static_cast<std::uint32_t>(x)) ^ static_cast<std::uint32_t>(y));
}
// From -1 to 1, for a pixel's feature.
double noise_of(std::uint32_t pixel, int feature) {
  return mix(pixel ^ static_cast<std::uint32_t>(feature) * 0x9e3779b9U) * (2 / 4294967295.0) - 1;
}

struct Images {
  FloatImage color, normal, position;

  bool counts(int x, int y) const {
    float sum = 0;
    bool has_surface = !normal;
    for (const FloatImage& image : {color, normal, position})
      for (int c = 0; image && c < 3; ++c) sum += 0 * image.at(x, y, c);  // NaN unless finite
    for (int c = 0; normal && c < 3; ++c) has_surface = has_surface || normal.at(x, y, c) != 0;
    return sum == 0 && has_surface;
  }
};

struct Rect {
  int left, top, right, bottom;
};

// What features are made of in a block.
struct Fit {
  int count = 0;  // of features
  double smallest[3] = {}, scale[3] = {};
  double weights[least_squares::kSides][least_squares::kMaxUnknowns] = {};

  // Calls use(i, value) for each feature of a pixel. They are not put side by side in memory, where reading them would wait.
  template <class Use>
  void each_feature(const Images& in, int x, int y, const Use& use) const {
    use(0, 1.0);
    if (count == 1) return;
    int i = 1;
    for (int c = 0; in.normal && c < 3; ++c) use(i++, in.normal.at(x, y, c));
    for (int c = 0; in.position && c < 3; ++c) {
      const double scaled = (in.position.at(x, y, c) - smallest[c]) * scale[c];
      use(i, scaled), use(i + 3, scaled * scaled);
      ++i;
    }
  }
};

class Regress final : public Pass {
 public:
  explicit Regress(const Params& p) : params_(p) {}

  void infer(Inference& inference) const override {
    for (const char* input : {"color", "normal", "position"}) inference.set_radius(input, params_.block - 1);
    const std::size_t rows = least_squares::padded(static_cast<std::size_t>(params_.block * params_.block));
    inference.set_slot_scratch(rows * (kMaxFeatures + least_squares::kSides) * sizeof(double));
  }

  void run(const Frame& frame) const override {
    const Images in{frame.image("color"), frame.image("normal"), frame.image("position")};
    const FloatOutput out = frame.output("color");
    const auto [left, top] = find_origin(frame.number());
    const int columns = (out.width - left + params_.block - 1) / params_.block;
    const int rows = (out.height - top + params_.block - 1) / params_.block;
    const auto number = static_cast<std::uint32_t>(frame.number());
    frame.parallel_rows(
        columns * rows,
        [&, left = left, top = top](int first, int end, std::uint32_t slot) {
          for (int i = first; i < end; ++i) {
            const int x = left + i % columns * params_.block, y = top + i / columns * params_.block;
            regress_block(in, x, y, number, static_cast<double*>(frame.slot_scratch(slot)), out);
          }
        },
        1);
  }

 private:
  // Of the first block, which begins at or before the image.
  std::array<int, 2> find_origin(std::int64_t frame) const {
    if (params_.placement == Placement::fixed) return {0, 0};
    constexpr auto kCount = static_cast<std::int64_t>(kOffsets.size());
    const auto& offset = kOffsets[static_cast<std::size_t>((frame % kCount + kCount) % kCount)];
    return {(offset[0] - kBlockOfOffsets / 2) * params_.block / kBlockOfOffsets,
            (offset[1] - kBlockOfOffsets / 2) * params_.block / kBlockOfOffsets};
  }

  void regress_block(const Images& in, int x, int y, std::uint32_t frame, double* scratch, const FloatOutput& out) const {
    const int width = out.width, height = out.height, block = params_.block;
    const Rect own{std::max(x, 0), std::max(y, 0), std::min(x + block, width), std::min(y + block, height)};
    if (own.left >= own.right || own.top >= own.bottom) return;
    const int left = std::clamp(x, 0, std::max(width - block, 0)), top = std::clamp(y, 0, std::max(height - block, 0));
    const Fit fit = find_fit(in, {left, top, std::min(left + block, width), std::min(top + block, height)}, frame, scratch);
    for (int py = own.top; py < own.bottom; ++py)
      for (int px = own.left; px < own.right; ++px) {
        double color[3] = {};
        fit.each_feature(in, px, py, [&](int i, double feature) {
          for (int c = 0; c < 3; ++c) color[c] += fit.weights[c][i] * feature;
        });
        const bool counts = in.counts(px, py);
        for (int c = 0; c < 3; ++c)
          out.at(px, py, c) = counts ? static_cast<float>(std::max(color[c], 0.0)) : in.color.at(px, py, c);
      }
  }

  Fit find_fit(const Images& in, const Rect& rect, std::uint32_t frame, double* columns) const {
    Fit fit;
    const std::size_t pixels = find_ranges(in, rect, fit);
    const int all = 1 + (in.normal ? 3 : 0) + (in.position ? 6 : 0);
    fit.count = pixels >= static_cast<std::size_t>(kPixelsPerFeature * all) ? all : 1;
    const std::size_t rows = least_squares::padded(pixels);
    std::fill_n(columns, rows * static_cast<std::size_t>(fit.count + least_squares::kSides), 0.0);
    std::size_t row = 0;
    for (int y = rect.top; y < rect.bottom; ++y)
      for (int x = rect.left; x < rect.right; ++x) {
        if (!in.counts(x, y)) continue;
        const std::uint32_t hash = hash_pixel(x, y, frame);
        fit.each_feature(in, x, y, [&](int i, double feature) {
          const double noise = i > 0 ? params_.noise * noise_of(hash, i) : 0;
          columns[static_cast<std::size_t>(i) * rows + row] = feature + noise;
        });
        for (int c = 0; c < 3; ++c) columns[static_cast<std::size_t>(fit.count + c) * rows + row] = in.color.at(x, y, c);
        ++row;
      }
    if (rows > 0) least_squares::solve(columns, rows, fit.count, fit.weights);
    return fit;
  }

  // Of positions in the block; returns how many pixels count.
  static std::size_t find_ranges(const Images& in, const Rect& rect, Fit& fit) {
    std::size_t pixels = 0;
    double largest[3] = {};
    for (int y = rect.top; y < rect.bottom; ++y)
      for (int x = rect.left; x < rect.right; ++x) {
        if (!in.counts(x, y)) continue;
        for (int c = 0; in.position && c < 3; ++c) {
          const double p = in.position.at(x, y, c);
          fit.smallest[c] = pixels == 0 ? p : std::min(fit.smallest[c], p);
          largest[c] = pixels == 0 ? p : std::max(largest[c], p);
        }
        ++pixels;
      }
    for (int c = 0; c < 3; ++c) {
      const double range = largest[c] - fit.smallest[c];
      const double size = std::max(std::abs(largest[c]), std::abs(fit.smallest[c]));
      fit.scale[c] = range > kSmallestRange * size ? 1 / range : 0;
    }
    return pixels;
  }

  Params params_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Regress, quell::Params)
