// Pictures for the tests of FLIP.
#pragma once

#include <array>
#include <functional>

#include "quell/image/image.h"
#include "quell/metrics/flip.h"

namespace quell::flip_test {

using Vec = std::array<double, 3>;

Image make_picture(Size size, const std::function<Vec(int x, int y)>& color, int spare_lines = 0);
Image make_plane(Size size, const std::function<float(int x, int y)>& value, int spare_lines = 0);
Image flat(Size size, const Vec& color);
/// Edges, flat areas, smooth shading and noise, all within 0..1 but for a few that are brighter or negative.
Image make_scene(Size size, int spare_lines = 0);
/// The scene as a renderer would err: noise, a shifted part, a tint, and a part that is right.
Image make_wrong_scene(Size size, int spare_lines = 0);

struct Result {
  Score score;
  Image map;
};
Result run_flip(const Image& reference, const Image& image, double pixels_per_degree = kPixelsPerDegree, const Image& counts = {},
                const Parallel& parallel = run_serially);
Result run_hdr_flip(const Image& reference, const Image& image, const Exposures& exposures,
                    double pixels_per_degree = kPixelsPerDegree, const Parallel& parallel = run_serially);
double mean(const Score& score);
bool same_bits(const Image& a, const Image& b);

}  // namespace quell::flip_test
