// One picture of what a denoiser goes by, to look at: six views that show when an input or the history is wrong.
//
// Source:  the validation layer of NVIDIA's Real-Time Denoisers, which shows guides, motion and history side by side.
//
// Departs: views of full size, motion error measured on any image that is fetched along motion, depth scaled by its quantiles.
//
// Cost:    some 100 operations a pixel, and a count of all depths on one thread.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "quell/sdk/pass.h"

namespace quell {
namespace {

struct Params {
  double max_motion = 16, max_error = 0.25, max_length = 32;
  void describe(auto&& field) {
    field("max_motion", max_motion, Range<double>{1e-3, 1e6}, "px", "Motion of this length has full brightness.");
    field("max_error", max_error, Range<double>{1e-6, 1e6}, "unit of the image", "Motion error that is white.");
    field("max_length", max_length, Range<double>{1, 1e6}, "frames", "History of this length is white.");
  }
};

const PassInfo kInfo{
    .id = "validate",
    .summary = "One picture of normals, depth, motion, its error, and the history, for looking",
    .doc =
        "Six views, each of the size of the frame, in two rows of three:\n\n"
        "normal: (n + 1) / 2 as red, green, blue; gray where there is no surface.\n"
        "depth: the logarithm of depth, from white at its 1 % quantile in the frame to dark gray at the 99 % quantile; black "
        "where there is no surface.\n"
        "motion: the direction as hue (toward the right red, down yellow-green, left cyan, up violet; the vector points to where "
        "the surface was), the root of the length as brightness, so that slow motion shows, too; black is at rest.\n"
        "motion error: how far `image` is from `history`, the same image of the frame before, fetched along motion: the length "
        "of "
        "the difference over all planes, black to white at max_error. Images without noise that sit on surfaces show it best: "
        "albedo, or position where nothing moves. With color one sees the noise, too. Red where `valid` is 0.\n"
        "history length: black to white at max_length.\n"
        "rejected: how much of the fetch failed its tests, black to white. Red where `valid` is 0: nothing was left.\n\n"
        "The view of an input that is absent is gray with a diagonal. All shades are the 8-bit values that a PNG has.",
    .source =
        "After the validation layer of NVIDIA's Real-Time Denoisers (NRD). sRGB: IEC 61966-2-1. The measure of motion error is "
        "quell's own.",
    .inputs = {{"motion", kMotion, "previous minus current position, pixels, y down"},
               {"normal", kNormal, "world-space normals", true},
               {"depth", kDepth, "distance along the view axis", true},
               {"image", kAnyFloatImage, "what motion is measured on: albedo, position, color, ...", true},
               {"history", kAnyFloatImage, "the same of the frame before, at this frame's pixels; of the type of image", true},
               {"valid", kMask, "where there is a history; without it, everywhere", true},
               {"length", kScalar, "how many frames the history reaches back", true},
               {"rejected", kScalar, "0 to 1: how much of the history failed the tests of reproject", true}},
    .outputs = {{"picture", kColor, "the views as linear light, 0 to 1: three times as wide and twice as high as the frame"}},
};

constexpr int kColumns = 3, kLines = 2;
constexpr float kAbsent = 0.5F, kDiagonal = 0.75F;
constexpr float kFarthest = 0.125F;  // brighter than what has no surface

// Code values, 0 to 1.
struct Rgb {
  float r = 0, g = 0, b = 0;
};
constexpr Rgb gray(float value) { return {value, value, value}; }
constexpr Rgb kNoHistory{0.75F, 0, 0};

float limit(float x) { return x > 0 ? std::min(x, 1.0F) : 0.0F; }  // NaN becomes 0

Rgb hue(float turns, float brightness) {
  const auto wave = [=](float center) {
    float distance = std::abs(turns - center);
    distance = std::min(distance, 1 - distance);
    return brightness * limit(2 - 6 * distance);
  };
  return {wave(0), wave(1 / 3.0F), wave(2 / 3.0F)};
}

// Counts numbers by the upper half of their bits, in which numbers above 0 keep their order: bins are 1 / 128 wide, or less, of
// what they hold.
struct Histogram {
  static constexpr std::size_t kBins = 1 << 15;
  std::uint32_t* bins;

  static float lower_bound(std::size_t bin) { return std::bit_cast<float>(static_cast<std::uint32_t>(bin) << 16); }
  std::size_t quantile(double share, std::uint64_t total) const {
    std::uint64_t below = 0;
    std::size_t bin = 0;
    while (bin + 1 < kBins && static_cast<double>(below += bins[bin]) <= share * static_cast<double>(total)) ++bin;
    return bin;
  }
};

// Depths that become white and dark gray.
struct DepthScale {
  float nearest = 1, per_octave = 0;  // the share of the range that a doubling takes
  float shade(float depth) const {
    if (!(depth < QUELL_NO_SURFACE_DEPTH)) return 0;
    return 1 - (1 - kFarthest) * limit(per_octave * std::log2(std::max(depth, nearest) / nearest));
  }
};

DepthScale find_scale(const FloatImage& depth, const Histogram& histogram) {
  std::fill_n(histogram.bins, Histogram::kBins, 0U);
  std::uint64_t total = 0;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x)
      if (const float z = depth.at(x, y); z > 0 && z < QUELL_NO_SURFACE_DEPTH)
        ++histogram.bins[std::bit_cast<std::uint32_t>(z) >> 16], ++total;
  if (total == 0) return {};
  const std::size_t first = histogram.quantile(0.01, total), last = histogram.quantile(0.99, total);
  const float nearest = std::max(Histogram::lower_bound(first), std::numeric_limits<float>::min());
  const float octaves = std::log2(Histogram::lower_bound(last + 1) / nearest);
  return {nearest, first < last ? 1 / octaves : 0.0F};
}

struct Job {
  FloatImage motion, normal, depth, image, history, valid, length, rejected;
  FloatOutput out;
  DepthScale scale{};
};

class Validate final : public Pass {
 public:
  explicit Validate(const Params& params)
      : max_motion_(static_cast<float>(params.max_motion)),
        max_error_(static_cast<float>(params.max_error)),
        max_length_(static_cast<float>(params.max_length)) {
    for (std::size_t i = 0; i < light_.size(); ++i) {
      const double code = static_cast<double>(i) / 255;
      light_[i] = static_cast<float>(code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4));
    }
  }

