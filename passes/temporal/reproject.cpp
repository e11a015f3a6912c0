// Fetches images of the last frame from where each pixel's surface was seen then.
//
// Source:  the reverse reprojection cache (Nehab et al., Graphics Hardware 2007); taps that fail are left out, and 3 x 3 pixels
//          rescue what is left without any, as in SVGF (Schied et al., HPG 2017, temporal filtering); depth and normal are tested
//          as in Falcor's SVGFPass; the object test is that of GAMES202, homework 5.
//
// Departs: the homework fetches by truncation; here that is one choice, and bilinear with a test of every tap is the default.
//
// Cost:    4 gathered taps a channel (1 for nearest, 16 for catmull_rom), and as many of each guide, once for all images.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "quell/sdk/pass.h"

namespace quell {
namespace {

enum class Fetch { bilinear, nearest, truncate, catmull_rom };
enum class Rescue { none, window };

struct Params {
  Fetch fetch = Fetch::bilinear;
  double min_weight = 0.01;
  Rescue rescue = Rescue::none;
  double depth_slope = 10, depth_relative = 0.02, depth_absolute = 0;
  double normal_slope = 0, normal_absolute = 0.5;
  double plane_absolute = 0.05;
  void describe(auto&& field) {
    field("fetch", fetch,
          Choices{
              {"bilinear", "the four pixels around the point; those that fail a test are left out and the weights renormalized"},
              {"nearest", "the pixel that contains the point"},
              {"truncate",
               "the published listing: C's conversion to int, tested against the border afterwards. Like nearest, but "
               "points up to one pixel off the left or upper border count as on it"},
              {"catmull_rom",
               "sixteen pixels, which keeps more detail over many frames, limited to the range of the four in the middle; "
               "bilinear where one of them fails a test"}},
          "How the history is sampled.");
    field("min_weight", min_weight, Range<double>{0, 1}, "1", "With less than this left of the weights there is no history.");
    field(
        "rescue", rescue,
        Choices{{"none", "nothing"}, {"3x3", "the mean of those of the 3 x 3 pixels around the nearest one that pass all tests"}},
        "What is tried where no history is found.");
    field("depth_slope", depth_slope, Range<double>{0, 1e6}, "px", "Tolerated difference in depth, over depth_gradient.");
    field("depth_relative", depth_relative, Range<double>{0, 1e6}, "1", "Tolerated difference in depth, over the depth; added.");
    field("depth_absolute", depth_absolute, Range<double>{0, 1e6}, "world units", "Tolerated difference in depth; added.");
    field("normal_slope", normal_slope, Range<double>{0, 1e6}, "px", "Tolerated difference of normals, over normal_gradient.");
    field("normal_absolute", normal_absolute, Range<double>{0, 1e6}, "1",
          "Tolerated difference of normals; added. 2 is that of opposite ones.");
    field("plane_absolute", plane_absolute, Range<double>{0, 1e6}, "world units",
          "Tolerated distance of the tap's position from the pixel's tangent plane.");
  }
};

const PassInfo kInfo{
    .id = "reproject",
    .version = 2,
    .oldest_version = 2,
    .summary = "Fetches the history from where each pixel was one frame ago",
    .doc =
        "Looks up, for pixel (x, y), each image of the history at (x + 0.5, y + 0.5) + motion. All images share tests and "
        "weights. A "
        "pixel has no history (valid 0, all images 0) where that is off the screen or no number, where nothing was seen (id "
        "without "
        "object), where no tap passes, and everywhere while an image of the history is absent, as in the first frame.\n\n"
        "A tap passes when it lies in the image and, for each pair of guides that is given, when it has the same id; |z - z'| <= "
        "depth_slope depth_gradient + depth_relative z + depth_absolute; |n - n'| <= normal_slope normal_gradient + "
        "normal_absolute; "
        "|n.(p - p')| <= plane_absolute. Gradients that are absent are 0. What stands at the pixel is compared with what stood "
        "at the "
        "tap: where a surface moves toward the camera, connect the depth and position that it had one frame ago.\n\n"
        "With bilinear, a point up to half a pixel off the screen still touches the border's pixels. `rejected` is the share of "
        "the "
        "weights that failed.",
    .source =
        "Nehab et al., \"Accelerating Real-Time Shading with Reverse Reprojection Caching\", Graphics Hardware 2007. Taps left "
        "out, "
        "and 3x3: Schied et al., \"Spatiotemporal Variance-Guided Filtering\", HPG 2017, temporal filtering. Depth and normal: "
        "Falcor's "
        "SVGFPass, which has depth_slope 10, depth_relative 0, depth_absolute 0.1, normal_slope 16, normal_absolute 0.16. Object "
        "test "
        "and truncation: GAMES202, homework 5. Catmull-Rom limited to its middle: Karis, \"High-Quality Temporal "
        "Supersampling\", "
        "SIGGRAPH 2014, course.",
    .inputs =
        {{.name = "history", .types = kAnyFloatImage, .doc = "images of the previous frame", .optional = true, .array = true},
         {"motion", kMotion, "previous minus current position, pixels, y down"},
         {"id", kId, "object of each pixel", true},
         {"previous_id", kId, "object of each pixel of the previous frame", true},
         {"depth", kDepth, "depth of each pixel", true},
         {"previous_depth", kDepth, "depth of each pixel of the previous frame", true},
         {"depth_gradient", kScalar, "change of depth a pixel", true},
         {"normal", kNormal, "normal of each pixel", true},
         {"previous_normal", kNormal, "normal of each pixel of the previous frame", true},
         {"normal_gradient", kScalar, "change of the normal a pixel", true},
         {"position", kPosition, "position of each pixel", true},
         {"previous_position", kPosition, "position of each pixel of the previous frame", true}},
    .outputs = {{.name = "history",
                 .doc = "the history, moved to this frame's pixels; 0 where invalid",
                 .array = true,
                 .same_as = "history"},
                {"valid", kMask, "1 where there is a history"},
                {"rejected", kScalar, "0 to 1: how much of the history failed the tests"}},
};

// One pixel's share in the result.
struct Tap {
  std::ptrdiff_t offset;
  double weight;
};

// The taps of a pixel; none when there is no history.
struct Taps {
  static constexpr int kMost = 16;
  int count = 0;
  bool limited = false;  // catmull_rom, whose four taps in the middle come first
  std::array<Tap, kMost> taps;

