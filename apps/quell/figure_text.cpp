#include "figure_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace quell::app {
namespace {

constexpr int kMostDecimals = 7;
constexpr double kLargestPlain = 1e5;

std::string print(const char* format, int precision, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, precision, value);
  return text.data();
}

}  // namespace

int decimals_for(Metric metric, std::span<const double> figures) {
  if (info(metric).unit == "dB") return 2;
  int decimals = 4;
  for (const double figure : figures) {
    const double size = std::abs(figure);
    if (!std::isfinite(size) || size == 0) continue;
    decimals = std::max(decimals, 2 - static_cast<int>(std::floor(std::log10(size))));
  }
  return std::min(decimals, kMostDecimals);
}

std::string figure_text(double figure, int decimals) {
  if (std::isnan(figure)) return "-";
  if (std::isinf(figure)) return figure > 0 ? "inf" : "-inf";
  const double size = std::abs(figure);
  const bool is_shown = size == 0 || (size >= 0.5 * std::pow(10, -decimals) && size < kLargestPlain);
  return is_shown ? print("%.*f", decimals, figure) : print("%.*e", 1, figure);
}

std::string named_figure(Metric metric, double figure) {
  const MetricInfo& about = info(metric);
  const std::string text = figure_text(figure, decimals_for(metric, {&figure, 1}));
  const bool has_unit = !about.unit.empty() && std::isfinite(figure);
  return std::string(about.name) + " " + text + (has_unit ? " " + std::string(about.unit) : "");
}

std::string list_figures(const std::vector<Metric>& metrics, const std::vector<Score>& scores) {
  std::string text;
  for (std::size_t i = 0; i < metrics.size(); ++i)
    text += (i == 0 ? "" : "  ") + named_figure(metrics[i], value(metrics[i], scores[i]));
  return text;
}

std::string better_text(Metric metric) {
  if (info(metric).higher_is_better) return "higher";
  return is_better(metric, -1, 0) ? "lower" : "near 0";
}

std::string describe_bad_pixels(std::uint64_t count) {
  return std::to_string(count) + (count == 1 ? " pixel is NaN or infinite" : " pixels are NaN or infinite");
}

}  // namespace quell::app
