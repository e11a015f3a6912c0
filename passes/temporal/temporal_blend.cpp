// Exponential average over time, the history first clamped to what its neighborhood in the new frame makes plausible.
// Source:  GAMES202, homework 5: alpha C + (1 - alpha) clamp(history, mu - k sigma, mu + k sigma); the clamp to mean and
//          deviation of a window is the variance clipping of Salvi, "An Excursion in Temporal Supersampling", GDC 2016; that to
//          its range, and in YCoCg, stands in Karis, "High-Quality Temporal Supersampling", SIGGRAPH 2014.
// Departs: the homework takes the deviation about the center pixel and divides by the full window also at the border; both are
//          choices here, and by default the deviation is about the mean and the divisor the number of pixels that exist. With a
//          length the average begins as a plain mean, as in Falcor's SVGFPass.
// Cost:    2 (2r + 1) multiply-adds for each of the two separable sums, a channel; no branch a tap. YCoCg needs a copy of the
// frame.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "quell/sdk/pass.h"
#include "quell/sdk/plain_loop.h"

namespace quell {
namespace {

enum class Clamp { neighborhood, none, range };
enum class Space { rgb, ycocg };
enum class Spread { mean, center };
enum class Count { existing, full };

struct Params {
  double alpha = 0.2, max_length = 32;
  Clamp clamp = Clamp::neighborhood;
  Space space = Space::rgb;
  int clamp_radius = 3;
  double clamp_k = 1.0;
  Spread spread = Spread::mean;
  Count count = Count::existing;
  void describe(auto&& field) {
    field("alpha", alpha, Range<double>{0, 1}, "", "Share of the new frame; 1 ignores the history.");
    field("max_length", max_length, Range<double>{1, 1e6}, "frames",
          "The history's length is counted up to this. With alpha 0 the average is the running mean of that many frames.");
    field("clamp", clamp,
          Choices{{"neighborhood", "to mean +- clamp_k deviations of the window"},
                  {"none", "the history as it is"},
                  {"range", "from the smallest to the largest value in the window; clamp_k, spread and count do not matter"}},
          "What the history is limited to.");
    field("space", space,
          Choices{{"rgb", "red, green and blue"},
                  {"ycocg", "luma and two differences of color, which limit hue and brightness apart: fewer colors pass"}},
          "In which components of color the history is limited, each by itself.");
    field("clamp_radius", clamp_radius, Range<int>{0, 64}, "px", "The window has (2 clamp_radius + 1)^2 pixels.");
    field("clamp_k", clamp_k, Range<double>{0, 1e6}, "standard deviations", "Tolerated distance from the window's mean.");
    field("spread", spread,
          Choices{{"mean", "about the window's mean: the population standard deviation"},
                  {"center", "about the center pixel: the published listing"}},
          "What the deviation is taken about.");
    field("count", count,
          Choices{{"existing", "by the number of the window's pixels that lie in the image"},
                  {"full",
                   "by (2 clamp_radius + 1)^2 also at the border: the published listing, which pulls the mean towards 0 there"}},
          "What the window's sums are divided by.");
  }
};

const PassInfo kInfo{
    .id = "temporal_blend",
    .summary = "Exponential average over time with neighborhood clamp",
    .doc =
        "color = alpha color + (1 - alpha) clamp(history), for each channel by itself. Where the history is absent or not "
        "valid, the new color stands alone. After n frames of a scene at rest a first frame's share is (1 - alpha)^(n - 1), "
        "and the variance of the noise tends to alpha / (2 - alpha) of that of one frame.\n\n"
        "With a length, alpha is max(alpha, 1 / n) with n = min(max_length, length + 1): young histories are plain means. With a "
        "confidence c in the history, alpha becomes 1 - c (1 - alpha), and the new length 1 + c (n - 1) instead of n. A history "
        "without a length counts as one of max_length frames; where there is none, the new length is 1.\n\n"
        "In ycocg the history becomes Y = (R + 2 G + B) / 4, Co = (R - B) / 2, Cg = (2 G - R - B) / 4, is limited there by the "
        "same "
        "components of the window, and comes back as R = Y + Co - Cg, G = Y + Cg, B = Y - Co - Cg, which may lie a little below "
        "0 "
        "where dark colors were limited.\n\n"
        "The window's sums are taken in double: squares of floats are exact there, and the error of a 7x7 window's deviation "
        "is below 1e-7 of the largest value in it.",
    .source =
        "GAMES202, homework 5 (accumulation, equations for mu, sigma and the clamp). Salvi, \"An Excursion in Temporal "
        "Supersampling\", GDC 2016. Range, and YCoCg: Karis, \"High-Quality Temporal Supersampling\", SIGGRAPH 2014, course. "
        "Alpha by length: Falcor's SVGFPass.",
    .inputs = {{"color", kColor, "the new frame"},
               {"history", kColor, "the average so far, at this frame's pixels", true},
               {"valid", kMask, "where the history can be used; without it, everywhere", true},
               {"length", kScalar, "how many frames the history reaches back, at this frame's pixels", true},
               {"confidence", kScalar, "0 to 1: how far the history is to be trusted", true}},
    .outputs = {{"color", kColor, "the new average"}, {"length", kScalar, "frames that it reaches back"}},
};

struct Job {
  FloatImage color, history, valid, length, confidence;
  FloatOutput out, new_length;
  FloatImage window;  // what the history is limited by: the color, or that in YCoCg
};

// Malvar and Sullivan, "YCoCg-R: A Color Space with RGB Reversibility and Low Dynamic Range", JVT-I014r3, 2003.
std::array<double, 3> ycocg_from_rgb(double r, double g, double b) {
  return {0.25 * r + 0.5 * g + 0.25 * b, 0.5 * r - 0.5 * b, 0.5 * g - 0.25 * r - 0.25 * b};
}
std::array<double, 3> rgb_from_ycocg(double y, double co, double cg) { return {y + co - cg, y + cg, y - co - cg}; }

// Elements of a row of an image in scratch memory, on cache lines, with a line more that may be read.
std::ptrdiff_t scratch_stride(int width) { return (std::ptrdiff_t{width} + 15) / 16 * 16 + 16; }

// Limits of each pixel of a row.
struct Limits {
  double *lower, *upper;
  double apply(int x, double value) const { return std::min(std::max(value, lower[x]), upper[x]); }
};

// Sums over the window's column, for each pixel of a row; `radius` zeros stand on both sides, so that a sum along the row needs
// no test for the border.
struct ColumnSums {
  double *first, *second;  // of c and of c^2, both starting at the padding
};

void sum_columns(const FloatImage& image, int c, int y, int radius, const ColumnSums& sums) {
  const int width = image.width;
  std::fill_n(sums.first, width + 2 * radius, 0.0);
  std::fill_n(sums.second, width + 2 * radius, 0.0);
  double* __restrict first = sums.first + radius;
  double* __restrict second = sums.second + radius;
  for (int ty = std::max(y - radius, 0); ty <= std::min(y + radius, image.height - 1); ++ty) {
    const float* __restrict row = image.row(ty, c);
    for (int x = 0; x < width; ++x) {
      const double value = row[x];
      first[x] += value;
      second[x] += value * value;
    }
  }
}

// The smallest and largest value of the window, as the sums are found: columns first.
void find_range(const FloatImage& image, int c, int y, int radius, const ColumnSums& columns, const Limits& limits) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const int width = image.width;
  std::fill_n(columns.first, width + 2 * radius, kInfinity);
  std::fill_n(columns.second, width + 2 * radius, -kInfinity);
  const auto widen = [width](const auto* low, const auto* high, double* __restrict lower, double* __restrict upper) {
    for (int x = 0; x < width; ++x) {
      lower[x] = std::min(lower[x], double{low[x]});
      upper[x] = std::max(upper[x], double{high[x]});
    }
  };
  for (int ty = std::max(y - radius, 0); ty <= std::min(y + radius, image.height - 1); ++ty)
    widen(image.row(ty, c), image.row(ty, c), columns.first + radius, columns.second + radius);
  std::fill_n(limits.lower, width, kInfinity);
  std::fill_n(limits.upper, width, -kInfinity);
  for (int dx = 0; dx <= 2 * radius; ++dx) widen(columns.first + dx, columns.second + dx, limits.lower, limits.upper);
}

// Pixels of [at - radius, at + radius] that lie in [0, size).
int existing(int at, int radius, int size) { return std::min(at + radius, size - 1) - std::max(at - radius, 0) + 1; }

class TemporalBlendPass final : public Pass {
 public:
  explicit TemporalBlendPass(const Params& params) : params_(params) {}