  void add(std::ptrdiff_t offset, double weight) { taps[static_cast<std::size_t>(count++)] = {offset, weight}; }
  void normalize() {
    double total = 0;
    for (const Tap& tap : all()) total += tap.weight;
    const double scale = count > 0 ? 1 / total : 0;
    for (int i = 0; i < count; ++i) taps[static_cast<std::size_t>(i)].weight *= scale;
  }
  std::span<const Tap> all() const { return {taps.data(), static_cast<std::size_t>(count)}; }
};

struct Job {
  FloatImage motion;
  IdImage id, previous_id;
  FloatImage depth, previous_depth, depth_gradient, normal, previous_normal, normal_gradient, position, previous_position;
  FloatOutput valid, rejected;
  int width = 0, height = 0;  // of the history
  std::ptrdiff_t row_stride = 0;
};

struct Vector {
  float x = 0, y = 0, z = 0;
};

Vector at(const FloatImage& image, int x, int y) {
  const float* first = image.row(y) + x;
  return {first[0], first[image.plane_stride], first[2 * image.plane_stride]};
}
Vector minus(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
float dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// What the taps of a pixel are tested by.
struct Pixel {
  std::uint32_t id = 0;
  float depth = 0, depth_tolerance = 0, normal_tolerance = 0;
  Vector normal{}, position{};
};

// A double that can be converted to int, and lies near enough to the screen to matter. False for NaN.
bool is_near(double coordinate, int size) { return coordinate > -2.0 && coordinate < size + 1.0; }

// Catmull and Rom's spline at the four pixels around a point that lies `f` behind the second.
std::array<double, 4> catmull_rom(double f) {
  return {f * (-0.5 + f * (1 - 0.5 * f)), 1 + f * f * (-2.5 + 1.5 * f), f * (0.5 + f * (2 - 1.5 * f)), f * f * (-0.5 + 0.5 * f)};
}

class ReprojectPass final : public Pass {
 public:
  explicit ReprojectPass(const Params& params) : params_(params) {}

  void infer(Inference& inference) const override {
    for (std::size_t i = 0; i < inference.count("history"); ++i) inference.set_size("history", inference.size("motion"), i);
    for (const char* output : {"valid", "rejected"}) inference.set_size(output, inference.size("motion"));
    for (const char* input : {"history", "previous_id", "previous_depth", "previous_normal", "previous_position"})
      inference.set_unbounded(input);
    inference.set_slot_scratch(kPixels * sizeof(Taps));
  }

  void run(const Frame& frame) const override {
    const FloatImage motion = frame.image("motion");
    Job job{motion,
            frame.ids("id"),
            frame.ids("previous_id"),
            frame.image("depth"),
            frame.image("previous_depth"),
            frame.image("depth_gradient"),
            frame.image("normal"),
            frame.image("previous_normal"),
            frame.image("normal_gradient"),
            frame.image("position"),
            frame.image("previous_position"),
            frame.output("valid"),
            frame.output("rejected")};
    bool has_history = frame.count("history") > 0;
    for (std::size_t i = 0; i < frame.count("history"); ++i) has_history = has_history && frame.has("history", i);
    if (has_history) {
      const FloatImage first = frame.image("history");
      job.width = first.width, job.height = first.height, job.row_stride = first.row_stride;
    }
    frame.parallel_rows(job.valid.height, [&](int y0, int y1, std::uint32_t slot) {
      Taps* taps = static_cast<Taps*>(frame.slot_scratch(slot));
      for (int y = y0; y < y1; ++y)
        for (int x = 0; x < job.valid.width; x += kPixels) {
          const int end = std::min(x + kPixels, job.valid.width);
          find_taps(job, has_history, x, end, y, taps);
          for (std::size_t i = 0; i < frame.count("history"); ++i)
            if (const FloatOutput out = frame.output("history", i))
              fetch_pixels(taps, frame.image("history", i), job.row_stride, x, end, y, out);
        }
    });
  }

 private:
  static constexpr int kPixels = 64;  // whose taps are found before any is fetched; they fit the first cache

  void find_taps(const Job& job, bool has_history, int x0, int x1, int y, Taps* taps) const {
    for (int x = x0; x < x1; ++x, ++taps) {
      taps->count = 0, taps->limited = false;
      job.rejected.at(x, y) = has_history ? static_cast<float>(find_taps(job, x, y, *taps)) : 1.0F;
      job.valid.at(x, y) = taps->count > 0 ? 1.0F : 0.0F;
      taps->normalize();
    }
  }

  static void fetch_pixels(const Taps* taps, const FloatImage& history, std::ptrdiff_t row_stride, int x0, int x1, int y,
                           const FloatOutput& out) {
    const int count = x1 - x0;
    for (int c = 0; c < out.channels; ++c) {
      float* to = out.row(y, c) + x0;
      if (!history) {
        std::fill_n(to, count, 0.0F);
      } else if (const float* plane = history.row(0, c); history.row_stride == row_stride) {
        for (int i = 0; i < count; ++i) to[i] = fetch(taps[i], [=](std::ptrdiff_t offset) { return plane[offset]; });
      } else {  // offsets were found for another stride
        const std::ptrdiff_t own = history.row_stride;
        for (int i = 0; i < count; ++i)
          to[i] = fetch(taps[i], [=](std::ptrdiff_t offset) { return plane[offset / row_stride * own + offset % row_stride]; });
      }
    }
  }

  // In double, so that the mean of equal values is that value, bit for bit: weights add up to 1 but for some 1e-16.
  template <class At>
  static float fetch(const Taps& taps, const At& at) {
    double sum = 0;
    for (const Tap& tap : taps.all()) sum += tap.weight * double{at(tap.offset)};
    const float value = static_cast<float>(sum);
    if (!taps.limited) return value;
    float lower = at(taps.taps[0].offset), upper = lower;
    for (std::size_t i = 1; i < 4; ++i) {
      lower = std::min(lower, at(taps.taps[i].offset));
      upper = std::max(upper, at(taps.taps[i].offset));
    }
    return std::min(std::max(value, lower), upper);
  }

  Pixel pixel(const Job& job, int x, int y) const {
    Pixel p;
    if (job.id && job.previous_id) p.id = job.id.at(x, y);
    if (job.depth && job.previous_depth) {
      p.depth = job.depth.at(x, y);
      const double gradient = job.depth_gradient ? job.depth_gradient.at(x, y) : 0;
      p.depth_tolerance = static_cast<float>(params_.depth_slope * gradient + params_.depth_relative * std::abs(p.depth) +
                                             params_.depth_absolute);
    }
    if (job.normal) p.normal = at(job.normal, x, y);
    const double turn = job.normal_gradient ? job.normal_gradient.at(x, y) : 0;
    p.normal_tolerance = static_cast<float>(params_.normal_slope * turn + params_.normal_absolute);
    if (job.position) p.position = at(job.position, x, y);
    return p;
  }

  // Written so that what is not a number fails.
  bool passes(const Job& job, const Pixel& p, int tx, int ty) const {
    if (tx < 0 || ty < 0 || tx >= job.width || ty >= job.height) return false;
    if (job.id && job.previous_id && job.previous_id.at(tx, ty) != p.id) return false;
    if (job.depth && job.previous_depth && !(std::abs(job.previous_depth.at(tx, ty) - p.depth) <= p.depth_tolerance))
      return false;
    if (job.normal && job.previous_normal) {
      const Vector turn = minus(p.normal, at(job.previous_normal, tx, ty));
      if (!(dot(turn, turn) <= p.normal_tolerance * p.normal_tolerance)) return false;
    }
    if (job.normal && job.position && job.previous_position) {
      const float height = dot(p.normal, minus(p.position, at(job.previous_position, tx, ty)));
      if (!(std::abs(height) <= params_.plane_absolute)) return false;
    }
    return true;
  }

  // Returns the share of the weights that failed.
  double find_taps(const Job& job, int x, int y, Taps& taps) const {
    if (job.id && job.id.at(x, y) == QUELL_NO_ID) return 1;
    const double px = x + 0.5 + double{job.motion.at(x, y, 0)}, py = y + 0.5 + double{job.motion.at(x, y, 1)};
    if (!is_near(px, job.width) || !is_near(py, job.height)) return 1;
    const Pixel p = pixel(job, x, y);
    double left = 0;
    const auto take = [&](int tx, int ty, double weight) {
      if (!(weight > 0) || !passes(job, p, tx, ty)) return;
      taps.add(ty * job.row_stride + tx, weight);
      left += weight;
    };
    const int near_x = static_cast<int>(std::floor(px)), near_y = static_cast<int>(std::floor(py));
    if (params_.fetch == Fetch::truncate) {
      take(static_cast<int>(px), static_cast<int>(py), 1);
    } else if (params_.fetch == Fetch::nearest) {
      take(near_x, near_y, 1);
    } else {
      const double floor_x = std::floor(px - 0.5), floor_y = std::floor(py - 0.5);
      const double fx = px - 0.5 - floor_x, fy = py - 0.5 - floor_y;
      const int x0 = static_cast<int>(floor_x), y0 = static_cast<int>(floor_y);
      if (params_.fetch == Fetch::catmull_rom && take_catmull_rom(job, p, x0, y0, fx, fy, taps)) return 0;
      take(x0, y0, (1 - fx) * (1 - fy));
      take(x0 + 1, y0, fx * (1 - fy));
      take(x0, y0 + 1, (1 - fx) * fy);
      take(x0 + 1, y0 + 1, fx * fy);
    }
    const double rejected = std::min(std::max(1 - left, 0.0), 1.0);
    if (left >= params_.min_weight && left > 0) return rejected;
    taps.count = 0;
    if (params_.rescue == Rescue::window)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) take(near_x + dx, near_y + dy, 1);
    return rejected;
  }

  // False, without taps, when one of the sixteen fails.
  bool take_catmull_rom(const Job& job, const Pixel& p, int x0, int y0, double fx, double fy, Taps& taps) const {
    const std::array<double, 4> wx = catmull_rom(fx), wy = catmull_rom(fy);
    for (const bool middle : {true, false})
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
          if (((i == 1 || i == 2) && (j == 1 || j == 2)) != middle) continue;
          if (!passes(job, p, x0 - 1 + i, y0 - 1 + j)) return taps.count = 0, false;
          taps.add((y0 - 1 + j) * job.row_stride + x0 - 1 + i, wx[static_cast<std::size_t>(i)] * wy[static_cast<std::size_t>(j)]);
        }
    return taps.limited = true;
  }

  Params params_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::ReprojectPass, quell::Params)
