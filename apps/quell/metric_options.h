// What is measured and how, as the command line says it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quell/metrics/comparison.h"

namespace CLI {
class App;
}

namespace quell::app {

struct MetricArguments {
  std::optional<std::string> metrics, display, exposures, pixels_per_degree;
};

/// --metrics and --display; `defaults` says which metrics are taken without --metrics.
void add_metric_options(CLI::App& app, MetricArguments& arguments, const char* defaults);
/// --exposures and --pixels-per-degree.
void add_flip_options(CLI::App& app, MetricArguments& arguments);

/// What the options say; without --metrics, these metrics, and without --display, `reinhard`. Throws Error(usage) naming the
/// option.
CompareOptions parse_metric_options(const MetricArguments& arguments, const std::vector<Metric>& default_metrics);

/// A line for each metric, for help texts.
std::string describe_metrics();

/// "reinhard: (x / (1 + x))^(1/2.2)"
std::string describe(const DisplayInfo& display);

/// Whether there is a frame that follows its predecessor at once, so that temporal metrics can be told.
bool has_neighbors(const std::vector<std::int64_t>& frames);
/// These, and of `temporal` those after them when the frames have neighbors.
std::vector<Metric> default_metrics(std::vector<Metric> always, const std::vector<Metric>& temporal,
                                    const std::vector<std::int64_t>& frames);
bool contains(const std::vector<Metric>& metrics, Metric metric);

}  // namespace quell::app
