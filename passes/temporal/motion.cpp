// Makes quell's motion of the vectors that a renderer wrote: previous minus current position, pixels, y down, without jitter.
//
// Source:  arithmetic; the conventions are those that core/sequence converts when it reads files, by the same names.
//
// Cost:    a multiply-add in double for each of two channels; bound by memory.
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "passes/temporal/back_projection.h"
#include "quell/sdk/pass.h"
#include "quell/sdk/plain_loop.h"

namespace quell {
namespace {

enum class Sign { previous_minus_current, current_minus_previous };
enum class Unit { pixels, uv, ndc };
enum class YDirection { down, up };
enum class Jitter { excluded, included };

struct Params {
  Sign sign = Sign::previous_minus_current;
  Unit unit = Unit::pixels;
  YDirection y = YDirection::down;
  Jitter jitter = Jitter::excluded;
  double scale = 1;
  void describe(auto&& field) {
    field("sign", sign,
          Choices{{"previous-current", "the vectors point to where the surface was"},
                  {"current-previous", "the vectors point from where the surface was, as a velocity does"}},
          "Which position is subtracted from which.");
    field("unit", unit,
          Choices{{"pixels", "of this image"},
                  {"uv", "1 is the image's width, or height"},
                  {"ndc", "2 is the image's width, or height"}},
          "What the vectors are measured in.");
    field("y", y, Choices{{"down", "as in images"}, {"up", "as in mathematics"}}, "Where y grows.");
    field("jitter", jitter,
          Choices{{"excluded", "what stands still before a camera that stands still has no motion"},
                  {"included", "the vectors hold the difference of both frames' jitter, which the cameras tell"}},
          "Whether the difference of the two frames' jitter has to be taken out.");
    field("scale", scale, Range<double>{-1e6, 1e6}, "1", "Factor of the vectors, for any other unit.");
  }
};

const PassInfo kInfo{
    .id = "motion",
    .summary = "Makes motion of a renderer's vectors, whatever their sign, unit and direction",
    .doc =
        "motion = scale unit sign (x, y down) - (previous jitter - jitter). The sequence reader converts an input of type motion "
        "by itself, when it is told the conventions; this pass is for vectors that come to the graph as they are, and for those "
        "that a pass has made. Of images with more than two channels, the first two are the vectors.\n\n"
        "Pixels that `valid` marks as 0, vectors that are no numbers, and those of more than 1e6 pixels have motion (1e6, 1e6), "
        "which is off any screen.\n\n"
        "Cameras are needed with jitter 'included', and not looked at otherwise. A frame without a camera counts as one without "
        "jitter. Jitter of cameras of another resolution than the image is scaled to it.",
    .source = "arithmetic",
    .inputs = {{"vectors", kMotion | kColor | kNormal | kPosition, "what the renderer wrote: x, then y"},
               {"valid", kMask, "0 where a vector has no meaning", true},
               {"camera", kCamera, "the camera of this frame", true},
               {"previous_camera", kCamera, "the camera of the previous frame", true}},
    .outputs = {{"motion", kMotion, "previous minus current position, pixels, y down"}},
};

using back_projection::kFarAway;

// Of an axis, in pixels of the image.
double jitter_of(const quell_camera* camera, int axis, int size) {
  return camera ? camera->jitter[axis] * back_projection::pixel_scale(*camera, axis, size) : 0;
}

// The comparison is false for NaN.
float near_or(double value, double other) {
  return std::abs(value) <= kFarAway && std::abs(other) <= kFarAway ? static_cast<float>(value) : kFarAway;
}

class MotionPass final : public Pass {
 public:
  explicit MotionPass(const Params& params) : params_(params) {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    const bool cameras = inference.present("camera") && inference.present("previous_camera");
    if (params_.jitter == Jitter::included && !cameras)
      throw std::runtime_error("jitter 'included' needs 'camera' and 'previous_camera', which tell the jitter");
    if (inference.type("vectors") == QUELL_TYPE_MOTION) inference.set_in_place("motion", "vectors");
  }

  void run(const Frame& frame) const override {
    const FloatImage vectors = frame.image("vectors"), valid = frame.image("valid");
    const FloatOutput motion = frame.output("motion");
    const std::array<double, 2> scale = scale_to_pixels(motion.width, motion.height);
    std::array<double, 2> offset{};
    if (params_.jitter == Jitter::included)
      for (int axis : {0, 1}) {
        const int size = axis == 0 ? motion.width : motion.height;
        offset[static_cast<std::size_t>(axis)] =
            jitter_of(frame.camera("camera"), axis, size) - jitter_of(frame.camera("previous_camera"), axis, size);
      }
    frame.parallel_rows(motion.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) {
        convert_row(vectors.row(y, 0), vectors.row(y, 1), scale, offset, motion.width, motion.row(y, 0), motion.row(y, 1));
        if (valid) send_away(valid.row(y), motion.width, motion.row(y, 0), motion.row(y, 1));
      }
    });
  }

 private:
  std::array<double, 2> scale_to_pixels(int width, int height) const {
    const double sign = params_.sign == Sign::previous_minus_current ? params_.scale : -params_.scale;
    std::array<double, 2> scale{sign, params_.y == YDirection::down ? sign : -sign};
    if (params_.unit == Unit::pixels) return scale;
    const double across = params_.unit == Unit::uv ? 1 : 2;
    return {scale[0] * width / across, scale[1] * height / across};
  }

  // The vectors may lie where the motion is written.
  QUELL_PLAIN_LOOP static void convert_row(const float* from_x, const float* from_y, const std::array<double, 2>& scale,
                                           const std::array<double, 2>& offset, int width, float* to_x, float* to_y) {
    for (int x = 0; x < width; ++x) {
      const double dx = scale[0] * double{from_x[x]} + offset[0], dy = scale[1] * double{from_y[x]} + offset[1];
      to_x[x] = near_or(dx, dy);
      to_y[x] = near_or(dy, dx);
    }
  }

  QUELL_PLAIN_LOOP static void send_away(const float* valid, int width, float* __restrict to_x, float* __restrict to_y) {
    for (int x = 0; x < width; ++x) {
      to_x[x] = valid[x] > 0 ? to_x[x] : kFarAway;
      to_y[x] = valid[x] > 0 ? to_y[x] : kFarAway;
    }
  }

  Params params_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::MotionPass, quell::Params)