  void infer(Inference& inference) const override {
    const bool counts = inference.present("length");
    const double least = counts ? std::max(params_.alpha, 1 / params_.max_length) : params_.alpha;  // share of the new frame
    inference.set_fading(1 - least, counts ? static_cast<int>(std::ceil(params_.max_length)) : 0);
    const auto width = static_cast<std::size_t>(inference.size("color").width);
    const bool is_converted = inference.present("history") && params_.clamp != Clamp::none && params_.space == Space::ycocg;
    if (!is_converted) inference.set_by_rows();
    if (!inference.present("history")) return inference.set_in_place("color", "color");
    inference.set_in_place("color", "history");
    inference.set_slot_scratch(width * sizeof(double));
    if (params_.clamp == Clamp::none) return;
    inference.set_radius("color", params_.clamp_radius);
    const std::size_t channels = params_.space == Space::ycocg ? 3 : 1;  // whose limits are needed at a time
    inference.set_slot_scratch((width + (2 + 2 * channels) * padded(inference.size("color").width)) * sizeof(double));
    if (is_converted)
      inference.set_scratch(3 * static_cast<std::size_t>(scratch_stride(inference.size("color").width)) *
                            static_cast<std::size_t>(inference.size("color").height) * sizeof(float));
  }

  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color"), history = frame.image("history");
    const bool is_converted = history && params_.clamp != Clamp::none && params_.space == Space::ycocg;
    const Job job{color,
                  history,
                  frame.image("valid"),
                  frame.image("length"),
                  frame.image("confidence"),
                  frame.output("color"),
                  frame.output("length"),
                  is_converted ? convert(frame, color) : color};
    frame.parallel_rows(job.out.height, [&](int y0, int y1, std::uint32_t slot) {
      for (int y = y0; y < y1; ++y) {
        if (job.history)
          blend_rows(job, y, static_cast<double*>(frame.slot_scratch(slot)));
        else
          take_rows(job, y);
      }
    });
  }

