// What the passes bilateral and joint_bilateral share: the filter over a square, or over a row and then over a column of it.
#pragma once

#include <utility>
#include <vector>

#include "passes/spatial/joint_bilateral_kernel.h"
#include "quell/sdk/frame.h"

namespace quell::joint_bilateral {

class Filter {
 public:
  /// `settings` without radii and distances in pixels; `distance_factor` is that of a squared distance in pixels.
  Filter(Settings settings, int radius, bool separable, double distance_factor) : separable_(separable) {
    if (separable)
      steps_ = {with_window(settings, radius, 0, distance_factor), with_window(settings, 0, radius, distance_factor)};
    else
      steps_ = {with_window(std::move(settings), radius, radius, distance_factor)};
  }

  int radius() const { return steps_.back().radius_y; }

  void infer(Inference& inference) const {
    inference.set_slot_scratch(scratch_bytes(radius()));
    const Size size = inference.size("color");
    if (separable_) inference.set_scratch(static_cast<std::size_t>(3 * row_stride(size.width) * size.height) * sizeof(float));
  }

  void run(const Frame& frame, const Images& in, const FloatOutput& out) const {
    if (!separable_) return run(frame, in, steps_[0], out);
    const std::ptrdiff_t stride = row_stride(out.width);
    const FloatOutput rows{out.width, out.height, 3, stride, stride * out.height, static_cast<float*>(frame.scratch())};
    run(frame, in, steps_[0], rows);
    run(frame, {rows, in.normal, in.position}, steps_[1], out);
  }

 private:
  static constexpr int kReadPastEnd = 16;  // floats, as of every image
  static std::ptrdiff_t row_stride(int width) { return (width + 2 * kReadPastEnd - 1) / kReadPastEnd * kReadPastEnd; }

  static Settings with_window(Settings settings, int radius_x, int radius_y, double factor) {
    settings.radius_x = radius_x, settings.radius_y = radius_y;
    for (int dy = 0; dy <= radius_y; ++dy)
      for (int dx = -radius_x; dx <= radius_x; ++dx)
        settings.pixel_distances.push_back(static_cast<float>(factor * (dx * dx + dy * dy)));
    return settings;
  }
  static void run(const Frame& frame, const Images& in, const Settings& settings, const FloatOutput& out) {
    frame.parallel_rows(out.height, [&](int y0, int y1, std::uint32_t slot) {
      filter_rows(in, settings, out, y0, y1, static_cast<float*>(frame.slot_scratch(slot)));
    });
  }

  bool separable_;
  std::vector<Settings> steps_;
};

}  // namespace quell::joint_bilateral
