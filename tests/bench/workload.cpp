#include "tests/bench/workload.h"

#include <algorithm>
#include <chrono>

namespace quell::bench {
namespace {

std::vector<Float3> interleave(const Image& image) {
  const FloatImage planes = image.floats();
  std::vector<Float3> pixels;
  pixels.reserve(static_cast<std::size_t>(planes.width) * static_cast<std::size_t>(planes.height));
  for (int y = 0; y < planes.height; ++y)
    for (int x = 0; x < planes.width; ++x) pixels.push_back({planes.at(x, y, 0), planes.at(x, y, 1), planes.at(x, y, 2)});
  return pixels;
}

std::vector<float> flatten(const Image& image) {
  const FloatImage plane = image.floats();
  std::vector<float> pixels;
  for (int y = 0; y < plane.height; ++y) pixels.insert(pixels.end(), plane.row(y), plane.row(y) + plane.width);
  return pixels;
}

/// Taps of a window, `step` apart, that lie in a row of `length` pixels, for all its pixels together.
double taps_of_row(int length, int radius, int step) {
  double taps = 0;
  for (int x = 0; x < length; ++x) taps += std::min((length - 1 - x) / step, radius) + std::min(x / step, radius) + 1;
  return taps;
}

}  // namespace

PassSetup joint_bilateral_setup(const BenchFrame& frame, int radius) {
  return {.pass = "joint_bilateral",
          .params = R"({"radius": )" + std::to_string(radius) + "}",
          .inputs = {{"color", frame.color}, {"normal", frame.normal}, {"position", frame.position}}};
}

Work joint_bilateral_work(Size size, int radius) {
  const double pixels = static_cast<double>(size.width) * size.height;
  const double taps = taps_of_row(size.width, radius, 1) * taps_of_row(size.height, radius, 1);
  return {pixels, taps, taps, 12 * sizeof(float) * pixels};
}

InterleavedFrame interleave(const BenchFrame& frame) {
  return {frame.color.width(), frame.color.height(), interleave(frame.color), interleave(frame.normal),
          interleave(frame.position)};
}

PassSetup atrous_setup(const BenchFrame& frame, int level) {
  return {.pass = "atrous",
          .params = R"({"stops": "svgf", "level": )" + std::to_string(level) + "}",
          .inputs = {{"color", frame.color}, {"normal", frame.normal}, {"depth", frame.depth}, {"variance", frame.variance}},
          .outputs = {"color", "variance"}};
}

Work atrous_work(Size size, int level) {
  const double pixels = static_cast<double>(size.width) * size.height;
  return {pixels, taps_of_row(size.width, 2, 1 << level) * taps_of_row(size.height, 2, 1 << level), pixels,
          12 * sizeof(float) * pixels};
}

AtrousFrame interleave_for_atrous(const BenchFrame& frame) {
  return {frame.color.width(),      frame.color.height(), interleave(frame.color),
          interleave(frame.normal), flatten(frame.depth), flatten(frame.variance)};
}

double time_call(const std::function<void()>& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace quell::bench
