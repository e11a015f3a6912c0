#include "quell/sequence/checks/picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "quell/sequence/checks/geometry.h"
#include "quell/sequence/checks/statistics.h"
#include "quell/sequence/image_writer.h"

namespace quell {
namespace {

constexpr int kLargest = 480, kSmallest = 240;  // width of a panel
constexpr Rgb kNothing{70, 70, 74};             // where there is no surface, or nothing was tested
using Paint = std::function<Rgb(int x, int y)>;

/// From the panel's pixels to those of the image.
struct Scaling {
  Size image, panel;
  int column(int x) const { return static_cast<int>(std::int64_t{x} * image.width / panel.width); }
  int row(int y) const { return static_cast<int>(std::int64_t{y} * image.height / panel.height); }
};

Raster paint(const Scaling& scaling, const Paint& color) {
  Raster raster(scaling.panel.width, scaling.panel.height);
  for (int y = 0; y < raster.height; ++y)
    for (int x = 0; x < raster.width; ++x) raster.at(x, y) = color(scaling.column(x), scaling.row(y));
  return raster;
}

std::uint8_t byte(double value) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

/// Hue 0 to 1, full saturation.
Rgb hue_color(double hue, double brightness) {
  const auto wave = [&](double offset) {
    const double t = std::fmod(hue + offset + 1, 1.0) * 6;
    return byte(brightness * std::clamp(std::abs(t - 3) - 1, 0.0, 1.0));
  };
  return {wave(0), wave(2.0 / 3), wave(1.0 / 3)};
}

/// Black, blue, magenta, orange, yellow: brighter all the way.
Rgb heat(double t) {
  static constexpr double kStops[5][3] = {{0, 0, 0}, {0.15, 0.1, 0.55}, {0.75, 0.1, 0.5}, {1, 0.5, 0.1}, {1, 1, 0.5}};
  const double place = std::clamp(t, 0.0, 1.0) * 4;
  const int stop = std::min(static_cast<int>(place), 3);
  Rgb color;
  for (std::size_t c = 0; c < 3; ++c) color[c] = byte(kStops[stop][c] + (place - stop) * (kStops[stop + 1][c] - kStops[stop][c]));
  return color;
}

Distribution spread(const FloatImage& image, int channel, const std::function<bool(int, int)>& counts) {
  Distribution values;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (const float value = image.at(x, y, channel); std::isfinite(value) && counts(x, y)) values.add(value);
  return values;
}

bool everywhere(int, int) { return true; }

Paint paint_color(const FloatImage& image) {
  Distribution luminance;
  for (int c = 0; c < image.channels; ++c)
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (const float value = image.at(x, y, c); std::isfinite(value)) luminance.add(std::max(value, 0.0F));
  const double middle = std::max(luminance.median(), 0.02 * luminance.quantile(0.99));
  const double exposure = middle > 0 ? 0.3 / middle : 1;
  return [image, exposure](int x, int y) {
    Rgb color;
    for (int c = 0; c < 3; ++c) {
      const double value = exposure * std::max(0.0F, image.at(x, y, c));
      color[static_cast<std::size_t>(c)] = std::isfinite(value) ? to_srgb8(static_cast<float>(value / (0.7 + value))) : 255;
    }
    return color;
  };
}

/// Each plane from its smallest number on surfaces to its largest, strays left out; gray for one plane.
Paint paint_range(const FloatImage& image, const std::function<bool(int, int)>& counts, std::string& note) {
  std::vector<std::pair<double, double>> ranges;
  for (int c = 0; c < image.channels; ++c) {
    const Distribution values = spread(image, c, counts);
    ranges.emplace_back(values.quantile(0.01), values.quantile(0.99));
    note += (c == 0 ? "" : ",  ") + short_number(ranges.back().first) + " to " + short_number(ranges.back().second);
  }
  return [image, counts, ranges](int x, int y) {
    if (!counts(x, y)) return kNothing;
    Rgb color;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t plane = std::min(c, ranges.size() - 1);
      const auto [low, high] = ranges[plane];
      color[c] = byte(high > low ? (image.at(x, y, static_cast<int>(plane)) - low) / (high - low) : 0.5);
    }
    return color;
  };
}

Paint paint_normals(const FloatImage& image) {
  return [image](int x, int y) {
    const Vec3 n = vector_at(image, x, y);
    if (!is_finite(n) || dot(n, n) == 0) return kNothing;
    return Rgb{byte((n.x + 1) / 2), byte((n.y + 1) / 2), byte((n.z + 1) / 2)};
  };
}

Paint paint_ids(const IdImage& ids) {
  return [ids](int x, int y) {
    const std::uint32_t id = ids.at(x, y);
    if (id == QUELL_NO_ID) return kNothing;
    // Multiples of the golden ratio spread hues evenly, however many there are.
    return hue_color(std::fmod(id * 0.6180339887498949, 1.0), 0.55 + 0.45 * ((id * 7) % 5) / 4.0);
  };
}

Paint paint_motion(const FloatImage& motion, std::string& note) {
  Distribution lengths;
  for (int y = 0; y < motion.height; ++y)
    for (int x = 0; x < motion.width; ++x)
      if (const double length = std::hypot(motion.at(x, y, 0), motion.at(x, y, 1)); std::isfinite(length)) lengths.add(length);
  const double longest = std::max(lengths.quantile(0.99), 1e-6);
  note = "brightest: " + pixels(longest) + "; the hue says where to";
  return [motion, longest](int x, int y) {
    const double dx = motion.at(x, y, 0), dy = motion.at(x, y, 1);
    if (!std::isfinite(dx) || !std::isfinite(dy)) return Rgb{255, 255, 255};
    return hue_color(std::atan2(-dy, dx) / (2 * std::numbers::pi), std::min(1.0, std::hypot(dx, dy) / longest));
  };
}

/// Hues of the directions, in the panel's corner.
void draw_wheel(Raster& raster) {
  const int radius = std::min(raster.width, raster.height) / 10;
  if (radius < 1) return;  // a strip, in which there is no place for it
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x)
      if (const double length = std::hypot(x, y); length <= radius)
        raster.at(raster.width - radius - 4 + x, raster.height - radius - 4 + y) =
            hue_color(std::atan2(-y, x) / (2 * std::numbers::pi), length / radius);
}

