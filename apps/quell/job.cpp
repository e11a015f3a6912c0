#include "job.h"

#include <algorithm>
#include <optional>

#include "graph_files.h"
#include "quell/text/diagnostic.h"

namespace quell::app {
namespace {

std::vector<std::string> names_of_inputs(const Graph& graph) {
  std::vector<std::string> names;
  for (const GraphInput& input : graph.inputs) names.push_back(input.name);
  return names;
}

/// Which inputs a graph wants, for a person who has to name their files.
std::string describe_wanted(const Graph& graph) {
  std::string text;
  for (const GraphInput& input : graph.inputs)
    text += (text.empty() ? "" : ", ") + input.name + (input.optional ? " (optional)" : "");
  return text;
}

std::unique_ptr<Sequence> open_sequence(const Graph& graph, const SequenceArguments& arguments) {
  if (!arguments.given())
    throw Error(Fault::usage, "SEQUENCE",
                "no sequence is given; name a folder, a sequence.json, or the files of each input (" + describe_wanted(graph) +
                    ") with --in INPUT=PATTERN");
  SequenceOptions options = sequence_options(arguments);
  options.wanted = names_of_inputs(graph);
  std::unique_ptr<Sequence> sequence = Sequence::open(arguments.sequence, options);
  for (const GraphInput& input : graph.inputs) sequence->expect(input.name, input.type);
  return sequence;
}

void require_known_dumps(const Graph& graph, const std::vector<std::string>& dumps) {
  for (const std::string& dump : dumps) {
    try {
      graph.find(dump);
    } catch (const Error& error) { throw Error(error.fault(), "--dump", error.what()); }
  }
}

/// A misspelt --in would otherwise be an input that nobody asks for.
void require_known_names(const Graph& graph, const SequenceArguments& arguments) {
  const std::vector<std::string> known = names_of_inputs(graph);
  for (const std::string& option : arguments.in) {
    const std::string name = option.substr(0, option.find('='));
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(Fault::usage, "--in " + option,
                  "the graph has no input '" + name + "'" + did_you_mean(name, known) + "; it has " + list_names(known, "and"));
  }
}

void require_inputs(const Graph& graph, const std::vector<InputFiles>& found, const Sequence& sequence,
                    const std::string& place) {
  std::string missing, example;
  for (const GraphInput& input : graph.inputs) {
    const auto is_it = [&](const InputFiles& files) { return files.input == input.name; };
    if (input.optional || std::any_of(found.begin(), found.end(), is_it)) continue;
    missing += "\n  " + input.name + " (" + std::string(name(input.type)) + ")" + (input.doc.empty() ? "" : ": " + input.doc);
    if (example.empty()) example = input.name + "=FOLDER/NAME.####" + (input.type == QUELL_TYPE_CAMERA ? ".json" : ".exr");
  }
  if (missing.empty()) return;
  std::string have, layers = sequence.describe_layers();
  if (!layers.empty()) {
    layers = "\n" + layers;
    example = example.substr(0, example.find('=')) + "=PATTERN:LAYER";
  }
  for (const InputFiles& files : found) have += (have.empty() ? "" : ", ") + files.input;
  throw Error(Fault::input, place,
              "inputs of the graph '" + graph.name + "' are missing:" + missing + "\nthe sequence has: " +
                  (have.empty() ? "nothing" : have) + layers + "\nname their files, for example: --in " + example);
}

/// The files of the inputs that the plan reads, in the graph's order.
std::vector<InputFiles> select_inputs(const Plan& plan, const std::vector<InputFiles>& found) {
  std::vector<InputFiles> selected;
  for (std::size_t i = 0; i < plan.graph->inputs.size(); ++i) {
    if (!plan.input_used[i]) continue;
    const auto is_it = [&](const InputFiles& files) { return files.input == plan.graph->inputs[i].name; };
    const auto files = std::find_if(found.begin(), found.end(), is_it);
    if (files != found.end()) selected.push_back(*files);
  }
  return selected;
}

ChosenFrames choose_frames(const Sequence& sequence, const std::vector<InputFiles>& inputs, OnMissing on_missing,
                           const std::string& place) {
  std::vector<std::string> names;
  for (const InputFiles& files : inputs) names.push_back(files.input);
  return app::choose_frames(sequence, names, on_missing, place);
}

void tell_choice(const Job& job) {
  std::vector<std::string> names;
  for (const InputFiles& files : job.inputs) names.push_back("'" + files.input + "'");
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) list += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  spdlog::info("'{}' reads {} in {} frame{}: {}", job.graph->name, list, job.frames.size(), job.frames.size() == 1 ? "" : "s",
               FrameRange(job.frames).text());
}

InputShapes shapes_of(const Graph& graph, FrameSource& source) {
  InputShapes shapes;
  for (const GraphInput& input : graph.inputs) shapes[input.name] = source.shape(input.name);
  return shapes;
}

}  // namespace

std::shared_ptr<const Graph> load(const GraphArguments& arguments) { return load(arguments, load_passes(arguments.plugins)); }

std::shared_ptr<const Graph> load(const GraphArguments& arguments, const Registry& passes) {
  std::shared_ptr<const Graph> graph = load_graph(find_graph(arguments.graph), passes, arguments.options);
  for (const std::string& edit : graph->edits) spdlog::info(edit);
  return graph;
}

void tell_new_warnings(Job& job) {
  for (const std::string& warning : job.sequence->warnings())
    if (job.told.insert(warning).second) spdlog::warn(warning);
}

Job prepare_job(std::shared_ptr<const Graph> graph, const SequenceArguments& arguments, const std::vector<std::string>& dumps,
                std::shared_ptr<Sequence> opened, const std::string& described) {
  require_known_names(*graph, arguments);
  require_known_dumps(*graph, dumps);
  Job job;
  job.graph = graph;
  job.sequence = opened ? opened : open_sequence(*graph, arguments);
  if (const std::string about = job.sequence->describe(); !opened && about != described) spdlog::info(about);
  tell_new_warnings(job);  // at once: they may explain the error that follows
  const std::vector<InputFiles> found = job.sequence->inputs();
  const std::string place = arguments.sequence.empty() ? "--in" : arguments.sequence.string();
  require_inputs(*graph, found, *job.sequence, place);
  job.plan = make_plan(graph, shapes_of(*graph, *job.sequence), dumps);
  job.inputs = select_inputs(job.plan, found);
  ChosenFrames chosen = choose_frames(*job.sequence, job.inputs, arguments.on_missing, place);
  job.frames = std::move(chosen.frames), job.cuts = std::move(chosen.cuts), job.holds = std::move(chosen.holds);
  if (job.holds.empty())
    job.source = job.sequence;
  else
    job.source = std::make_shared<HoldingSource>(job.sequence, job.holds);
  tell_choice(job);
  tell_new_warnings(job);
  return job;
}

}  // namespace quell::app