  void infer(Inference& inference) const override {
    const Size size = inference.size("motion");
    for (const PortInfo& port : kInfo.inputs) {
      if (inference.present(port.name) && inference.size(port.name) != size)
        throw std::runtime_error("'" + std::string(port.name) + "' must have the size of 'motion'");
      inference.set_unbounded(port.name);  // a view lies elsewhere than what it shows
    }
    if (inference.present("image") && inference.present("history") && inference.type("image") != inference.type("history"))
      throw std::runtime_error("'image' and 'history' must be of one type");
    inference.set_size("picture", {kColumns * size.width, kLines * size.height});
    if (inference.present("depth")) inference.set_scratch(Histogram::kBins * sizeof(std::uint32_t));
  }

  void run(const Frame& frame) const override {
    Job job{frame.image("motion"), frame.image("normal"), frame.image("depth"),    frame.image("image"),   frame.image("history"),
            frame.image("valid"),  frame.image("length"), frame.image("rejected"), frame.output("picture")};
    if (job.depth) job.scale = find_scale(job.depth, {static_cast<std::uint32_t*>(frame.scratch())});
    frame.parallel_rows(job.motion.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) {
        paint_surfaces(job, y);
        paint_history(job, y);
      }
    });
  }

 private:
  void paint_surfaces(const Job& job, int y) const {
    paint(job, 0, 0, y, bool{job.normal}, [&](int x) {
      return Rgb{(job.normal.at(x, y, 0) + 1) / 2, (job.normal.at(x, y, 1) + 1) / 2, (job.normal.at(x, y, 2) + 1) / 2};
    });
    paint(job, 1, 0, y, bool{job.depth}, [&](int x) { return gray(job.scale.shade(job.depth.at(x, y))); });
    paint(job, 2, 0, y, true, [&](int x) {
      const float dx = job.motion.at(x, y, 0), dy = job.motion.at(x, y, 1);
      const float turns = std::atan2(dy, dx) / (2 * std::numbers::pi_v<float>);
      return hue(turns < 0 ? turns + 1 : turns, limit(std::sqrt(std::hypot(dx, dy) / max_motion_)));
    });
  }

  void paint_history(const Job& job, int y) const {
    const auto is_lost = [&](int x) { return job.valid && !(job.valid.at(x, y) > 0.5F); };
    paint(job, 0, 1, y, job.image && job.history,
          [&](int x) { return is_lost(x) ? kNoHistory : gray(distance(job, x, y) / max_error_); });
    paint(job, 1, 1, y, bool{job.length}, [&](int x) { return gray(job.length.at(x, y) / max_length_); });
    paint(job, 2, 1, y, bool{job.rejected}, [&](int x) { return is_lost(x) ? kNoHistory : gray(job.rejected.at(x, y)); });
  }

  static float distance(const Job& job, int x, int y) {
    float sum = 0;
    for (int c = 0; c < job.image.channels; ++c) {
      const float difference = job.image.at(x, y, c) - job.history.at(x, y, c);
      sum += difference * difference;
    }
    return std::sqrt(sum);
  }

  // Row y of a view: color(x), or what stands for a view without input.
  template <class Color>
  void paint(const Job& job, int column, int line, int y, bool is_there, const Color& color) const {
    const int width = job.motion.width, height = job.motion.height;
    const auto put = [&, x0 = column * width, y0 = line * height](int x, const Rgb& code) {
      const std::array<float, 3> planes{code.r, code.g, code.b};
      for (int c = 0; c < 3; ++c) {
        const float rounded = 255 * limit(planes[static_cast<std::size_t>(c)]) + 0.5F;
        job.out.at(x0 + x, y0 + y, c) = light_[static_cast<std::size_t>(rounded)];
      }
    };
    for (int x = 0; x < width; ++x) put(x, is_there ? color(x) : gray(is_diagonal(x, y, width, height) ? kDiagonal : kAbsent));
  }

  // Within a pixel of the line from corner to corner.
  static bool is_diagonal(int x, int y, int width, int height) {
    const std::int64_t across = std::int64_t{2 * x + 1} * height - std::int64_t{2 * y + 1} * width;
    return std::abs(across) <= 2 * std::max(width, height);
  }

  float max_motion_, max_error_, max_length_;
  std::array<float, 256> light_{};  // of 8-bit values
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Validate, quell::Params)
