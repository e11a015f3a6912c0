// Fetches images of the last frame from where each pixel's surface was seen then.
//
// Source:  the reverse reprojection cache (Nehab et al., Graphics Hardware 2007); taps that fail are left out, and 3 x 3 pixels
//          rescue what is left without any, as in SVGF (Schied et al., HPG 2017, temporal filtering); depth and normal are tested
//          as in Falcor's SVGFPass; the object test is that of GAMES202, homework 5.
//
// Departs: the homework fetches by truncation; here that is one choice, and bilinear with a test of every tap is the default.
//
// Cost:    4 taps a channel (1 for nearest, 16 for catmull_rom), and as many of each guide, once for all images; loaded as
//          vectors where neighbors moved together, else gathered.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "passes/temporal/reproject_kernel.h"
#include "quell/sdk/pass.h"

namespace quell {
namespace {

using reproject::Fetch;
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

using reproject::Images;
using reproject::Moved;

reproject::Settings make_settings(const Params& p) {
  return {.fetch = p.fetch,
          .rescue = p.rescue == Rescue::window,
          .min_weight = static_cast<float>(p.min_weight),
          .depth_slope = static_cast<float>(p.depth_slope),
          .depth_relative = static_cast<float>(p.depth_relative),
          .depth_absolute = static_cast<float>(p.depth_absolute),
          .normal_slope = static_cast<float>(p.normal_slope),
          .normal_absolute = static_cast<float>(p.normal_absolute),
          .plane_absolute = static_cast<float>(p.plane_absolute)};
}

class ReprojectPass final : public Pass {
 public:
  explicit ReprojectPass(const Params& params) : settings_(make_settings(params)) {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    for (std::size_t i = 0; i < inference.count("history"); ++i) inference.set_size("history", inference.size("motion"), i);
    for (const char* output : {"valid", "rejected"}) inference.set_size(output, inference.size("motion"));
    for (const char* input : {"history", "previous_id", "previous_depth", "previous_normal", "previous_position"})
      inference.set_unbounded(input);
    inference.set_slot_scratch(inference.count("history") * sizeof(Moved));
  }

  void run(const Frame& frame) const override {
    const Images in{frame.image("motion"),           frame.ids("id"),
                    frame.ids("previous_id"),        frame.image("depth"),
                    frame.image("previous_depth"),   frame.image("depth_gradient"),
                    frame.image("normal"),           frame.image("previous_normal"),
                    frame.image("normal_gradient"),  frame.image("position"),
                    frame.image("previous_position")};
    const FloatOutput valid = frame.output("valid"), rejected = frame.output("rejected");
    frame.parallel_rows(valid.height, [&](int y0, int y1, std::uint32_t slot) {
      const std::span<const Moved> history = collect(frame, static_cast<Moved*>(frame.slot_scratch(slot)));
      const bool has_history = !history.empty() && std::ranges::all_of(history, [](const Moved& image) { return !!image.from; });
      for (int y = y0; y < y1; ++y) {
        if (has_history)
          reproject_row(in, settings_, history, y, valid, rejected);
        else
          reproject_nothing(history, y, valid, rejected);
      }
    });
  }

 private:
  static std::span<const Moved> collect(const Frame& frame, Moved* images) {
    const std::size_t count = frame.count("history");
    for (std::size_t i = 0; i < count; ++i)
      std::construct_at(images + i, Moved{frame.image("history", i), frame.output("history", i)});
    return {images, count};
  }

  reproject::Settings settings_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::ReprojectPass, quell::Params)
