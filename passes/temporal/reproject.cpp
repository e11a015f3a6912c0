// Fetches last frame's image from where each pixel's surface was seen then.
// Source:  the reverse reprojection cache (Nehab et al., Graphics Hardware 2007); the object test is that of GAMES202,
//          homework 5; taps that fail are left out as in SVGF (Schied et al., HPG 2017, temporal filtering).
// Departs: the homework fetches by truncation; here that is one choice, and bilinear with a test of every tap is the default.
// Cost:    4 gathered taps a channel (1 unless bilinear), and as many ids.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "quell/sdk/pass.h"

namespace quell {
namespace {

enum class Fetch { bilinear, nearest, truncate };

struct Params {
  Fetch fetch = Fetch::bilinear;
  void describe(auto&& field) {
    field("fetch", fetch,
          Choices{{"bilinear",
                   "the four pixels around the point; those that fail the test are left out and the weights renormalized"},
                  {"nearest", "the pixel that contains the point"},
                  {"truncate",
                   "the published listing: C's conversion to int, tested against the border afterwards. Like nearest, but "
                   "points up to one pixel off the left or upper border count as on it"}},
          "How the history is sampled.");
  }
};

const PassInfo kInfo{
    .id = "reproject",
    .summary = "Fetches the history from where each pixel was one frame ago",
    .doc =
        "Looks up, for pixel (x, y), the history at (x + 0.5, y + 0.5) + motion. A pixel has no history (valid 0, color 0) "
        "where that is off the screen or no number, where nothing was seen (id without object), where another object was seen "
        "(when both ids are given), and everywhere when the history is absent, as in the first frame.\n\n"
        "With bilinear, a point up to half a pixel off the screen still touches the border's pixels.",
    .source =
        "Nehab et al., \"Accelerating Real-Time Shading with Reverse Reprojection Caching\", Graphics Hardware 2007; object "
        "test and truncation: GAMES202, homework 5; taps left out: Schied et al., \"Spatiotemporal Variance-Guided "
        "Filtering\", HPG 2017, temporal filtering.",
    .inputs = {{"history", kAnyFloatImage, "an image of the previous frame", true},
               {"motion", kMotion, "previous minus current position, pixels, y down"},
               {"id", kId, "object of each pixel", true},
               {"previous_id", kId, "object of each pixel of the previous frame", true}},
    .outputs = {{.name = "color", .doc = "the history, moved to this frame's pixels; 0 where invalid", .same_as = "history"},
                {"valid", kMask, "1 where there is a history"}},
};

// One pixel's share in the result; none when the weight is 0.
struct Tap {
  std::ptrdiff_t offset = 0;
  double weight = 0;
};
using Taps = std::array<Tap, 4>;

struct Job {
  FloatImage history, motion;
  IdImage id, previous_id;
  FloatOutput color, valid;
  bool test_ids = false;
};

// A double that can be converted to int, and lies near enough to the screen to matter. False for NaN.
bool is_near(double coordinate, int size) { return coordinate > -2.0 && coordinate < size + 1.0; }

class ReprojectPass final : public Pass {
 public:
  explicit ReprojectPass(const Params& params) : fetch_(params.fetch) {}

  void infer(Inference& inference) const override {
    for (const char* output : {"color", "valid"}) inference.set_size(output, inference.size("motion"));
    for (const char* input : {"history", "previous_id"}) inference.set_unbounded(input);
  }

  void run(const Frame& frame) const override {
    Job job{frame.image("history"),   frame.image("motion"), frame.ids("id"),
            frame.ids("previous_id"), frame.output("color"), frame.output("valid")};
    job.test_ids = job.id && job.previous_id;
    frame.parallel_rows(job.valid.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y)
        for (int x = 0; x < job.valid.width; ++x) fetch_pixel(job, x, y);
    });
  }

 private:
  void fetch_pixel(const Job& job, int x, int y) const {
    Taps taps;
    const bool has_surface = !job.id || job.id.at(x, y) != QUELL_NO_ID;
    const double total = job.history && has_surface ? find_taps(job, x, y, taps) : 0;
    job.valid.at(x, y) = total > 0 ? 1.0F : 0.0F;
    for (int c = 0; c < job.color.channels; ++c) {
      // In double, so that the mean of equal values is that value, bit for bit.
      double sum = 0;
      for (const Tap& tap : taps)
        if (tap.weight > 0) sum += tap.weight * double{job.history.row(0, c)[tap.offset]};
      job.color.at(x, y, c) = total > 0 ? static_cast<float>(sum / total) : 0.0F;
    }
  }

  // Returns the sum of weights.
  double find_taps(const Job& job, int x, int y, Taps& taps) const {
    const double px = x + 0.5 + double{job.motion.at(x, y, 0)}, py = y + 0.5 + double{job.motion.at(x, y, 1)};
    if (!is_near(px, job.history.width) || !is_near(py, job.history.height)) return 0;
    const std::uint32_t id = job.test_ids ? job.id.at(x, y) : 0;
    const auto test = [&](int tx, int ty, double weight, Tap& tap) {
      if (!job.history.contains(tx, ty) || (job.test_ids && job.previous_id.at(tx, ty) != id)) return 0.0;
      tap = {ty * job.history.row_stride + tx, weight};
      return weight;
    };
    if (fetch_ == Fetch::truncate) return test(static_cast<int>(px), static_cast<int>(py), 1, taps[0]);
    if (fetch_ == Fetch::nearest) return test(static_cast<int>(std::floor(px)), static_cast<int>(std::floor(py)), 1, taps[0]);
    const double left = std::floor(px - 0.5), top = std::floor(py - 0.5);
    const double fx = px - 0.5 - left, fy = py - 0.5 - top;
    const int x0 = static_cast<int>(left), y0 = static_cast<int>(top);
    return test(x0, y0, (1 - fx) * (1 - fy), taps[0]) + test(x0 + 1, y0, fx * (1 - fy), taps[1]) +
           test(x0, y0 + 1, (1 - fx) * fy, taps[2]) + test(x0 + 1, y0 + 1, fx * fy, taps[3]);
  }

  Fetch fetch_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::ReprojectPass, quell::Params)
