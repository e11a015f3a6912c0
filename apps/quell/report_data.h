// What a report shows, as the data that its page reads. apps/report/src/data.ts describes the same.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "quell/text/json_write.h"
#include "report_run.h"

namespace quell::app {

struct Report {
  std::string title;
  std::string sequence;  ///< as it was named
  ReportFrames frames;
  std::optional<MeasuringOptions> measuring;
  std::vector<ReportedGraph> graphs;
  ReportedInputs inputs;
  int threads = 0;
};

Json report_data(const Report& report, const PackedImages& packed);

}  // namespace quell::app
