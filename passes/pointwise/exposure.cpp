// Auto-exposure: the factor that brings the mean of the logarithm of luminance to a key, followed over time.
// Source:  Reinhard et al., "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, equations 1 and 2: key over the
//          log-average of luminance. That adaptation takes time: Pattanaik et al., "Time-Dependent Visual Adaptation for Fast
//          Realistic Image Display", SIGGRAPH 2000, whose model of the eye is another one.
// Departs: the darkest and the brightest pixels are left out; luminance is counted in 64 steps a stop; adaptation is exponential,
//          in stops, and as fast to light as to darkness.
// Cost:    a dot product and a count a pixel.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "quell/sdk/pass.h"

namespace quell {
namespace {

struct Params {
  double key = 0.18, low = 5, high = 95, adaptation = 0;
  double min_stops = -20, max_stops = 20;
  void describe(auto&& field) {
    field("key", key, Range<double>{1e-6, 1e6}, "radiance", "What the log-average luminance becomes: 0.18 is middle gray.");
    field("low", low, Range<double>{0, 100}, "%",
          "The darkest pixels, up to this share of those that are not black, do not count.");
    field("high", high, Range<double>{0, 100}, "%", "The brightest pixels, from this share on, do not count.");
    field("adaptation", adaptation, Range<double>{0, 1e6}, "frames",
          "Time in which the distance to a new brightness shrinks to 1 / e; 0 follows at once.");
    field("min_stops", min_stops, Range<double>{-64, 64}, "stops", "Smallest exposure that is aimed at, log2.");
    field("max_stops", max_stops, Range<double>{-64, 64}, "stops", "Largest exposure that is aimed at, log2.");
  }
};

const PassInfo kInfo{
    .id = "exposure",
    .summary = "Auto-exposure: the factor that brings the log-average luminance to a key",
    .doc =
        "exposure = key / exp(mean of ln l) over the luminances l between the two percentiles, limited to 2^min_stops and "
        "2^max_stops. Pixels that are black, negative or not finite do not count. Each luminance counts as the middle of its "
        "step, of which a stop has 64: the mean errs by at most 1 / 64 stop, and does not depend on threads.\n\n"
        "With a previous exposure (this output, delayed by a frame), log2 of the result goes from that toward the aim by 1 - "
        "exp(-1 / adaptation) of the way. Where nothing counts, the previous exposure stays; without one it is 1.\n\n"
        "Exposures of tone mappers are in stops: log2 of this.",
    .source =
        "Reinhard et al., \"Photographic Tone Reproduction for Digital Images\", SIGGRAPH 2002, equations 1 and 2, key 0.18. "
        "That adaptation takes time: Pattanaik et al., \"Time-Dependent Visual Adaptation for Fast Realistic Image Display\", "
        "SIGGRAPH 2000. Departs: percentiles are left out, instead of a small number being added before the logarithm; one "
        "exponential in stops, where the eye adapts faster to light than to darkness.",
    .inputs = {{"color", kColor, "what is to be exposed"}, {"previous", kValue, "the exposure of the frame before", true}},
    .outputs = {{"exposure", kValue, "the factor, one number"}},
};

// A float's exponent and the first six bits of its fraction: 64 steps to each power of two. Positive finite floats have
// 255 * 64 of them.
constexpr int kDropped = 23 - 6;
constexpr std::size_t kSteps = 255 * 64;
constexpr int kRowsPerChunk = 64;  // so that adding up a chunk's counts costs little

std::size_t step_of(float luminance) { return std::bit_cast<std::uint32_t>(luminance) >> kDropped; }
// log2 of the middle of a step.
double middle(std::size_t step) {
  const auto bits = (static_cast<std::uint32_t>(step) << kDropped) | (1U << (kDropped - 1));
  return std::log2(double{std::bit_cast<float>(bits)});
}

class Exposure final : public Pass {
 public:
  explicit Exposure(const Params& params) : p_(params) {
    if (p_.low >= p_.high) throw std::runtime_error("low must be below high");
    if (p_.min_stops > p_.max_stops) throw std::runtime_error("min_stops must not be above max_stops");
  }

  void infer(Inference& inference) const override {
    inference.set_scratch(kSteps * sizeof(std::uint64_t));
    inference.set_slot_scratch(kSteps * sizeof(std::uint32_t));
  }

  void run(const Frame& frame) const override {
    const FloatImage color = frame.image("color");
    auto* counts = static_cast<std::uint64_t*>(frame.scratch());
    std::fill_n(counts, kSteps, std::uint64_t{0});
    frame.parallel_rows(
        color.height,
        [&](int y0, int y1, std::uint32_t slot) {
          auto* own = static_cast<std::uint32_t*>(frame.slot_scratch(slot));
          std::fill_n(own, kSteps, 0U);
          for (int y = y0; y < y1; ++y) count_row(color, y, own);
          // Whole numbers: the sum does not depend on the order.
          for (std::size_t i = 0; i < kSteps; ++i)
            if (own[i] > 0) std::atomic_ref(counts[i]).fetch_add(own[i], std::memory_order_relaxed);
        },
        kRowsPerChunk);
    const auto previous = frame.values("previous");
    frame.output_values("exposure")[0] = follow(aim(counts), previous.empty() ? 0.0 : previous[0]);
  }

 private:
  static void count_row(const FloatImage& color, int y, std::uint32_t* counts) {
    const float *r = color.row(y, 0), *g = color.row(y, 1), *b = color.row(y, 2);
    for (int x = 0; x < color.width; ++x) {
      const float l = 0.2126F * r[x] + 0.7152F * g[x] + 0.0722F * b[x];
      if (l > 0 && std::isfinite(l)) ++counts[step_of(l)];
    }
  }

  // log2 of the exposure; NaN where nothing counts. A step that a percentile cuts counts in part.
  double aim(const std::uint64_t* counts) const {
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < kSteps; ++i) total += counts[i];
    const double first = static_cast<double>(total) * p_.low / 100, last = static_cast<double>(total) * p_.high / 100;
    double sum = 0, weight = 0, before = 0;
    for (std::size_t i = 0; i < kSteps; ++i) {
      if (counts[i] == 0) continue;
      const double behind = before + static_cast<double>(counts[i]);
      const double part = std::max(std::min(behind, last) - std::max(before, first), 0.0);
      sum += part * middle(i), weight += part, before = behind;
    }
    return std::clamp(std::log2(p_.key) - sum / weight, p_.min_stops, p_.max_stops);
  }

  double follow(double aim, double previous) const {
    const bool has_previous = std::isfinite(previous) && previous > 0;
    if (std::isnan(aim)) return has_previous ? previous : 1;
    if (!has_previous || p_.adaptation <= 0) return std::exp2(aim);
    const double from = std::log2(previous);
    return std::exp2(from + (aim - from) * -std::expm1(-1 / p_.adaptation));
  }

  Params p_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::Exposure, quell::Params)
