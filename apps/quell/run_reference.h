// What `quell run --reference` measures its outputs against.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arguments.h"
#include "job.h"
#include "measuring_sink.h"
#include "metric_options.h"
#include "results.h"

namespace CLI {
class App;
}

namespace quell::app {

struct ReferenceArguments {
  std::optional<std::string> reference;
  MetricArguments metrics;
};

void add_options(CLI::App& app, ReferenceArguments& arguments);

/// Nothing without --reference. Warns of frames that have no reference. Throws Error(usage) when nothing can be measured, when
/// other options lack --reference, or results would replace it; Error(input) when it cannot be read.
std::optional<MeasuringOptions> prepare_measuring(const ReferenceArguments& arguments, const SequenceArguments& sequence,
                                                  const Job& job, const std::vector<ResultFiles>& results);
/// Chooses what takes reading all reference images. Ends early when a signal came, which ends the run.
void complete_measuring(MeasuringOptions& options, int threads);

/// "would compare 'color' with shot/reference.####.exr: psnr, ssim and flip"
std::string describe(const MeasuringOptions& options);
/// "  color: psnr 31.24 dB  ssim 0.9120", of each output; "" for none.
std::string list_measured(const std::vector<MeasuredOutput>& measured, const std::vector<Metric>& metrics);
/// What became known of the reference's files.
void tell_new_warnings(const MeasuringOptions& options, Job& job);
/// Figures of all frames, and a warning of pixels that were left out.
void tell_measured(const MeasuringSink& sink);

}  // namespace quell::app
