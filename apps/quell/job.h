// A graph with a sequence that fits it: what a run needs before the first frame, and what check tells.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "arguments.h"
#include "quell/graph/plan.h"
#include "quell/sequence/sequence.h"

namespace quell::app {

struct Job {
  std::shared_ptr<const Graph> graph;
  std::shared_ptr<Sequence> sequence;
  Plan plan;
  std::vector<InputFiles> inputs;       ///< the files of each input that is read, in the graph's order
  std::vector<std::int64_t> frames;     ///< to be computed
  std::shared_ptr<FrameSource> source;  ///< of their images: the sequence, or one in which other frames stand in
  std::map<std::pair<std::string, std::int64_t>, std::int64_t> holds;  ///< of missing files: see ChosenFrames
  std::vector<std::int64_t> cuts;                                      ///< before which history ends, because frames are missing
  std::set<std::string> told;                                          ///< warnings of the sequence that were printed
};

/// Loads the plugins and the graph, and tells what options changed in it. Throws Error(plugin) or Error(usage).
std::shared_ptr<const Graph> load(const GraphArguments& arguments);
/// The same with plugins that are loaded already.
std::shared_ptr<const Graph> load(const GraphArguments& arguments, const Registry& passes);

/// Opens the sequence for the graph, tells what was recognized, and plans. Throws Error(input) when an input, or a file of the
/// frames asked for, is missing; Error(usage) when the graph cannot run on these images. `opened` is the sequence of an earlier
/// job, for a graph of the same inputs: it was told already. `described` is what was told of a sequence before.
Job prepare_job(std::shared_ptr<const Graph> graph, const SequenceArguments& arguments,
                const std::vector<std::string>& dumps = {}, std::shared_ptr<Sequence> opened = {},
                const std::string& described = {});

/// Prints the sequence's warnings that are new since the last call.
void tell_new_warnings(Job& job);

}  // namespace quell::app
