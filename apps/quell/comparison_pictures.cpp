#include "comparison_pictures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "figure_text.h"
#include "metric_options.h"
#include "quell/sequence/contact_sheet.h"
#include "quell/sequence/file_pattern.h"

namespace quell::app {
namespace fs = std::filesystem;

namespace {

constexpr int kLargest = 640, kSmallest = 400;  // width of a panel
constexpr Rgb kNotFinite{255, 0, 255};
constexpr Rgb kNothing{24, 24, 26};

fs::path map_file(const fs::path& folder, const ComparisonJob& job, std::size_t image, Metric metric, std::int64_t frame) {
  const std::string number = padded(frame, job.reference.sequence()->padding());
  return folder / (job.labels[image] + "." + std::string(info(metric).name) + "." + number + ".png");
}

void write_map(const Image& map, const fs::path& to) {
  const FloatImage errors = map.floats();
  Raster raster(map.width(), map.height());
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) raster.at(x, y) = flip_color(errors.at(x, y));
  write_raster(to, raster);
}

/// Where `at` of a panel's pixels begins in the image.
int scaled(int at, int image, int panel) { return static_cast<int>(std::int64_t{at} * image / panel); }

/// A pixel of the panel is the mean of those that it covers, by `value(x, y, channel)`.
template <class Value, class Paint>
Raster paint(Size image, int channels, const Value& value, const Paint& color) {
  const Size size = panel_size(image, kSmallest, kLargest);
  Raster raster(size.width, size.height);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int left = scaled(x, image.width, size.width), right = std::max(left + 1, scaled(x + 1, image.width, size.width));
      const int top = scaled(y, image.height, size.height), low = std::max(top + 1, scaled(y + 1, image.height, size.height));
      std::array<double, 3> mean{};
      for (int row = top; row < low; ++row)
        for (int column = left; column < right; ++column)
          for (int c = 0; c < channels; ++c) mean[static_cast<std::size_t>(c)] += value(column, row, c);
      for (double& sum : mean) sum /= static_cast<double>(right - left) * (low - top);
      raster.at(x, y) = color(mean);
    }
  return raster;
}

Raster show(const Image& image, DisplayTransform transform) {
  const FloatImage pixels = image.floats();
  return paint(
      image.size(), 3, [&](int x, int y, int c) { return to_display(transform, pixels.at(x, y, c)); },
      [](const std::array<double, 3>& mean) {
        Rgb color;
        for (std::size_t c = 0; c < 3; ++c) {
          if (!std::isfinite(mean[c])) return kNotFinite;
          color[c] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(mean[c], 0.0, 1.0)));
        }
        return color;
      });
}

Raster show_errors(const Image& map) {
  const FloatImage errors = map.floats();
  return paint(
      map.size(), 1, [&](int x, int y, int) { return static_cast<double>(errors.at(x, y)); },
      [](const std::array<double, 3>& mean) { return flip_color(mean[0]); });
}

}  // namespace

std::vector<fs::path> list_maps(const fs::path& folder, const ComparisonJob& job) {
  std::vector<fs::path> files;
  for (const Metric metric : {Metric::flip, Metric::hdr_flip})
    for (std::size_t i = 0; i < job.images.size() && contains(job.options.metrics, metric); ++i)
      for (const std::int64_t frame : job.frames) files.push_back(map_file(folder, job, i, metric, frame));
  return files;
}

void write_maps(const fs::path& folder, const ComparisonJob& job, const FramePictures& pictures, Executor& executor) {
  run_on(executor)(static_cast<int>(2 * job.images.size()), [&](int i) {
    const auto image = static_cast<std::size_t>(i / 2);
    const bool is_hdr = i % 2 == 1;
    if (const Image& map = (is_hdr ? pictures.hdr_flip_maps : pictures.flip_maps)[image])
      write_map(map, map_file(folder, job, image, is_hdr ? Metric::hdr_flip : Metric::flip, pictures.frame));
  });
}

void WorstFrame::look_at(const ComparedFrame& frame, const FramePictures& pictures) {
  const std::vector<Metric>& metrics = job_.options.metrics;
  const Metric metric = contains(metrics, Metric::flip) ? Metric::flip : Metric::hdr_flip;
  const auto place = static_cast<std::size_t>(std::ranges::find(metrics, metric) - metrics.begin());
  double error = 0;
  for (const ImageFigures& image : frame.images)
    if (const double figure = value(metric, image.scores[place]); figure > error) error = figure;
  if (error <= error_) return;
  error_ = error, frame_ = frame, pictures_ = pictures;
}

std::string WorstFrame::figures(std::size_t image, bool first_half) const {
  const std::vector<Metric>& metrics = job_.options.metrics;
  const std::vector<Score>& scores = frame_.images[image].scores;
  const auto half = static_cast<std::ptrdiff_t>((metrics.size() + 1) / 2);
  if (first_half) return list_figures({metrics.begin(), metrics.begin() + half}, {scores.begin(), scores.begin() + half});
  return list_figures({metrics.begin() + half, metrics.end()}, {scores.begin() + half, scores.end()});
}

std::optional<bool> WorstFrame::draw(const fs::path& file) const {
  if (!pictures_.reference) return std::nullopt;
  const bool is_hdr = !contains(job_.options.metrics, Metric::flip);
  std::vector<Panel> panels = {{"reference", "display values by " + describe(info(job_.options.display)),
                                show(pictures_.reference, job_.options.display)}};
  for (std::size_t i = 0; i < job_.images.size(); ++i)
    panels.push_back({job_.labels[i], figures(i, true), show(pictures_.images[i], job_.options.display)});
  const Raster& first = panels.front().picture;
  Panel scale{is_hdr ? "errors by HDR-FLIP" : "errors by FLIP", "", Raster(first.width, first.height, kNothing)};
  for (int i = 0; i < 256; ++i) scale.scale.push_back(flip_color(i / 255.0));
  scale.scale_begin = "0", scale.scale_end = "1";
  panels.push_back(std::move(scale));
  for (std::size_t i = 0; i < job_.images.size(); ++i)
    panels.push_back(
        {job_.labels[i], figures(i, false), show_errors((is_hdr ? pictures_.hdr_flip_maps : pictures_.flip_maps)[i])});
  const std::string heading = "Frame " + std::to_string(frame_.frame) + ", the one with the largest error";
  return write_contact_sheet(file, heading, panels, static_cast<int>(job_.images.size()) + 1);
}

}  // namespace quell::app
