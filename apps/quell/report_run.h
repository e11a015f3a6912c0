// A graph's run for a report: images, figures, times and memory.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "job.h"
#include "measuring_sink.h"
#include "quell/runtime/session.h"
#include "report_images.h"

namespace quell::app {

inline constexpr const char* kNoisyInput = "color";  ///< that graphs denoise

struct ReportedGraph {
  std::string label;
  Job job;
  std::vector<std::pair<std::string, std::string>> files;  ///< names and texts of what the graph was read from
  std::vector<std::string> inner;                          ///< names of all inner images
  Weighed weighed;
  std::map<std::string, ReportImage, std::less<>> images;
  std::vector<FrameReport> frames;
  std::map<std::int64_t, std::vector<MeasuredOutput>> measured;
  std::vector<MeasuredOutput> totals;
  double seconds = 0;
  std::string drawing, no_drawing;  ///< SVG, or why there is none
};

/// Names for Graph::find of all images that nodes yield and that are no results already.
std::vector<std::string> list_inner_images(const Plan& plan);

/// What the weights of the graph's filters are made of.
Weighed find_weighed(const Plan& plan);

/// Thrown when a signal came.
struct Interrupted {};

/// Runs one node after the other, so that times of nodes are their own. Throws Interrupted.
void run_for_report(ReportedGraph& graph, const ReportFrames& frames, const std::optional<MeasuringOptions>& measuring,
                    const SessionOptions& session, PackedImages& packed);

/// Has Graphviz draw the graph.
void draw_for_report(ReportedGraph& graph);

/// What comes from the sequence: images, and what its color is worth by itself.
struct ReportedInputs {
  std::vector<ReportImage> images;
  std::map<std::int64_t, std::vector<MeasuredOutput>> measured;
  std::vector<MeasuredOutput> totals;
};
/// Reads `color` and the reference of the frames that are kept, and all other inputs of those whose inner images are shown.
/// Throws Interrupted.
ReportedInputs read_inputs(const std::vector<ReportedGraph>& graphs, const ReportFrames& frames,
                           const std::optional<MeasuringOptions>& measuring, PackedImages& packed);

}  // namespace quell::app
