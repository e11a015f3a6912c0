#include "metric_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "arguments.h"
#include "quell/text/diagnostic.h"
#include "text_layout.h"

namespace quell::app {
namespace {

constexpr double kMostPixelsPerDegree = 1000, kMostStops = 100;
constexpr int kMostExposures = 200;  // one a stop of all that can be given

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

std::vector<Metric> parse_metrics(const std::string& text) {
  std::vector<Metric> chosen;
  const auto add = [&](Metric metric) {
    if (!contains(chosen, metric)) chosen.push_back(metric);
  };
  for (const std::string& name : split(text)) {
    if (name == "all")
      for (const MetricInfo& about : metrics()) add(about.metric);
    else
      add(parse_metric(name, "--metrics"));
  }
  return chosen;
}

Exposures parse_exposures(const std::string& text) {
  const std::vector<std::string> parts = split(text);
  if (parts.size() < 2 || parts.size() > 3)
    throw Error(Fault::usage, "--exposures", "'" + text + "' is not START,STOP or START,STOP,COUNT, such as -2,4 or -2,4,7");
  Exposures exposures;
  exposures.start = parse_number(parts[0], "--exposures", -kMostStops, kMostStops);
  exposures.stop = parse_number(parts[1], "--exposures", -kMostStops, kMostStops);
  if (exposures.start > exposures.stop)
    throw Error(Fault::usage, "--exposures", "'" + text + "' goes down; write the smaller exposure first");
  // As many as the authors' program takes: one a stop.
  exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.stop - exposures.start)));
  if (parts.size() == 3) exposures.count = parse_count(parts[2], "--exposures", 1, kMostExposures);
  return exposures;
}

std::string list_of_metrics() {
  std::string text;
  for (const MetricInfo& about : metrics()) text += (text.empty() ? "" : ", ") + std::string(about.name);
  return text;
}

std::string list_of_transforms() {
  std::string text;
  for (const DisplayInfo& about : display_transforms()) text += (text.empty() ? "" : "; ") + describe(about);
  return text;
}

}  // namespace

std::string describe_metrics() {
  std::string text;
  for (const MetricInfo& about : metrics()) text += entry(about.name, about.summary, 2, 12);
  return text;
}

std::string describe(const DisplayInfo& display) { return std::string(display.name) + ": " + std::string(display.summary); }

bool contains(const std::vector<Metric>& metrics, Metric metric) { return std::ranges::find(metrics, metric) != metrics.end(); }

CompareOptions parse_metric_options(const MetricArguments& arguments, const std::vector<Metric>& default_metrics) {
  CompareOptions options;
  options.metrics = arguments.metrics ? parse_metrics(*arguments.metrics) : default_metrics;
  if (arguments.display) options.display = parse_display_transform(*arguments.display, "--display");
  if (arguments.exposures) options.exposures = parse_exposures(*arguments.exposures);
  if (arguments.pixels_per_degree)
    options.pixels_per_degree = parse_number(*arguments.pixels_per_degree, "--pixels-per-degree", 1, kMostPixelsPerDegree);
  return options;
}

bool has_neighbors(const std::vector<std::int64_t>& frames) {
  return std::ranges::adjacent_find(frames, [](std::int64_t a, std::int64_t b) { return b - 1 == a; }) != frames.end();
}

std::vector<Metric> default_metrics(std::vector<Metric> always, const std::vector<Metric>& temporal,
                                    const std::vector<std::int64_t>& frames) {
  if (has_neighbors(frames)) always.insert(always.end(), temporal.begin(), temporal.end());
  return always;
}

void add_metric_options(CLI::App& app, MetricArguments& arguments, const char* defaults) {
  app.add_option("--metrics", arguments.metrics,
                 "What to measure, separated by commas, or all: " + list_of_metrics() + ". Without it, " + defaults + ".")
      ->type_name("NAMES")
      ->group(kMeasureGroup);
  app.add_option("--display", arguments.display,
                 "How radiance becomes what a display shows, for the metrics that are about that; " + list_of_transforms() + ".")
      ->type_name("NAME")
      ->group(kMeasureGroup);
}

void add_flip_options(CLI::App& app, MetricArguments& arguments) {
  app.add_option("--exposures", arguments.exposures,
                 "Of hdrflip, in stops: -2,4 or -2,4,7 for seven of them. Without it, what shows all reference images from their "
                 "brightest pixel to their median.")
      ->type_name("START,STOP[,COUNT]")
      ->group(kMeasureGroup);
  app.add_option("--pixels-per-degree", arguments.pixels_per_degree,
                 "Of flip and hdrflip: how large the observer sees pixels. 67.02, the default, is 0.7 m before a display 0.7 m "
                 "wide with 3840 pixels.")
      ->type_name("N")
      ->group(kMeasureGroup);
}

}  // namespace quell::app