Panel make_input_panel(const CheckedImage& input, const FrameData& frame, Size panel) {
  Panel result;
  const Image& image = input.image;
  const PortType type = image.type();
  result.title = input.name + (input.name == name(type) ? "" : " (" + std::string(name(type)) + ")");
  const auto has_surface = [surfaces = std::make_shared<const Surfaces>(frame, image.size())](int x, int y) {
    return surfaces->has(x, y);
  };
  Paint color;
  if (type == QUELL_TYPE_ID)
    color = paint_ids(image.ids());
  else if (type == QUELL_TYPE_COLOR || type == QUELL_TYPE_ALBEDO)
    color = paint_color(image.floats());
  else if (type == QUELL_TYPE_NORMAL)
    color = paint_normals(image.floats());
  else if (type == QUELL_TYPE_MOTION)
    color = paint_motion(image.floats(), result.note);
  else if (type == QUELL_TYPE_POSITION || type == QUELL_TYPE_DEPTH)
    color = paint_range(image.floats(), has_surface, result.note);
  else
    color = paint_range(image.floats(), everywhere, result.note);
  result.picture = paint({image.size(), panel}, color);
  if (type == QUELL_TYPE_MOTION) draw_wheel(result.picture);
  return result;
}

/// The largest error of each panel's pixel, so that none is lost where the picture is smaller than the image.
Panel make_error_panel(const Finding& finding, Size panel) {
  Panel result;
  result.title = "errors: " + finding.subject;
  const FloatImage errors = finding.errors.floats();
  const Scaling scaling{finding.errors.size(), panel};
  result.picture = Raster(panel.width, panel.height, kNothing);
  for (int y = 0; y < panel.height; ++y) {
    for (int x = 0; x < panel.width; ++x) {
      float largest = -1;
      const int right = std::max(scaling.column(x) + 1, scaling.column(x + 1)),
                low = std::max(scaling.row(y) + 1, scaling.row(y + 1));
      for (int row = scaling.row(y); row < low; ++row)
        for (int column = scaling.column(x); column < right; ++column) largest = std::max(largest, errors.at(column, row));
      if (largest >= 0) result.picture.at(x, y) = heat(largest / finding.large_error);
    }
  }
  for (int i = 0; i < 64; ++i) result.scale.push_back(heat(i / 63.0));
  result.scale_begin = "0", result.scale_end = short_number(finding.large_error) + " " + finding.error_unit;
  return result;
}

}  // namespace

std::vector<Panel> make_panels(const FrameData& frame, const std::vector<Finding>& findings) {
  std::vector<Panel> panels;
  Size panel{};
  for (const CheckedImage* input : list_images(frame)) {
    if (!input->image) continue;
    if (panel.width == 0) panel = panel_size(input->image.size(), kSmallest, kLargest);
    panels.push_back(make_input_panel(*input, frame, panel));
  }
  for (const Finding& finding : findings)
    if (finding.errors && finding.frame == frame.frame) panels.push_back(make_error_panel(finding, panel));
  return panels;
}

}  // namespace quell
