// SVGF in Falcor's form (NVIDIA's SVGFPass; Schied et al., HPG 2017), pixel by pixel in double precision, from the formulas.
// Nothing of it is shared with the passes.
#pragma once

#include <array>
#include <vector>

#include "quell/sdk/types.h"

namespace quell::svgf_reference {

using Vec = std::array<double, 3>;

/// A picture of any kind of pixel.
template <class Pixel>
struct Plane {
  int width = 0, height = 0;
  std::vector<Pixel> pixels;

  Plane() = default;
  Plane(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  Pixel& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  const Pixel& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

/// What is known of a frame.
struct Frame {
  FloatImage color, albedo, emission, normal, depth, motion;
};

/// Falcor's defaults.
struct Settings {
  int levels = 4, feedback_level = 1;
  double phi_color = 10, phi_normal = 128;
  double alpha = 0.05, moments_alpha = 0.2;
  double max_length = 32, short_length = 4;
  double smallest_albedo = 1e-3;
};

/// Filters frames in their order.
class Svgf {
 public:
  explicit Svgf(const Settings& settings = {}) : settings_(settings) {}
  Plane<Vec> filter(const Frame& frame);

 private:
  /// What a frame leaves behind for the next.
  struct History {
    Plane<Vec> light, normal;
    Plane<double> first, second, length, depth;
  };
  /// A pixel's past; none when `found` is false.
  struct Past {
    bool found = false;
    Vec light{};
    double first = 0, second = 0, length = 0;
  };
  /// What is judged by: guides and how fast they change from pixel to pixel.
  struct Guides {
    Plane<double> depth, depth_change, normal_change;
    Plane<Vec> normal;
  };

  static Guides read_guides(const Frame& frame);
  Plane<Vec> demodulate(const Frame& frame) const;
  Past look_back(const Frame& frame, const Guides& guides, int x, int y) const;
  bool is_consistent(const Guides& guides, int x, int y, int tap_x, int tap_y) const;
  /// Where history is short, the light and its moments become those of the surrounding; returns the variance.
  Plane<double> estimate_variance(const Guides& guides, const History& now, Plane<Vec>& light) const;
  void filter_level(const Guides& guides, int level, Plane<Vec>& light, Plane<double>& variance) const;

  Settings settings_;
  History before_;
};

}  // namespace quell::svgf_reference