 private:
  std::size_t padded(int width) const {
    return static_cast<std::size_t>(width) + 2 * static_cast<std::size_t>(params_.clamp_radius);
  }

  static void take_rows(const Job& job, int y) {
    for (int c = 0; c < job.out.channels; ++c)
      if (job.out.row(y, c) != job.color.row(y, c)) std::copy_n(job.color.row(y, c), job.out.width, job.out.row(y, c));
    std::fill_n(job.new_length.row(y), job.out.width, 1.0F);
  }

  static FloatImage convert(const Frame& frame, const FloatImage& color) {
    const std::ptrdiff_t stride = scratch_stride(color.width);
    const FloatOutput out{color.width, color.height, 3, stride, stride * color.height, static_cast<float*>(frame.scratch())};
    frame.parallel_rows(color.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y)
        for (int x = 0; x < color.width; ++x) {
          const std::array<double, 3> converted = ycocg_from_rgb(color.at(x, y, 0), color.at(x, y, 1), color.at(x, y, 2));
          for (int c = 0; c < 3; ++c) out.at(x, y, c) = static_cast<float>(converted[static_cast<std::size_t>(c)]);
        }
    });
    return out;
  }

  void blend_rows(const Job& job, int y, double* scratch) const {
    double* alphas = scratch;
    find_alphas(job, y, alphas);
    if (params_.clamp != Clamp::none && params_.space == Space::ycocg)
      return blend_ycocg_row(job, y, alphas, scratch + job.out.width);
    for (int c = 0; c < job.out.channels; ++c) {
      if (params_.clamp == Clamp::none)
        blend_row(job, y, c, alphas, nullptr);
      else
        blend_clamped_row(job, y, c, alphas, scratch + job.out.width);
    }
  }

  // The new frame's share in each pixel of the row, and the new length.
  QUELL_PLAIN_LOOP void find_alphas(const Job& job, int y, double* __restrict alphas) const {
    const int width = job.out.width;
    const float *length = job.length ? job.length.row(y) : nullptr, *valid = job.valid ? job.valid.row(y) : nullptr,
                *confidence = job.confidence ? job.confidence.row(y) : nullptr;
    float* __restrict new_length = job.new_length.row(y);
    const double alpha = params_.alpha, max_length = params_.max_length;
    for (int x = 0; x < width; ++x) {
      const double n = length ? std::min(max_length, length[x] + 1.0) : max_length;
      const double a = length ? std::max(alpha, 1 / n) : alpha;
      const double trust = confidence ? std::min(std::max(double{confidence[x]}, 0.0), 1.0) : 1.0;
      alphas[x] = confidence ? 1 - trust * (1 - a) : a;
      const float lasting = static_cast<float>(1 + trust * (n - 1));
      new_length[x] = !valid || valid[x] > 0.5F ? lasting : 1.0F;
    }
  }

  // The output may lie on the history, pixel for pixel: __restrict would deny that, ivdep promises only that no pixel depends on
  // another.
  QUELL_PLAIN_LOOP static void blend_row(const Job& job, int y, int c, const double* alphas, const Limits* limits) {
    const float *color = job.color.row(y, c), *history = job.history.row(y, c);
    const float* valid = job.valid ? job.valid.row(y) : nullptr;
    float* out = job.out.row(y, c);
    const auto blend = [=](int x, double limited) {
      const float mixed = static_cast<float>(alphas[x] * color[x] + (1 - alphas[x]) * limited);
      // Chosen, not multiplied by 0: what is not valid need not be finite.
      return !valid || valid[x] > 0.5F ? mixed : color[x];
    };
    if (limits)
#pragma GCC ivdep
      for (int x = 0; x < job.out.width; ++x) out[x] = blend(x, limits->apply(x, history[x]));
    else
#pragma GCC ivdep
      for (int x = 0; x < job.out.width; ++x) out[x] = blend(x, history[x]);
  }

  void blend_clamped_row(const Job& job, int y, int c, const double* alphas, double* scratch) const {
    const std::size_t stride = padded(job.out.width);
    const Limits limits{scratch + 2 * stride, scratch + 3 * stride};
    find_limits(job, y, c, scratch, limits);
    blend_row(job, y, c, alphas, &limits);
  }

  // As blend_row, of all channels at once: the output may lie on the history.
  void blend_ycocg_row(const Job& job, int y, const double* alphas, double* scratch) const {
    std::array<Limits, 3> limits{};
    for (std::size_t c = 0; c < 3; ++c) {
      double* own = scratch + (2 + 2 * c) * padded(job.out.width);
      limits[c] = {own, own + padded(job.out.width)};
      find_limits(job, y, static_cast<int>(c), scratch, limits[c]);
    }
    for (int x = 0; x < job.out.width; ++x) {
      const std::array<double, 3> history =
          ycocg_from_rgb(job.history.at(x, y, 0), job.history.at(x, y, 1), job.history.at(x, y, 2));
      const std::array<double, 3> limited =
          rgb_from_ycocg(limits[0].apply(x, history[0]), limits[1].apply(x, history[1]), limits[2].apply(x, history[2]));
      const bool is_valid = !job.valid || job.valid.at(x, y) > 0.5F;
      for (int c = 0; c < 3; ++c) {
        const float color = job.color.at(x, y, c);
        const double mixed = alphas[x] * color + (1 - alphas[x]) * limited[static_cast<std::size_t>(c)];
        job.out.at(x, y, c) = is_valid ? static_cast<float>(mixed) : color;
      }
    }
  }

  // `scratch` holds two padded rows.
  void find_limits(const Job& job, int y, int c, double* scratch, const Limits& limits) const {
    const ColumnSums columns{scratch, scratch + padded(job.out.width)};
    if (params_.clamp == Clamp::range) return find_range(job.window, c, y, params_.clamp_radius, columns, limits);
    sum_columns(job.window, c, y, params_.clamp_radius, columns);
    find_limits(job, y, c, columns, limits.lower, limits.upper);
  }

  void find_limits(const Job& job, int y, int c, const ColumnSums& sums, double* __restrict lower,
                   double* __restrict upper) const {
    const int width = job.out.width, radius = params_.clamp_radius;
    const float* __restrict color = job.window.row(y, c);
    // Along the row: all first sums, then all second ones, tap by tap, so that the inner loops are plain additions.
    std::fill_n(lower, width, 0.0);
    std::fill_n(upper, width, 0.0);
    for (int dx = 0; dx <= 2 * radius; ++dx) {
      const double* __restrict first = sums.first + dx;
      const double* __restrict second = sums.second + dx;
      for (int x = 0; x < width; ++x) {
        lower[x] += first[x];
        upper[x] += second[x];
      }
    }
    const double rows = existing(y, radius, job.out.height);
    const double full = (2.0 * radius + 1) * (2.0 * radius + 1);
    for (int x = 0; x < width; ++x) {
      const double count = rows * existing(x, radius, width);
      const double divisor = params_.count == Count::full ? full : count;
      const double mean = lower[x] / divisor;
      const double about = params_.spread == Spread::center ? double{color[x]} : mean;
      // Sum of (c - about)^2 over the pixels that exist; rounding may leave it below 0.
      const double squares = upper[x] - 2 * about * lower[x] + count * about * about;
      const double reach = params_.clamp_k * std::sqrt(std::max(squares, 0.0) / divisor);
      lower[x] = mean - reach;
      upper[x] = mean + reach;
    }
  }

  Params params_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::TemporalBlendPass, quell::Params)
