// How fast normals turn from a pixel to the next: what a filter must tolerate on a curved surface.
//
// Source:  Falcor's SVGFPass: the length of fwidth(n), which is |dn/dx| + |dn/dy|, component by component.
//
// Departs: fwidth takes differences within 2 x 2 pixels, which straddle edges; here it is the shorter of the two one-sided ones.
//
// Cost:    some 40 operations a pixel; bound by memory.
#include <array>
#include <cmath>
#include <cstddef>

#include "quell/sdk/pass.h"

namespace quell {
namespace {

enum class Differences { smaller, central, quad };

struct Params {
  Differences differences = Differences::smaller;
  void describe(auto&& field) {
    field("differences", differences,
          Choices{{"smaller", "the shorter of those to the two neighbors: an edge of the surface does not count"},
                  {"central", "half of that from one neighbor to the other; where one does not count, that to the other"},
                  {"quad",
                   "that within the 2 x 2 pixels, from an even place on, that the pixel lies in: what ddx_fine and ddy_fine of a "
                   "GPU give"}},
          "Which differences are taken along each axis.");
  }
};

const PassInfo kInfo{
    .id = "normal_gradient",
    .summary = "How much normals change from a pixel to its neighbors",
    .doc =
        "gradient = the length of |dn/dx| + |dn/dy|, component by component. By default it is, along each axis, the shorter of "
        "the "
        "differences to "
        "the two neighbors; neighbors outside the image and without surface (normal 0) are left out. 0 where there is no "
        "surface.",
    .source =
        "Falcor's SVGFPass (the length of fwidth of the normal). Departs: one-sided differences instead of those within 2 x 2 "
        "pixels, which are a choice (HLSL's ddx_fine and ddy_fine).",
    .inputs = {{"normal", kNormal, "world-space normals"}},
    .outputs = {{"gradient", kScalar, "change of a unit vector a pixel"}}};

struct Vector {
  float x, y, z;
};

class NormalGradient final : public Pass {
 public:
  explicit NormalGradient(const Params& params) : differences_(params.differences) {}

  void infer(Inference& inference) const override {
    inference.set_by_rows();
    inference.set_radius("normal", 1);
  }

  void run(const Frame& frame) const override {
    const FloatImage normal = frame.image("normal");
    const FloatOutput out = frame.output("gradient");
    if (differences_ == Differences::central) return run_each(frame, normal, out, central_gradient);
    if (differences_ == Differences::quad) return run_each(frame, normal, out, quad_gradient);
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y) {
        const Neighbors vertical{normal, y > 0 ? y - 1 : y, y + 1 < normal.height ? y + 1 : y};
        for (int x = 1; x < normal.width - 1; ++x) out.row(y)[x] = gradient(vertical, y, x, x - 1, x + 1);
        for (const int x : {0, normal.width - 1})
          out.row(y)[x] = gradient(vertical, y, x, x > 0 ? x - 1 : x, x + 1 < normal.width ? x + 1 : x);
      }
    });
  }

 private:
  // The rows above and below; a row that is not there is the row itself, which counts as no neighbor.
  struct Neighbors {
    const FloatImage& normal;
    int above, below;
  };

  static Vector at(const FloatImage& normal, int x, int y) {
    const float* first = normal.row(y) + x;
    return {first[0], first[normal.plane_stride], first[2 * normal.plane_stride]};
  }
  static float dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

  // The shorter of two differences of normals, component by component without sign; 0 when neither neighbor counts.
  static Vector change(Vector n, Vector a, bool has_a, Vector b, bool has_b) {
    const Vector to_a{a.x - n.x, a.y - n.y, a.z - n.z}, to_b{b.x - n.x, b.y - n.y, b.z - n.z};
    const float length_a = has_a && dot(a, a) > 0 ? dot(to_a, to_a) : 1e30F;
    const float length_b = has_b && dot(b, b) > 0 ? dot(to_b, to_b) : 1e30F;
    const bool first = length_a <= length_b;
    const float keep = (first ? length_a : length_b) < 1e30F ? 1.0F : 0.0F;
    return {keep * std::abs(first ? to_a.x : to_b.x), keep * std::abs(first ? to_a.y : to_b.y),
            keep * std::abs(first ? to_a.z : to_b.z)};
  }

  static float length_of_sum(Vector n, Vector dx, Vector dy) {
    const Vector width{dx.x + dy.x, dx.y + dy.y, dx.z + dy.z};
    return dot(n, n) > 0 ? std::sqrt(dot(width, width)) : 0.0F;
  }

  static float gradient(const Neighbors& v, int y, int x, int left, int right) {
    const Vector n = at(v.normal, x, y);
    const Vector dx = change(n, at(v.normal, left, y), left != x, at(v.normal, right, y), right != x);
    const Vector dy = change(n, at(v.normal, x, v.above), v.above != y, at(v.normal, x, v.below), v.below != y);
    return length_of_sum(n, dx, dy);
  }

  template <class Gradient>
  static void run_each(const Frame& frame, const FloatImage& normal, const FloatOutput& out, const Gradient& gradient_at) {
    frame.parallel_rows(out.height, [&](int y0, int y1) {
      for (int y = y0; y < y1; ++y)
        for (int x = 0; x < out.width; ++x) out.at(x, y) = gradient_at(normal, x, y);
    });
  }

  static Vector normal_at(const FloatImage& normal, int x, int y) { return normal.contains(x, y) ? at(normal, x, y) : Vector{}; }

  static float central_gradient(const FloatImage& normal, int x, int y) {
    const Vector n = at(normal, x, y);
    const auto along = [&](Vector before, Vector after) {
      if (!(dot(before, before) > 0) || !(dot(after, after) > 0)) return change(n, before, true, after, true);
      return Vector{std::abs(after.x - before.x) / 2, std::abs(after.y - before.y) / 2, std::abs(after.z - before.z) / 2};
    };
    return length_of_sum(n, along(normal_at(normal, x - 1, y), normal_at(normal, x + 1, y)),
                         along(normal_at(normal, x, y - 1), normal_at(normal, x, y + 1)));
  }

  static float quad_gradient(const FloatImage& normal, int x, int y) {
    const Vector n = at(normal, x, y);
    const auto along = [&](Vector partner) { return change(n, partner, true, n, false); };
    return length_of_sum(n, along(normal_at(normal, x ^ 1, y)), along(normal_at(normal, x, y ^ 1)));
  }

  Differences differences_;
};

}  // namespace
}  // namespace quell

QUELL_REGISTER_PASS(quell::kInfo, quell::NormalGradient, quell::Params)
